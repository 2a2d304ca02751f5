"""What may be varied, and the one sentence for each way of getting it wrong."""

import numpy as np
import pytest
import xarray as xr

from gripscale.core.errors import InputError
from gripscale.questions.vary.axis import axes_of, parse_axes


@pytest.mark.parametrize(
    ("name", "given", "values"),
    [
        ("speed", "0.001:10:log5", (0.001, 0.01, 0.1, 1.0, 10.0)),
        ("speed", "1 mm/s:10 m/s:log5", (0.001, 0.01, 0.1, 1.0, 10.0)),
        ("speed", "0:2:lin3", (0.0, 1.0, 2.0)),
        ("speed", "0, 36 km/h", (0.0, 10.0)),
        ("pressure", "1 bar,3 bar", (1e5, 3e5)),
        ("pressure", 2e5, (2e5,)),
        ("pressure", ["1 bar", "300 kPa", 2e5], (1e5, 3e5, 2e5)),
        ("speed", np.geomspace(0.01, 1.0, 3), (0.01, 0.1, 1.0)),
        ("speed", np.array(["0.1 m/s", "36 km/h"]), (0.1, 10.0)),
        ("speed", xr.DataArray([0.1, 1.0], dims="speed"), (0.1, 1.0)),
        ("temperature", np.array([293.15, 313.15]), (293.15, 313.15)),
        ("temperature", [293.15, "40 C"], (293.15, 313.15)),
        ("smallest_wavelength", "0.01 mm:1 mm:log3", (1e-5, 1e-4, 1e-3)),
        ("cut_off", "0.1 mm, 1 mm", (1e-4, 1e-3)),
        ("rubber", "case,here/dma.txt", ("case", "here/dma.txt")),
    ],
)
def test_values_are_read(name, given, values):
    axis = axes_of({name: given})[0]
    assert axis.values == values
    assert len(axis.labels) == len(values)


def test_labels_are_short_unless_they_would_be_equal():
    assert axes_of({"temperature": [293.15, "40 C"]})[0].labels == ("20 C", "40 C")
    assert axes_of({"rubber": "case,a/dma.txt"})[0].labels == ("case", "dma")
    assert axes_of({"rubber": "b/dma.txt,a/dma.txt"})[0].labels == ("b/dma.txt", "a/dma.txt")


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({}, "varies one or two of speed, pressure"),
        ({"speed": [1], "thickness": [2], "pressure": [3]}, "one or two of .*; got 3"),
        ({"sped": [1]}, "vary must be one of speed, .*; got 'sped'"),
        ({"speed": []}, "speed must have 1 to 1000 values; got 0"),
        ({"speed": "1:10:sqrt3"}, 'such as "0.01 m/s:10 m/s:log7"; got .1:10:sqrt3.'),
        ({"speed": "1 m/s:10 m/s"}, "must be a range of .*; got '1 m/s:10 m/s'"),
        ({"speed": "1:2:3:log4"}, "must be a range of .*; got '1:2:3:log4'"),
        ({"speed": "1:10:log1"}, "number of values must be a whole number from 2"),
        ({"speed": "10:1:log3"}, "speed must go from low to high"),
        ({"speed": "0:1:log3"}, "log range must be greater than zero"),
        ({"speed": "1:10 m/s:log3"}, "a unit at both ends or none"),
        ({"speed": "-1"}, "speed must not be negative"),
        ({"speed": "fast"}, "speed = 'fast': expected a speed"),
        ({"speed": "1,1.0"}, "different values; got 1 more than once"),
        ({"pressure": "3 furlong"}, "pressure = '3 furlong': unknown unit"),
        ({"pressure": "0"}, "pressure must be greater than zero"),
        ({"pressure": [float("nan")]}, "pressure must be a finite number"),
        ({"effects": "2:3:lin3"}, "effects must be a list, not a range"),
        ({"effects": 3}, "effects must be a str; got int"),
        ({"rubber": [3]}, "rubber must be names and files"),
        ({"rubber": 3}, "rubber must be names and files, or a mapping from names; got 3"),
        ({"temperature": [20, 60]}, 'in kelvin or have a unit, such as "20 C"; got 20 K'),
        ({"speed": np.ones((2, 2))}, "speed must be a finite number .*; got an array of shape"),
    ],
)
def test_wrong_axis_is_one_sentence(vary, words):
    with pytest.raises(InputError, match=words) as caught:
        axes_of(vary)
    assert "\n" not in str(caught.value)


def test_option_is_a_name_and_its_values():
    assert parse_axes(["speed = 1:2:lin2"]) == {"speed": "1:2:lin2"}
    for wrong in ("speed", "speed=", "sped=1"):
        with pytest.raises(InputError, match="vary must be"):
            parse_axes([wrong])
