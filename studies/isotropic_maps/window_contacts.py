"""The contacts of the windows of a surface, and their scatter.

Windows show how well one measurement represents the surface.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import bootstrap

from gripscale.half_space import RoughContact, solve_rough_contact, windows
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile


@dataclass(frozen=True)
class WindowContacts:
    """Contacts of the windows of one surface; statistics use those that converged.

    A `name` is that of a number of `RoughContact`, in its unit: `contact_fraction`, `friction`,
    `friction_from_dissipation` and so on.
    """

    contacts: list[RoughContact]
    """One for each window."""

    def values(self, name: str) -> np.ndarray:
        """Return a number of each window that converged, shape (windows,)."""
        return np.array([float(getattr(c, name)) for c in self.contacts if c.converged])

    def mean(self, name: str) -> float:
        """Return the mean over windows; NaN if none converged.

        All windows have the same pressure and size, so that this is the mean of the surface.
        """
        values = self.values(name)
        return float(values.mean()) if values.size else math.nan

    def scatter(self, name: str) -> float:
        """Return the standard deviation from window to window; NaN for fewer than two."""
        values = self.values(name)
        return float(values.std(ddof=1)) if values.size > 1 else math.nan

    def confidence_interval(
        self, name: str, *, level: float = 0.95, seed: int = 0
    ) -> tuple[float, float]:
        """Return the interval of the mean by a block bootstrap, the windows being the blocks.

        Percentiles of 9999 resamples (B. Efron & R. Tibshirani, An Introduction to the Bootstrap,
        1993, ch. 13), `level` being between 0 and 1; NaN for fewer than three windows. Too narrow
        if windows are shorter than the surface's longest correlation, or few.
        """
        values = self.values(name)
        if values.size < 3:
            return math.nan, math.nan
        random = np.random.default_rng(seed)
        interval = bootstrap(
            (values,), np.mean, confidence_level=level, method="percentile", rng=random
        ).confidence_interval
        return float(interval.low), float(interval.high)


def solve_windows(
    rubber: Rubber, surface: Profile | HeightMap, length: float | tuple[float, float], **load: Any
) -> WindowContacts:
    """Return the direct contact of each of the `windows` of `surface`.

    Arguments and errors are those of `windows` and of `solve_rough_contact`, without `periodic`.
    """
    return WindowContacts(
        [solve_rough_contact(rubber, window, **load) for window in windows(surface, length)]
    )
