"""What an earlier run of the same case left in its folder, taken up instead of solved again.

A finished prediction is taken up whole. Of an unfinished one the waves that converged are, where
each wave depends on nothing but the one above it: under one pressure class, and without conditions
that are solved for in several passes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from gripscale import netcdf
from gripscale.chain.model import Chain
from gripscale.chain.prediction import Prediction
from gripscale.errors import FileError, InputError
from gripscale.wave.problem import WaveProblem
from gripscale.wave.result import WaveResult
from gripscale.wave.solver import WaveSolver

KEY, FINISHED = "prediction_key", "prediction_finished"
"""Attributes of a result: what it depends on, and whether its chain came to its end."""


@dataclass(frozen=True)
class Earlier:
    """A prediction of an earlier run: all of it, or as many waves as converged."""

    prediction: Prediction
    finished: bool

    def solver(self, solver: WaveSolver) -> WaveSolver:
        """Return `solver`, which need not solve what is known."""
        return TakenUp(solver, tuple(self.prediction.scales))


@dataclass(frozen=True)
class TakenUp:
    """Answers known waves with their stored results, and solves the others."""

    inner: WaveSolver
    known: tuple[WaveResult, ...]

    @property
    def name(self) -> str:
        """That of the solver inside."""
        return self.inner.name

    def solve(self, problem: WaveProblem, start: WaveResult | None = None) -> WaveResult:
        """Return the stored result of just this wave under just this pressure, or solve it."""
        asked = problem.profile.wavelength, problem.profile.amplitude, problem.load.pressure
        for wave in self.known:
            if (wave.wavelength, wave.amplitude, wave.pressure_received) == asked:
                return wave
        return self.inner.solve(problem, start)


def earlier(path: Path, key: str, chain: Chain) -> Earlier | None:
    """Return the prediction stored at `path`, or None if it is not of `key` or of no use."""
    try:
        data = netcdf.load(path)
        found = Prediction.from_dataset(data) if data.attrs.get(KEY) == key else None
    except (FileError, InputError):
        return None
    if found is None:
        return None
    finished = bool(data.attrs.get(FINISHED, 0))
    if finished and found.converged:
        return Earlier(found, finished=True)
    iterated = chain.conditions is not None and chain.conditions.iterated
    if iterated or chain.pressure_classes > 1:
        return None
    kept = [wave for wave in found.scales if wave.converged]
    return Earlier(replace(found, scales=kept), finished=False) if kept else None
