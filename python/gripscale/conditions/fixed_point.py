"""Anderson's acceleration of a fixed point x = f(x): the next x from the last few.

    x_next = f_k - sum_j gamma_j (f_j+1 - f_j)

with r = f - x and gamma minimising |r_k - sum_j gamma_j (r_j+1 - r_j)|. Source: D. G. Anderson,
J. ACM 12 (1965) 547, doi:10.1145/321296.321305; as here in H. F. Walker & P. Ni, SIAM J. Numer.
Anal. 49 (2011) 1715, doi:10.1137/10078356X.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST_PASSES = 8
"""After which iteration ends, on the meshes or grids asked for and before on coarse ones."""
SETTLED = 3e-4
"""Relative change of contact fraction and friction between passes at which they have settled: a
third of the 1e-3 that is promised."""
AGREED = 2e-3
"""Largest difference of what was found from what was assumed, of log strains and temperatures
(`mixing`), at which they agree: friction changes by less than half of it."""

REMEMBERED = 3
LONGEST_STEP = 2.0
"""Largest change of one component from one x to the next."""


@dataclass
class FixedPoint:
    """What is assumed, and what was found for the last few assumptions."""

    assumed: Array
    _tried: list[tuple[Array, Array]] = field(default_factory=list)

    @property
    def missed(self) -> float:
        """Largest difference of what was found last from what was assumed for it."""
        assumed, value = self._tried[-1]
        return float(np.abs(value - assumed).max())

    def anew(self) -> FixedPoint:
        """Return what is assumed, without what was found: for another f."""
        return FixedPoint(self.assumed)

    def settled(self, now: Sequence[float], last: Sequence[float] | None) -> bool:
        """Return whether the last pass found what it was assumed for, and changed no result.

        `now` and `last` are the results of the last two passes; None after the first.
        """
        if self.missed >= AGREED:
            return False
        pairs = () if last is None else zip(now, last, strict=True)
        return all(abs(a - b) < SETTLED * max(abs(b), 1e-300) for a, b in pairs)

    def found(self, value: Array) -> None:
        """Take f of what is assumed, and assume better."""
        self._tried = [*self._tried[-REMEMBERED:], (self.assumed, value)]
        values = np.array([f for _, f in self._tried])
        misses = np.array([f - x for x, f in self._tried])
        following = value
        if len(self._tried) > 1:
            steps = np.diff(misses, axis=0).T
            gamma = np.linalg.lstsq(steps, misses[-1], rcond=1e-8)[0]
            following = value - np.diff(values, axis=0).T @ gamma
        step = np.clip(following - self.assumed, -LONGEST_STEP, LONGEST_STEP)
        self.assumed = self.assumed + step
