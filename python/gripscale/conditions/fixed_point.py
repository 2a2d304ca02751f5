"""Fixed-point iteration of a contact and the rubber it deforms, accelerated by a coarse mesh.

Temperatures and strains x decide what the rubber is; the contact with that rubber has the
temperatures and strains F(x), and the coupled solution is x = F(x), by defect correction with the
same function f on a coarse mesh, or on one mesh by Anderson's acceleration: docs/derivations.md.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

import numpy as np

from gripscale.core import Array, ConvergenceError

S = TypeVar("S")

HISTORY = 3  # evaluations before the last one that Anderson's acceleration uses
LONGEST_STEP = 2.0  # largest change of one component from one x to the next
MOST_PASSES = 10  # most evaluations, on the fine mesh and in each fixed point of the coarse one
# Relative change still expected of contact fraction and friction at the end: a third of the 1e-3
# that the documentation promises.
RESULT_TOLERANCE = 3e-4
# Largest component of f(x) - x at a fixed point, in the logarithms of `pack_state`.
STATE_TOLERANCE = 5e-4
# The same on the coarse mesh before the first fine evaluation: the meshes differ by more.
COARSE_TOLERANCE = 1e-2


@dataclass(frozen=True)
class Iteration(Generic[S]):
    """One evaluation of F or f: a solution with the state `x`, and the state it leads to."""

    solution: S
    x: Array | None  # state the solution assumes; None: the rubber as it is before the contact
    value: Array  # state that follows from the solution
    results: Sequence[float]  # numbers that must not change any more at the end
    usable: bool = True  # whether the solution converged


# Evaluates the state x, starting from the last solution if there is one.
_Solve = Callable[[Array | None, S | None], Iteration[S]]


@dataclass(frozen=True)
class FixedPoint(Generic[S]):
    """The last evaluation on the fine mesh, and the number of evaluations on both meshes."""

    last: Iteration[S]
    fine: int
    coarse: int
    converged: bool


def solve_fixed_point(
    fine: _Solve[S], coarse: _Solve[S] | None, tolerance: float = STATE_TOLERANCE
) -> FixedPoint[S]:
    """Return the solution that agrees with its state, without a `coarse` mesh where that fails."""
    start = None if coarse is None else _evaluated(coarse, None, None)
    if coarse is None or start is None:
        start = fine(None, None)
        return _solve_on_fine_mesh(fine, start, 1, 0, tolerance)
    model = _CoarseModel(coarse, start)
    last: Iteration[S] | None = None
    count, trusted = 0, model.solve(COARSE_TOLERANCE)
    while trusted and count < MOST_PASSES:
        before = model.last
        last = fine(before.x, before.solution if last is None else last.solution)
        count += 1
        if not last.usable:
            return FixedPoint(last, count, model.count, converged=False)
        model.correct(last)
        trusted = model.solve(tolerance)
        pairs = zip(model.last.results, before.results, strict=True)
        change = max(abs(a - b) / max(abs(b), 1e-300) for a, b in pairs)
        if trusted and change < RESULT_TOLERANCE / STATE_TOLERANCE * tolerance:
            return FixedPoint(last, count, model.count, converged=True)
    if last is not None and count == MOST_PASSES:
        return FixedPoint(last, count, model.count, converged=False)
    return _solve_on_fine_mesh(fine, last or start, count, model.count, tolerance)


def _solve_on_fine_mesh(
    fine: _Solve[S], last: Iteration[S], count: int, coarse: int, tolerance: float
) -> FixedPoint[S]:
    """Iterate without a coarse mesh, after `count` fine and `coarse` coarse evaluations."""
    sequence, converged = AndersonSequence(last.value), False
    while last.usable and not converged:
        last = fine(sequence.x, last.solution)
        count += 1
        sequence.add(last.value)
        converged = max(sequence.residual, sequence.step) < tolerance
        if count >= MOST_PASSES:
            break
    return FixedPoint(last, count, coarse, converged)


@dataclass
class AndersonSequence:
    """Arguments of a fixed-point iteration, each from the evaluations before."""

    x: Array  # the next argument
    # The last arguments x and their values f(x).
    history: list[tuple[Array, Array]] = field(default_factory=list)

    @property
    def residual(self) -> float:
        """Largest component of f(x) - x of the last evaluation; infinite before the first."""
        if not self.history:
            return np.inf
        x, value = self.history[-1]
        return float(np.abs(value - x).max())

    @property
    def step(self) -> float:
        """Largest component of the step from the last argument to the next."""
        return float(np.abs(self.x - self.history[-1][0]).max())

    def add(self, value: Array) -> None:
        """Add the value f(x) at the current argument and move to the next."""
        self.history = [*self.history[-HISTORY:], (self.x, value)]
        self._advance()

    def shift(self, offset: Callable[[Array], Array]) -> None:
        """Add `offset(x)` to the values of the history and choose the next argument anew."""
        self.history = [(x, value + offset(x)) for x, value in self.history]
        self._advance()

    def _advance(self) -> None:
        x, value = self.history[-1]
        values = np.array([f for _, f in self.history])
        residuals = np.array([f - x for x, f in self.history])
        following = value
        if len(self.history) > 1:
            changes = np.diff(residuals, axis=0).T
            gamma = np.linalg.lstsq(changes, residuals[-1], rcond=1e-8)[0]
            following = value - np.diff(values, axis=0).T @ gamma
        self.x = x + np.clip(following - x, -LONGEST_STEP, LONGEST_STEP)


class _CoarseModel(Generic[S]):
    """The coarse mesh with its defect F - f added, as a model of the fine one."""

    def __init__(self, evaluate: _Solve[S], start: Iteration[S]) -> None:
        self.evaluate, self.last, self.count = evaluate, start, 1
        self.sequence = AndersonSequence(start.value)
        zero = np.zeros_like(start.value)
        self.defect = _Defect(None, zero, zero, zero)

    def solve(self, tolerance: float) -> bool:
        """Find the fixed point of the model; return whether its residual meets `tolerance`."""
        for _ in range(MOST_PASSES):
            if self.sequence.residual < tolerance:
                return True
            x = self.sequence.x
            iteration = _evaluated(self.evaluate, x, self.last.solution)
            if iteration is None:
                return False
            self.last, self.count = iteration, self.count + 1
            self.sequence.add(iteration.value + self.defect(x))
        return self.sequence.residual < tolerance

    def correct(self, fine: Iteration[S]) -> None:
        """Take the defect at the last argument from the fine evaluation there."""
        before = self.defect
        assert self.last.x is not None
        self.defect = before.updated(self.last.x, fine.value - self.last.value)
        self.sequence.shift(lambda x: self.defect(x) - before(x))


@dataclass(frozen=True)
class _Defect:
    """F(x) - f(x), linear along the step between the last two arguments where it was evaluated."""

    x: Array | None
    value: Array
    step: Array
    change: Array  # of the defect along the step

    def __call__(self, x: Array) -> Array:
        length = self.step @ self.step
        if self.x is None or length == 0.0:
            return self.value
        return np.asarray(self.value + self.change * ((x - self.x) @ self.step) / length)

    def updated(self, x: Array, value: Array) -> _Defect:
        """Return the defect with its value at another argument."""
        if self.x is None:
            return replace(self, x=x, value=value)
        return _Defect(x, value, x - self.x, value - self.value)


def _evaluated(solve: _Solve[S], x: Array | None, start: S | None) -> Iteration[S] | None:
    """Return the evaluation at `x`, None if it has no usable solution."""
    try:
        iteration = solve(x, start)
    except ConvergenceError:
        return None
    return iteration if iteration.usable else None


# Temperature rise [K] above which the state is logarithmic. The first estimate of the heat, from a
# cold rubber, may be a thousand times too high.
WARM = 20.0
LEAST_STRAIN = 1e-12


def pack_state(warming: Array, strain: Array) -> Array:
    """Return temperature rises [K] and strains [-] as one vector with entries of order one."""
    warm = np.log1p(np.maximum(warming, 0.0) / WARM)
    return np.concatenate([warm, np.log(np.maximum(strain, LEAST_STRAIN))])


def unpack_state(x: Array) -> tuple[Array, Array]:
    """Return the temperature rises [K] and strains [-] of a vector of `pack_state`."""
    warm, strain = np.split(x, 2)
    return WARM * np.expm1(np.maximum(warm, 0.0)), np.exp(strain)
