"""A best estimate: the profile as measured, times what else is known to matter.

    A/A_0 = (direct contact) x (finite strain/small strain) x (isotropic map/its lines)

and friction likewise. Each factor is a ratio of two models on the same surfaces, with its own
uncertainty; relative uncertainties of the independent factors add in squares (see `uncertain`). A
factor nobody has computed is named and counts as not included: it neither moves nor widens the
estimate.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import NamedTuple

from gripscale.comparison.ladder import DIRECT
from gripscale.comparison.solved import SolvedRung
from gripscale.comparison.uncertain import UNKNOWN, Uncertain


class FactorOf(NamedTuple):
    """A factor of the best estimate: what it is, and which rungs it is the ratio of."""

    name: str
    label: str
    over: str
    under: str


MAP = "map"
"""The rung of synthetic maps."""

FACTORS = (
    FactorOf("finite_strain", "finite strain", "windows_finite_strain", "windows_half_plane"),
    FactorOf("isotropic_map", "isotropic map over its lines", MAP, "map_lines"),
)
"""All factors; a new one is added here."""


@dataclass(frozen=True)
class Factor:
    """A factor on contact fraction and friction; `UNKNOWN` where it is not included."""

    name: str
    label: str
    contact_fraction: Uncertain = UNKNOWN
    friction: Uncertain = UNKNOWN

    @property
    def included(self) -> bool:
        """Whether both numbers are known."""
        numbers = (self.contact_fraction.value, self.friction.value)
        return all(value == value for value in numbers)


@dataclass(frozen=True)
class BestEstimate:
    """Contact fraction and friction with their relative uncertainties, and what they are made of.

    Parameters
    ----------
    base : Factor
        The direct contact of the profile as measured: numbers, not ratios.
    factors : sequence of Factor
        What they are multiplied by, as far as included.
    """

    base: Factor
    factors: Sequence[Factor]

    @property
    def contact_fraction(self) -> Uncertain:
        """Real over nominal contact area [-], the product of what is included."""
        parts = [factor.contact_fraction for factor in self.included]
        return reduce(Uncertain.times, parts, self.base.contact_fraction)

    @property
    def friction(self) -> Uncertain:
        """Friction coefficient [-], the product of what is included."""
        parts = [factor.friction for factor in self.included]
        return reduce(Uncertain.times, parts, self.base.friction)

    @property
    def included(self) -> list[Factor]:
        """The factors that are known."""
        return [factor for factor in self.factors if factor.included]

    @property
    def missing(self) -> list[Factor]:
        """The factors nobody has computed."""
        return [factor for factor in self.factors if not factor.included]


def best_estimate(
    rungs: Mapping[str, SolvedRung], supplied: Sequence[Factor] = (), *, of_map: bool = False
) -> BestEstimate | None:
    """Return the best estimate of the rungs, or None without a direct contact that converged.

    Parameters
    ----------
    rungs : mapping
        The solved rungs by name.
    supplied : sequence of Factor
        Factors known from elsewhere; one with the name of ours replaces it.
    of_map : bool
        Whether a map was measured, which is no line that needs a factor.
    """
    direct = rungs.get(DIRECT)
    if direct is None or not direct.converged:
        return None
    base = Factor(
        DIRECT, direct.label, direct.uncertain("contact_fraction"), direct.uncertain("friction")
    )
    needed = [one for one in FACTORS if not (of_map and one.over == MAP)]
    factors = {one.name: _ratio(one, rungs) for one in needed}
    factors |= {one.name: one for one in supplied}
    return BestEstimate(base, list(factors.values()))


def _ratio(of: FactorOf, rungs: Mapping[str, SolvedRung]) -> Factor:
    over, under = rungs.get(of.over), rungs.get(of.under)
    if over is None or under is None:
        return Factor(of.name, of.label)
    # of the two frictions the one that a coarse grid changes least
    ratios = (over.over(under, name) for name in ("contact_fraction", "friction_from_dissipation"))
    return Factor(of.name, of.label, *ratios)
