"""The solvers of one wave a chain can be asked for by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from gripscale import checks
from gripscale.errors import InputError
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.result import WaveResult
from gripscale.wave.solver import WaveSolver, solver_of

WAVE_SOLVERS: dict[str, Any] = {solver.name: solver for solver in (FiniteStrainBlock, HalfPlane)}
"""By name. A new one is added here."""

WaveSolverLike = WaveSolver | str | Callable[..., WaveResult]


def wave_solver(solver: WaveSolverLike, options: Mapping[str, Any]) -> WaveSolver:
    """Return the solver of a name, a face or itself, with its options.

    Raises `InputError` for an unknown name or option, or options of a solver that has its own.
    """
    if isinstance(solver, str):
        made = WAVE_SOLVERS[checks.one_of("solver", solver, WAVE_SOLVERS)]
        return _checked(made.of(**options))
    face = solver_of(solver)
    if face is not None:
        return _checked(face.of(**options))
    if not isinstance(solver, WaveSolver):
        raise InputError(
            f"solver must be one of {', '.join(WAVE_SOLVERS)} or a WaveSolver such as "
            f"HalfPlane(points=1024); got {checks.shown(solver)}"
        )
    if options:
        raise InputError(
            f"{min(options)} belongs to the solver: give it there, as in HalfPlane(points=1024)"
        )
    return solver


def _checked(made: Any) -> WaveSolver:
    assert isinstance(made, WaveSolver)
    return made
