"""What a comparison gives: the solved ladder of one load, or one for each value of an axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gripscale.comparison.solved_ladder import SolvedLadder
from gripscale.study.axis import Axis

if TYPE_CHECKING:
    import xarray as xr


class Comparison(SolvedLadder):
    """The rungs of one case under one load, in order, and what follows from them."""

    def to_dataset(self) -> xr.Dataset:
        """Return everything as a labelled Dataset over `rung`, see `comparison.dataset`."""
        from gripscale.comparison.dataset import to_dataset

        return to_dataset([self])


@dataclass(frozen=True, eq=False)
class ComparisonOverAxis:
    """Comparisons over a varied input of the case."""

    axis: Axis
    comparisons: Sequence[Comparison]

    @property
    def converged(self) -> bool:
        """Whether every sample of every rung may be used."""
        return all(one.converged for one in self.comparisons)

    def to_dataset(self) -> xr.Dataset:
        """Return everything as a labelled Dataset over the axis and `rung`."""
        from gripscale.comparison.dataset import to_dataset

        return to_dataset(self.comparisons, self.axis)
