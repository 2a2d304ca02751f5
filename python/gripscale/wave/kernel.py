"""The only module that calls the compiled kernel, and the protocol of every solver of one wave."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, Protocol, TypeVar, runtime_checkable

import gripscale._kernel as _kernel
from gripscale.core import InputError, checks
from gripscale.core.parallel import look, worker_count
from gripscale.rubber import Rubber
from gripscale.wave.problem import Mesh, SampledProfile, Sine, WaveProblem
from gripscale.wave.result import ScaleResult

Solution = _kernel.Solution
_T = TypeVar("_T")


@lru_cache(maxsize=1)
def default_settings() -> Mapping[str, float]:
    """Return the settings of the solver with their defaults, by name."""
    return {name: value for name, value, _ in _kernel.default_settings()}


def describe_settings() -> str:
    """Return name, default and meaning of every setting of the solver, one a line."""
    listed = _kernel.default_settings()
    return "\n".join(f"{name} = {value:g}: {text}" for name, value, text in listed)


def solve_steady(
    problem: WaveProblem,
    mesh: Mesh,
    settings: Mapping[str, float],
    tolerance: float | None,
    start: Solution | None,
    time_limit: float | None,
    workers: int | None,
) -> Solution:
    """Return the static or steadily sliding solution; Ctrl-C and the end of a job interrupt it."""
    inputs = {**_body(problem.rubber, problem.profile, mesh), "load": vars(problem.load)}
    work = _work(workers, time_limit)
    return _checked_call(lambda: _kernel.solve_steady(inputs, settings, tolerance, start, work))


def solve_stages(
    rubber: Rubber,
    profile: Sine | SampledProfile,
    mesh: Mesh,
    settings: Mapping[str, float],
    stages: Sequence[tuple[float, float, float]],
    start: Solution | None,
    time_limit: float | None,
    workers: int | None,
) -> _kernel.Run:
    """Return the moments of a programme in time, with status and iterations."""
    body, work = _body(rubber, profile, mesh), _work(workers, time_limit)
    return _checked_call(lambda: _kernel.solve_transient(body, settings, list(stages), start, work))


def solution_of(start: ScaleResult) -> Solution:
    """Return the kernel's solution behind a result; `InputError` without it, as from a file."""
    checks.instance("start", start, ScaleResult)
    if isinstance(start.solution, Solution):
        return start.solution
    raise InputError(
        "start must be a result of the finite-strain block solved in this process; "
        f"got one of {start.model}"
        + (" without the solver's state, as read from a file" if start.solution is None else "")
    )


def _work(workers: int | None, time_limit: float | None) -> dict[str, Any]:
    return {"workers": worker_count(workers), "time_limit": time_limit, "look": look}


def _body(rubber: Rubber, profile: Sine | SampledProfile, mesh: Mesh) -> dict[str, Any]:
    heights = {"kind": "sine", **vars(profile)}
    if isinstance(profile, SampledProfile):
        heights |= {"kind": "sampled", "heights": profile.heights.tolist()}
    return {
        "rubber": {
            "equilibrium_modulus": rubber.equilibrium_modulus / 3.0,
            "moduli": (rubber.moduli / 3.0).tolist(),
            "relaxation_times": rubber.relaxation_times.tolist(),
            "bulk_modulus": rubber.bulk_modulus,
            "strain_energy": (rubber.strain_energy.kind, rubber.strain_energy.parameters()),
        },
        "profile": heights,
        "mesh": vars(mesh),
    }


def _checked_call(call: Callable[[], _T]) -> _T:
    """Return what the kernel returns; its refusals are `InputError`s."""
    try:
        return call()
    except ValueError as error:
        raise InputError(str(error)) from error


@runtime_checkable
class WaveSolver(Protocol):
    """Solves one wave: a frozen dataclass, by whose fields stored results are named."""

    @property
    def name(self) -> str:
        """Word for the solver in results and case files."""

    def solve(self, problem: WaveProblem, start: ScaleResult | None = None) -> ScaleResult:
        """Return contact and friction of `problem`.

        `start`, the result of a neighbouring problem, saves time and changes the result by the
        residual at most. A solver that cannot start from a result raises `InputError`.
        """


@runtime_checkable
class RefinableSolver(WaveSolver, Protocol):
    """A solver that can start from results, and has a coarser version of itself."""

    def coarser(self) -> WaveSolver:
        """Return the solver on a mesh that takes a fraction of the time."""
