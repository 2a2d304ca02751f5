"""Passes until a solution finds what it was solved with, most of them on a coarse mesh.

With F(x) what the solution for x finds on the mesh asked for, f(x) what it finds on a coarse one,
the next x after F(x_k) solves

    x = f(x) + F(x_k) - f(x_k)

(defect correction: H. J. Stetter, Numer. Math. 29 (1978) 425, doi:10.1007/BF01432879), the last
term changing as it did between the last two x_k (C. G. Broyden, Math. Comp. 19 (1965) 577,
doi:10.1090/S0025-5718-1965-0198670-6). What the coarse mesh's results change on the way there is
how far those of F(x_k) still are from the end.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from gripscale.core.errors import ConvergenceError

# Anderson's acceleration of a fixed point x = f(x): the next x from the last few.
#
#     x_next = f_k - sum_j gamma_j (f_j+1 - f_j)
#
# with r = f - x and gamma minimising |r_k - sum_j gamma_j (r_j+1 - r_j)|. Source: D. G. Anderson,
# J. ACM 12 (1965) 547, doi:10.1145/321296.321305; as here in H. F. Walker & P. Ni, SIAM J. Numer.
# Anal. 49 (2011) 1715, doi:10.1137/10078356X.

Array = NDArray[np.float64]

REMEMBERED = 3
LONGEST_STEP = 2.0
"""Largest change of one component from one x to the next."""


@dataclass
class FixedPoint:
    """What is assumed, and what was found for the last few assumptions."""

    assumed: Array
    _tried: list[tuple[Array, Array]] = field(default_factory=list)

    @property
    def tried(self) -> bool:
        """Whether anything was found yet."""
        return bool(self._tried)

    @property
    def missed(self) -> float:
        """Largest difference of what was found last from what was assumed for it."""
        assumed, value = self._tried[-1]
        return float(np.abs(value - assumed).max())

    def found(self, value: Array) -> None:
        """Take f of what is assumed, and assume better."""
        self._tried = [*self._tried[-REMEMBERED:], (self.assumed, value)]
        self._improve()

    @property
    def step(self) -> float:
        """Largest difference of what is assumed next from what was assumed last."""
        return float(np.abs(self.assumed - self._tried[-1][0]).max())

    def shift(self, offset: Callable[[Array], Array]) -> None:
        """Add `offset` of x to f, wherever it was found, and assume better."""
        self._tried = [(x, f + offset(x)) for x, f in self._tried]
        self._improve()

    def _improve(self) -> None:
        assumed, value = self._tried[-1]
        values = np.array([f for _, f in self._tried])
        misses = np.array([f - x for x, f in self._tried])
        following = value
        if len(self._tried) > 1:
            steps = np.diff(misses, axis=0).T
            gamma = np.linalg.lstsq(steps, misses[-1], rcond=1e-8)[0]
            following = value - np.diff(values, axis=0).T @ gamma
        self.assumed = assumed + np.clip(following - assumed, -LONGEST_STEP, LONGEST_STEP)


MOST_PASSES = 8
"""After which iteration ends, on the mesh asked for and, each time, on the coarse one."""
SETTLED = 3e-4
"""Relative change of contact fraction and friction still to be expected at which they have settled:
a third of the 1e-3 that is promised."""
AGREED = 5e-4
"""Largest difference of what was found from what was assumed, of log strains and temperatures
(`mixing`), at which they agree."""
ROUGH = 1e-2
"""The same on the coarse mesh before the fine one is asked: they differ by more."""

S = TypeVar("S")


@dataclass(frozen=True)
class Iteration(Generic[S]):
    """A solution for what was assumed, and what it finds instead."""

    solved: S
    assumed: Array | None
    """None: the rubber as it is before the contact."""
    found: Array
    results: Sequence[float]
    """What must not change any more."""
    usable: bool = True
    """Whether the solution converged."""


Solve = Callable[[Array | None, S | None], Iteration[S]]
"""Solves for what is assumed, from the last solution if there is one."""


@dataclass(frozen=True)
class Passes(Generic[S]):
    """The last pass, and how many it took."""

    last: Iteration[S]
    fine: int
    """On the mesh asked for."""
    coarse: int
    settled: bool


def solve_coupled(fine: Solve[S], coarse: Solve[S] | None) -> Passes[S]:
    """Return the passes until solution and assumption agree.

    Parameters
    ----------
    fine, coarse
        Solve on the mesh asked for, and in a fraction of the time; a coarse mesh that fails, or
        does not settle, is given up.
    """
    start = None if coarse is None else _tried(coarse, None, None)
    if coarse is None or start is None:
        start = fine(None, None)
        return _alone(fine, FixedPoint(start.found), start, (1, 0))
    stand_in = _StandIn(coarse, start)
    last: Iteration[S] | None = None
    number, trusted = 0, stand_in.agrees(ROUGH)
    while trusted and number < MOST_PASSES:
        here = stand_in.last
        last = fine(here.assumed, here.solved if last is None else last.solved)
        number += 1
        trusted = last.usable and stand_in.corrected_by(last).agrees(AGREED)
        if not last.usable or (trusted and _change(stand_in.last, here) < SETTLED):
            return Passes(last, number, stand_in.passes, settled=last.usable)
    if last is not None and number == MOST_PASSES:
        return Passes(last, number, stand_in.passes, settled=False)
    so_far = last or start
    return _alone(fine, FixedPoint(so_far.found), so_far, (number, stand_in.passes))


def _alone(
    fine: Solve[S], point: FixedPoint, last: Iteration[S], before: tuple[int, int]
) -> Passes[S]:
    """Return the passes without a coarse mesh, after so many fine and coarse ones."""
    number, coarse = before
    if not last.usable:
        return Passes(last, number, coarse, settled=False)
    while True:
        now = fine(point.assumed, last.solved)
        number += 1
        point.found(now.found)
        agreed = max(point.missed, point.step) < AGREED
        if agreed or not now.usable or number >= MOST_PASSES:
            return Passes(now, number, coarse, settled=agreed)
        last = now


class _StandIn(Generic[S]):
    """The coarse mesh, moved to where the fine one is."""

    def __init__(self, solve: Solve[S], start: Iteration[S]) -> None:
        self.solve, self.point, self.last = solve, FixedPoint(start.found), start
        self.offset = _Offset.nothing(start.found)
        self.passes = 1

    def agrees(self, enough: float) -> bool:
        """Solve until what is found is what was assumed; return whether that was reached."""
        for _ in range(MOST_PASSES):
            if self.point.tried and self.point.missed < enough:
                return True
            assumed = self.point.assumed
            now = _tried(self.solve, assumed, self.last.solved)
            if now is None:
                return False
            self.last, self.passes = now, self.passes + 1
            self.point.found(now.found + self.offset(assumed))
        return self.point.missed < enough

    def corrected_by(self, fine: Iteration[S]) -> _StandIn[S]:
        """Move to where the fine mesh finds what it does for the same assumption."""
        last, here = self.offset, self.last
        assert here.assumed is not None
        self.offset = last.moved(here.assumed, fine.found - here.found)
        self.point.shift(lambda x: self.offset(x) - last(x))
        return self


@dataclass(frozen=True)
class _Offset:
    """F(x) - f(x): known at one x, and how it changes along the way to it from the last."""

    at: Array | None
    value: Array
    way: Array
    gained: Array
    """On that way."""

    @classmethod
    def nothing(cls, like: Array) -> _Offset:
        """Return no offset, anywhere."""
        none = np.zeros_like(like)
        return cls(None, none, none, none)

    def __call__(self, x: Array) -> Array:
        """Return the offset at `x`."""
        length = self.way @ self.way
        if self.at is None or length == 0.0:
            return self.value
        return np.asarray(self.value + self.gained * ((x - self.at) @ self.way) / length)

    def moved(self, at: Array, value: Array) -> _Offset:
        """Return the offset with its value at another x."""
        if self.at is None:
            return replace(self, at=at, value=value)
        return _Offset(at, value, at - self.at, value - self.value)


def _tried(solve: Solve[S], assumed: Array | None, last: S | None) -> Iteration[S] | None:
    """Return the pass, None if there is no solution."""
    try:
        now = solve(assumed, last)
    except ConvergenceError:
        return None
    return now if now.usable else None


def _change(now: Iteration[S], last: Iteration[S]) -> float:
    """Return the largest relative change of the results."""
    pairs = zip(now.results, last.results, strict=True)
    return max(abs(a - b) / max(abs(b), 1e-300) for a, b in pairs)


# Temperatures and strains in one vector of numbers of the same order, to be iterated on.

WARM = 20.0
"""Kelvin above which temperatures go by their logarithm: the first guess of the heat, from a cold
rubber, may be a thousand too high."""
LEAST_STRAIN = 1e-12


def mixed(warming: Array, strain: Array) -> Array:
    """Return the vector of temperature rises [K] and strains [-]."""
    warm = np.log1p(np.maximum(warming, 0.0) / WARM)
    return np.concatenate([warm, np.log(np.maximum(strain, LEAST_STRAIN))])


def separate(vector: Array) -> tuple[Array, Array]:
    """Return temperature rises [K] and strains [-] of a vector of `mixed`."""
    warm, strain = np.split(vector, 2)
    return WARM * np.expm1(np.maximum(warm, 0.0)), np.exp(strain)
