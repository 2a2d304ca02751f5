"""Limits of what a case states about its uncertainty; light enough for every case."""

from __future__ import annotations

from typing import Any

from gripscale.core.units import parse_quantity, unit_of

SAMPLES, FEWEST_SAMPLES, MOST_SAMPLES = 200, 10, 100_000
MOST_SEED = 2**32 - 1

PRESSURE_ERROR = 'a share such as "3 %", or a pressure such as "0.1 bar"'


def pressure_error(value: Any, pressure: float) -> float:
    """Return the relative error [-] that a share or a pressure [Pa] is of a nominal pressure.

    Raises `ValueError` for what is neither, or not above zero.
    """
    relative = unit_of(value, "strain") == "%"
    try:
        error = parse_quantity(value, "strain" if relative else "pressure")
    except ValueError as wrong:
        raise ValueError(f"expected {PRESSURE_ERROR}") from wrong
    if error <= 0.0:
        raise ValueError("expected a value greater than zero")
    return error if relative else error / pressure
