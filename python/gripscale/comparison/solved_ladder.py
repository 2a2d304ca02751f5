"""The solved rungs of one case under one load, and what follows from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

from gripscale.case.read import CaseFile
from gripscale.comparison.estimate import BestEstimate, Factor, best_estimate
from gripscale.comparison.rung import Subject
from gripscale.comparison.solved import SolvedRung
from gripscale.comparison.uncertain import UNKNOWN, Uncertain
from gripscale.measured.friction import MeasuredFriction


@dataclass(frozen=True, eq=False)
class SolvedLadder:
    """The rungs of one case under one load, in order."""

    file: CaseFile
    subject: Subject
    rungs: Sequence[SolvedRung]
    measured: MeasuredFriction | None = None
    """Friction measured elsewhere, to be put beside the models."""
    factors: Sequence[Factor] = field(default=())
    """Factors of the best estimate known from elsewhere."""

    @property
    def by_name(self) -> dict[str, SolvedRung]:
        """The rungs by name."""
        return {rung.name: rung for rung in self.rungs}

    @property
    def converged(self) -> bool:
        """Whether every sample of every rung may be used."""
        return all(len(rung.converged) == len(rung.samples) for rung in self.rungs)

    @cached_property
    def best_estimate(self) -> BestEstimate | None:
        """The best estimate, or None without a direct contact that converged."""
        measured = self.subject.surface.measured
        of_map = measured is not None and measured.map is not None
        return best_estimate(self.by_name, self.factors, of_map=of_map)

    def factor(self, rung: SolvedRung, name: str) -> Uncertain:
        """Return the factor on `name` from the rung that `rung` follows; NaN if it is not there."""
        before = self.by_name.get(rung.rung.follows)
        return UNKNOWN if before is None else rung.over(before, name)
