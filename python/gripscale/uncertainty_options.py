"""What a case states about its uncertainty; light enough to be read with every case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from gripscale.core.units import parse_quantity, unit_of

FEWEST_SAMPLES, MOST_SAMPLES, MOST_SEED = 10, 100_000, 2**32 - 1

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


@dataclass(frozen=True)
class UncertaintyOptions:
    """What is sampled, how often and by which models, where a question does not say."""

    samples: int = 200
    seed: int = 0
    # "chain", "direct" or "both"; None: the direct contact where profiles were measured.
    model: str | None = None
    without: Sequence[str] = ()  # sources that are taken to be known
    # What is known of a source, in place of its default.
    ranges: Mapping[str, Any] = field(default_factory=dict)
    # Length of the blocks of profiles that are drawn [m]; four of the largest waves by default.
    block_length: float | None = None
    # Estimated relative error of each direct contact; that of its first full grid by default.
    tolerance: float | None = None
