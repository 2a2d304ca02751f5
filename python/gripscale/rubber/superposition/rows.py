"""Rows of sweeps in decades: what is shifted along log f until it is one curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber.sweeps import Sweeps

Array = NDArray[np.float64]

MODULI = {
    "both": ("storage", "loss"),
    "storage": ("storage",),
    "loss": ("loss",),
    "loss_factor": ("loss_factor",),
}
"""What a shift may rest on. E''/E' is no third measurement beside E' and E''; alone it is what the
shape of a specimen, a factor of both, does not change."""


@dataclass(frozen=True)
class Rows:
    """Decades of frequency and of each modulus, and the sweep of each row from the coldest."""

    x: Array
    """log10 of the frequency over 1 Hz, shape (rows,)."""
    y: Array
    """log10 of the moduli over 1 Pa, or of the loss factor, shape (moduli, rows)."""
    sweep: NDArray[np.intp]
    lifts: Array
    """1 for each modulus that b_T multiplies, 0 for the loss factor, shape (moduli,)."""

    @property
    def sweeps(self) -> int:
        """Number of sweeps."""
        return int(self.sweep[-1]) + 1

    def of(self, sweep: int) -> tuple[Array, Array]:
        """Return x and y of one sweep."""
        chosen = self.sweep == sweep
        return self.x[chosen], self.y[:, chosen]


def rows_of(sweeps: Sweeps, moduli: str) -> Rows:
    """Return the rows of `sweeps`, for the choice of `moduli` among `MODULI`."""
    names = MODULI[moduli]
    x = np.log10(sweeps.frequency)
    y = np.array([np.log10(getattr(sweeps, name)) for name in names])
    counts = [len(one) for one in sweeps]
    lifts = np.array([0.0 if name == "loss_factor" else 1.0 for name in names])
    return Rows(x, y, np.repeat(np.arange(len(counts)), counts), lifts)
