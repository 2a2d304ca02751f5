"""Units: sizes against their definitions, spellings, and quantities with their unit."""

import math

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.core.units import (
    UNITS,
    DisplayUnit,
    in_mm,
    listed,
    parse_quantity,
    quantity_in_si,
    spelled,
)


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
