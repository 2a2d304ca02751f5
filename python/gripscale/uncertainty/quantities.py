"""Numbers that a user states for a source: with a unit, in SI units without."""

from __future__ import annotations

from typing import Any

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.sine_fit import MOST_WAVES
from gripscale.units import parse_quantity


def modulus(given: Any) -> float:
    """Return a modulus [Pa]; raise `InputError` for what is none."""
    return _quantity(given, "pressure", "Pa")


def length(given: Any) -> float:
    """Return a length [m]; raise `InputError` for what is none."""
    return _quantity(given, "length", "m")


def factor(given: Any) -> float:
    """Return a factor [-]; raise `InputError` for what is none."""
    return checks.positive("a factor", _bare(given))


def count(given: Any) -> float:
    """Return a number of waves; raise `InputError` for what is none."""
    return float(checks.whole("waves", _bare(given), least=2, most=MOST_WAVES))


def _quantity(given: Any, kind: str, unit: str) -> float:
    value = _bare(given)
    if isinstance(value, str):
        try:
            value = parse_quantity(value, kind)
        except ValueError as error:
            raise InputError(f"{given!r}: {error}") from error
    return checks.positive(f"a {kind}", value, unit=unit)


def _bare(given: Any) -> Any:
    """Return the number a text spells, or what was given."""
    try:
        return float(given) if isinstance(given, str) else given
    except ValueError:
        return given
