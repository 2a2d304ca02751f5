"""Anderson's acceleration of a fixed point x = f(x): the next x from the last few.

    x_next = f_k - sum_j gamma_j (f_j+1 - f_j)

with r = f - x and gamma minimising |r_k - sum_j gamma_j (r_j+1 - r_j)|. Source: D. G. Anderson,
J. ACM 12 (1965) 547, doi:10.1145/321296.321305; as here in H. F. Walker & P. Ni, SIAM J. Numer.
Anal. 49 (2011) 1715, doi:10.1137/10078356X.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

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
