"""The table [uncertainty] of a case: what `gripscale uncertainty` takes to be not known.

Lengths in m, moduli in Pa once read.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Field

from gripscale.case.quantity import Length
from gripscale.case.reading import Reading
from gripscale.case.table import Table
from gripscale.units import parse_quantity, such_as

FEWEST_SAMPLES, MOST_SAMPLES, MOST_SEED = 10, 100_000, 2**32 - 1

SourceName = Literal[
    "profile",
    "modulus",
    "bulk_modulus",
    "equilibrium_modulus",
    "load_time",
    "cut_off",
    "waves",
]
"""What may be taken to be uncertain."""

FACTOR = "factor"
"""Kind of values that have no unit."""


@dataclass(frozen=True)
class Values(Reading):
    """Values of a source: quantities of one kind, or factors."""

    kind: str

    def read(self, value: Any) -> list[float]:
        """Return rising numbers in SI units."""
        if not isinstance(value, list) or not value:
            raise ValueError(f"expected {self.words}")
        found = [self._number(one) for one in value]
        if found[0] <= 0.0 or any(b <= a for a, b in pairwise(found)):
            raise ValueError("expected rising values greater than zero")
        return found

    def _number(self, value: Any) -> float:
        if self.kind != FACTOR:
            return parse_quantity(value, self.kind)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"expected {self.words}")
        return float(value)


def _values(kind: str) -> Values:
    one = f"a {kind}" if kind == FACTOR else f"a {kind} {such_as(kind)}"
    return Values(f"a list of two ends or of equally likely values, each {one}", kind)


Moduli = Annotated[list[float], _values("pressure")]
Lengths = Annotated[list[float], _values("length")]
Factors = Annotated[list[float], _values(FACTOR)]


class Given(Table):
    """What is known of a source, in place of its default: two ends, or equally likely values."""

    bulk_modulus: Moduli | None = None
    """Bulk modulus of the rubber; by default 1.5 times less to 1.5 times more."""
    equilibrium_modulus: Moduli | None = None
    """Modulus of the rubber after infinite time; not sampled by default."""
    load_time: Factors | None = None
    """How long waves are loaded, over the time of the case; by default 0.5 to 2."""
    cut_off: Lengths | None = None
    """Where the roughness ends; by default an octave about that of the case."""
    waves: Annotated[list[int], Field(min_length=1)] | None = None
    """Numbers of sine waves, among those that follow the correlation; all of these by default."""


class UncertaintyTable(Table):
    """What `gripscale uncertainty` samples; its options go before what is stated here."""

    samples: int = Field(default=200, ge=FEWEST_SAMPLES, le=MOST_SAMPLES)
    """Samples of all that is not known at once."""
    seed: int = Field(default=0, ge=0, le=MOST_SEED)
    """Seed of the random numbers."""
    model: Literal["chain", "direct", "both"] = "chain"
    """What predicts each sample."""
    without: list[SourceName] = Field(default=[])
    """Sources that are taken to be known."""
    given: Given | None = None
    """What is known of a source, in place of its default."""
    block_length: Length | None = None
    """Length of the blocks of profiles that are drawn; four of the largest waves by default."""
    tolerance: float | None = Field(default=None, gt=0.0, lt=1.0)
    """Estimated relative error of each direct contact; that of its first full grid by default."""
