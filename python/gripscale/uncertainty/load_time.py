"""A solver of one wave that takes every wave to be loaded a factor longer.

    t_i = factor A_(i-1) / v

The load time is that of a mean contact; contacts are shorter and longer than their mean, and the
modulus of the mean state goes with it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from gripscale import checks
from gripscale.wave.problem import WaveProblem
from gripscale.wave.result import WaveResult
from gripscale.wave.solver import RefinableSolver, WaveSolver


def loaded_longer(solver: WaveSolver, factor: float) -> WaveSolver:
    """Return the solver for waves loaded `factor` [-] times as long as it is told.

    Raises `InputError` if the factor is not above zero.
    """
    times = checks.positive("factor", factor)
    if isinstance(solver, RefinableSolver):
        return RefinableLongerLoaded(solver, times)
    return LongerLoaded(solver, times)


@dataclass(frozen=True)
class LongerLoaded:
    """What `loaded_longer` makes of a solver that cannot be refined."""

    solver: WaveSolver
    factor: float

    @property
    def name(self) -> str:
        """Word for the solver within."""
        return self.solver.name

    def solve(self, problem: WaveProblem, start: WaveResult | None = None) -> WaveResult:
        """Return contact and friction of `problem`, loaded so much longer."""
        load = replace(problem.load, load_time=self.factor * problem.load.load_time)
        return self.solver.solve(replace(problem, load=load), start)


@dataclass(frozen=True)
class RefinableLongerLoaded(LongerLoaded):
    """What `loaded_longer` makes of a `RefinableSolver`."""

    solver: RefinableSolver

    def coarser(self) -> WaveSolver:
        """Return the coarser solver, loaded as long."""
        return loaded_longer(self.solver.coarser(), self.factor)
