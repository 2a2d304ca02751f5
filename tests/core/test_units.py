"""Units: sizes against their definitions, spellings, and quantities with their unit."""

import math
import tomllib

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.core.units import (
    DISPLAY_UNITS,
    GIVEN,
    UNITS,
    DisplayUnit,
    display_unit,
    display_unit_of,
    in_mm,
    listed,
    parse_quantity,
    quantity_in_si,
    spelled,
    stated_units,
)
from gripscale.questions.vary.axis import axes_of
from gripscale.questions.vary.study import coordinates


@pytest.mark.parametrize(
    ("unit", "kind", "si"),
    [
        ("in", "length", 25.4e-3),
        ("bar", "pressure", 1e5),
        ("psi", "pressure", 6894.757293168361),
        ("psi", "modulus", 6894.757293168361),
        ("dyn/cm^2", "modulus", 0.1),
        ("N/mm^2", "modulus", 1e6),
        ("km/h", "speed", 1000 / 3600),
        ("h", "time", 3600),
        ("rad/s", "frequency", 1 / (2 * math.pi)),
        ("GHz", "frequency", 1e9),
        ("C", "temperature", 274.15),
        ("K", "temperature", 1),
    ],
)
def test_one_of_a_unit_in_si(unit, kind, si):
    assert quantity_in_si(1.0, unit, kind) == pytest.approx(si, rel=1e-15)
    assert quantity_in_si(np.ones(3), unit, kind) == pytest.approx([si] * 3, rel=1e-15)
    assert parse_quantity(f"1 {unit}", kind) == quantity_in_si(1.0, unit, kind)


@pytest.mark.parametrize("kind", UNITS)
def test_the_first_unit_of_a_kind_is_that_of_si(kind):
    first = next(iter(UNITS[kind]))
    assert quantity_in_si(2.5, first, kind) == 2.5
    assert listed(kind).startswith(first)


@pytest.mark.parametrize(
    ("written", "kind", "usual"),
    [
        ("\N{MICRO SIGN}m", "length", "um"),
        ("\N{GREEK SMALL LETTER MU}m", "length", "um"),
        (" Micron ", "length", "um"),
        ("metres", "length", "m"),
        ("µs", "time", "us"),
        ("N/mm²", "modulus", "N/mm^2"),
        ("N/mm2", "pressure", "N/mm^2"),
        ("°C", "temperature", "C"),
        ("MM", "length", None),
        ("mpa", "modulus", None),
        ("bar", "modulus", "bar"),
        ("", "length", None),
        (None, "length", None),
    ],
)
def test_spellings(written, kind, usual):
    assert spelled(written, kind) == usual


def test_an_unknown_unit_is_named_with_all_that_are_known():
    with pytest.raises(InputError, match=r"z_unit must be one of m, cm, .*; got 'furlong'"):
        quantity_in_si(1.0, "furlong", "length", "z_unit")


@pytest.mark.parametrize(
    ("metres", "digits", "text"),
    [(1.0, 3, "1000 mm"), (12.3456, 3, "12300 mm"), (1e-7, 3, "0.0001 mm"), (4e4, 3, "4e+07 mm")],
)
def test_numbers_in_display_units_are_shown_without_an_exponent(metres, digits, text):
    assert DisplayUnit("mm", 1e-3).text(metres, digits) == text
    assert in_mm(metres, digits) == text


# Loads and lengths are shown as the case gives them, what is a plain number in the usual unit.

CASE = """
[surface]
smallest_wavelength = "50 µm"
[load]
pressure = "300 kPa"
speed = "36 km/h"
footprint = 0.1
"""
STATED = stated_units(tomllib.loads(CASE))


def test_the_units_of_a_case():
    assert STATED == {"pressure": "kPa", "speed": "km/h", "smallest_wavelength": "um"}
    assert display_unit("pressure", STATED).text(3e5) == "300 kPa"
    assert display_unit("speed", STATED).text(10.0) == "36 km/h"
    assert display_unit("footprint", STATED).text(0.1) == "100 mm"


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
    along = coordinates(axes, STATED)["pressure"]
    assert (along.values.tolist(), along.attrs["units"], along.attrs[GIVEN]) == (
        [1e5, 3e5],
        "Pa",
        unit,
    )
    assert axes[0].called(1, STATED) == called


def test_other_axes_have_no_unit_to_choose():
    axes = axes_of({"temperature": "20 C, 40 C", "effects": ["all", "none"]})
    units = [one.attrs.get(GIVEN) for one in coordinates(axes, STATED).values()]
    assert units == [None, None]
    assert [axis.called(1, STATED) for axis in axes] == ["40 C", "none"]
