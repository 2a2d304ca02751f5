"""Loads and lengths are shown as the case gives them, what is a plain number in the usual unit."""

import tomllib

import pytest

from gripscale.core.units import (
    DISPLAY_UNITS,
    GIVEN,
    display_unit,
    display_unit_of,
    stated_units,
)
from gripscale.questions.vary.axis import axes_of
from gripscale.questions.vary.study import coordinates

CASE = """
[surface]
smallest_wavelength = "50 µm"
[load]
pressure = "300 kPa"
speed = "36 km/h"
footprint = 0.1
"""
UNITS = stated_units(tomllib.loads(CASE))


def test_the_units_of_a_case():
    assert UNITS == {"pressure": "kPa", "speed": "km/h", "smallest_wavelength": "um"}
    assert display_unit("pressure", UNITS).text(3e5) == "300 kPa"
    assert display_unit("speed", UNITS).text(10.0) == "36 km/h"
    assert display_unit("footprint", UNITS).text(0.1) == "100 mm"


def test_a_result_carries_the_units_of_its_case():
    stated = {DISPLAY_UNITS: '{"speed": "km/h"}', "case": "[load]\nspeed = '1 mm/s'"}
    assert display_unit_of(stated, "speed").text(10.0) == "36 km/h"
    assert display_unit_of(stated, "pressure").text(3e5) == "0.3 MPa"
    assert display_unit_of({}, "speed").text(10.0) == "10 m/s"


@pytest.mark.parametrize(
    ("values", "unit", "called"),
    [
        ("1 bar, 3 bar", "bar", "3 bar"),
        ("1 bar:3 bar:lin2", "bar", "3 bar"),
        (["1e5 Pa", "3e5 Pa"], "Pa", "300000 Pa"),
        ([1e5, 3e5], "kPa", "300 kPa"),
    ],
)
def test_an_axis_goes_before_the_case(values, unit, called):
    """Inside it is in Pa whatever is shown."""
    axes = axes_of({"pressure": values})
    along = coordinates(axes, UNITS)["pressure"]
    assert (along.values.tolist(), along.attrs["units"], along.attrs[GIVEN]) == (
        [1e5, 3e5],
        "Pa",
        unit,
    )
    assert axes[0].called(1, UNITS) == called


def test_other_axes_have_no_unit_to_choose():
    axes = axes_of({"temperature": "20 C, 40 C", "effects": ["all", "none"]})
    units = [one.attrs.get(GIVEN) for one in coordinates(axes, UNITS).values()]
    assert units == [None, None]
    assert [axis.called(1, UNITS) for axis in axes] == ["40 C", "none"]
