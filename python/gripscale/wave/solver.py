"""What every solver of one wave looks like from outside."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar, runtime_checkable

from gripscale.wave.problem import WaveProblem
from gripscale.wave.result import WaveResult

F = TypeVar("F", bound=Callable[..., WaveResult])


@runtime_checkable
class WaveSolver(Protocol):
    """Solves one wave; how it does it (mesh, accuracy) is in its own fields.

    A frozen dataclass whose fields decide its results together with the problem: studies name
    their results by them.
    """

    @property
    def name(self) -> str:
        """Word for it in results and case files."""

    def solve(self, problem: WaveProblem, start: WaveResult | None = None) -> WaveResult:
        """Return contact and friction of `problem`.

        `start`, the result of a neighbouring problem, makes it quicker and never changes the
        answer by more than the residual; a solver that has no use for it raises `InputError`.
        """


@runtime_checkable
class RefinableSolver(WaveSolver, Protocol):
    """A solver that starts from earlier results, and has a quicker one of its kind."""

    def coarser(self) -> WaveSolver:
        """Return the solver on a mesh that takes a fraction of the time."""


def face_of(solver: type) -> Callable[[F], F]:
    """Mark a function with keyword arguments as the face of `solver`.

    `gripscale.predict` then takes the function in place of the solver.
    """

    def mark(function: F) -> F:
        setattr(function, "solver", solver)  # noqa: B010 (functions declare no attributes)
        return function

    return mark


def solver_of(face: Any) -> Any:
    """Return the solver class behind a function marked by `face_of`, or None."""
    return getattr(face, "solver", None)
