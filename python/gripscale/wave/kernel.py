"""The only way to the compiled kernel: a problem in, its solution out, errors in our own words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from gripscale import _kernel, checks
from gripscale.errors import InputError
from gripscale.wave.mesh import Mesh
from gripscale.wave.problem import WaveProblem
from gripscale.wave.result import WaveResult

if TYPE_CHECKING:
    from collections.abc import Callable

Solution = _kernel.Solution
T = TypeVar("T")


@lru_cache(maxsize=1)
def default_settings() -> Mapping[str, float]:
    """Return every constant of the solver with its default, by name."""
    return {
        "max_iterations": 40.0,
        "residual_tolerance": 1e-8,
        "iteration_budget": 500.0,
        "largest_step": 0.4,
    }


def describe_settings() -> str:
    """Return name, default and meaning of every constant of the solver, one a line."""
    return "\n".join(
        f"{name} = {value:g}: {text}" for name, value, text in _kernel.default_settings()
    )


def checked_settings(settings: Mapping[str, float]) -> Mapping[str, float]:
    """Return what differs from the defaults; raise `InputError` for an unknown name or value."""
    for name in settings:
        checks.one_of("setting", name, default_settings())
    return {name: checks.positive(name, value) for name, value in settings.items()}


def solve_steady(
    problem: WaveProblem,
    mesh: Mesh,
    settings: Mapping[str, float],
    tolerance: float | None,
    start: Solution | None,
) -> Solution:
    """Return the static or steadily sliding solution; `start` is a first guess."""
    return _asked(
        lambda: _kernel.solve_scale(_inputs(problem, mesh) | _extra(settings, tolerance), start)
    )


def solve_transient(
    problem: WaveProblem,
    mesh: Mesh,
    settings: Mapping[str, float],
    stages: Sequence[tuple[float, float, float]],
    start: Solution | None,
) -> tuple[str, int, NDArray[np.float64]]:
    """Return status, iterations and a row of numbers for each moment of a programme in time."""
    inputs = _inputs(problem, mesh) | _extra(settings, None)
    return _asked(lambda: _kernel.run_stages(inputs, list(stages), start))


def solution_of(start: WaveResult) -> Solution:
    """Return the kernel's solution behind a result.

    Raises `InputError` if there is none: the result is of another solver, or from a file.
    """
    if isinstance(start.solution, Solution):
        return start.solution
    raise InputError(
        "start must be a result of the finite-strain block solved in this process; "
        f"got one of {start.model}"
        + (" without the solver's state, as read from a file" if start.solution is None else "")
    )


def _inputs(problem: WaveProblem, mesh: Mesh) -> Any:
    rubber, profile, load = problem.rubber, problem.profile, problem.load
    return {
        "strain_energy": rubber.strain_energy.coefficients(),
        "equilibrium_modulus": rubber.equilibrium_modulus / 3.0,
        "moduli": (rubber.moduli / 3.0).tolist(),
        "relaxation_times": rubber.relaxation_times.tolist(),
        "bulk_modulus": rubber.bulk_modulus,
        "wavelength": profile.wavelength,
        "amplitude": profile.amplitude,
        "pressure": load.pressure,
        "speed": load.speed,
        "load_time": load.load_time,
        "depth": mesh.depth,
        "columns": mesh.columns,
        "rows": mesh.rows,
        "order": mesh.element_order,
    }


def _extra(settings: Any, tolerance: Any) -> Any:
    return {
        "tolerance": tolerance,
        "iterations": int(settings.get("max_iterations", 40)),
        "budget": 500,
        "residual_tolerance": settings.get("residual_tolerance", 1e-8),
        "step": 0.4,
    }


def _asked(call: Callable[[], T]) -> T:
    try:
        return call()
    except ValueError as error:
        raise InputError(str(error)) from error
