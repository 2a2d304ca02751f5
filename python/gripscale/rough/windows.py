"""How far one measurement speaks for the surface: the contact of its windows, and their scatter."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from scipy import stats

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rough.grid import Array
from gripscale.rough.result import RoughContact
from gripscale.rough.solve import solve_rough_contact
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile
from gripscale.surface.profile import FEWEST_POINTS

LEAST_VALID = 0.5
"""Share of heights a window must have."""


@dataclass(frozen=True)
class WindowContacts:
    """Contacts of the windows of one surface; those that did not converge count in no number.

    A `name` below is that of a number of `RoughContact`, in its unit: `contact_fraction`,
    `friction`, `friction_from_dissipation` and so on.
    """

    contacts: list[RoughContact]
    """One for each window."""

    def values(self, name: str) -> Array:
        """Return a number of each window that converged, shape (windows,)."""
        return np.array([float(getattr(c, name)) for c in self.contacts if c.converged])

    def mean(self, name: str) -> float:
        """Return the mean over windows; NaN if none converged.

        Pressure and size are the same, so it is the surface's.
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
        1993, ch. 13); NaN for fewer than three windows. Too narrow if windows are shorter than the
        surface's longest correlation, or few.

        Parameters
        ----------
        name : str
            The number.
        level : float
            Confidence level, between 0 and 1.
        seed : int
            Seed of the resamples.

        Returns
        -------
        tuple of two floats
            Its lower and upper end.
        """
        values = self.values(name)
        if values.size < 3:
            return math.nan, math.nan
        found = stats.bootstrap(
            (values,),
            np.mean,
            confidence_level=level,
            method="percentile",
            rng=np.random.default_rng(seed),
        )
        return float(found.confidence_interval.low), float(found.confidence_interval.high)


def windows(
    surface: Profile | HeightMap, length: float | tuple[float, float]
) -> list[Profile | HeightMap]:
    """Return the surface cut into as many windows as fit, centred.

    Windows with fewer than half their heights are left out.

    Parameters
    ----------
    surface : Profile or HeightMap
        The surface.
    length : float or (float, float)
        Length of the windows along x, and for a map along y [m]; of one length alone, the windows
        of a map are as wide as the map.

    Raises
    ------
    InputError
        If a window would have fewer than 16 points a way or be longer than the surface, or none is
        left.
    """
    lengths = tuple(length) if isinstance(length, tuple | list) else (length,)
    if not isinstance(surface, Profile | HeightMap):
        raise InputError(f"surface must be a Profile or a HeightMap; got {type(surface).__name__}")
    if not 1 <= len(lengths) <= surface.z.ndim:
        raise InputError(
            f"length must be one of a profile, one or two of a map; got {checks.shown(length)}"
        )
    axes = [surface.x] if isinstance(surface, Profile) else [surface.x, surface.y]
    cuts = [_cut(axis, part) for axis, part in zip(axes, lengths, strict=False)]
    places = [
        place for place in product(*cuts) if np.isfinite(surface.z[place]).mean() >= LEAST_VALID
    ]
    if not places:
        raise InputError(f"length {length} m leaves no window with half of its heights")
    if isinstance(surface, Profile):
        return [Profile(surface.x[p], surface.z[p], surface.name) for (p,) in places]
    whole = slice(None)
    return [
        HeightMap(surface.x[p], surface.y[q], surface.z[p, q], surface.name)
        for p, q in ((*place, whole)[:2] for place in places)
    ]


def _cut(axis: Array, length: float) -> list[slice]:
    """Return the centred windows of `length` [m] along an axis."""
    step = float((axis[-1] - axis[0]) / (axis.size - 1))
    share = checks.positive("length", length, unit="m") / step
    points = round(min(share, 2.0 * axis.size))
    if not FEWEST_POINTS <= points <= axis.size:
        raise InputError(
            f"length must be from {FEWEST_POINTS * step:.4g} m to {axis.size * step:.4g} m, "
            f"the surface's; got {length:.4g} m"
        )
    number = axis.size // points
    first = (axis.size - number * points) // 2
    return [slice(first + i * points, first + (i + 1) * points) for i in range(number)]


def solve_windows(
    rubber: Rubber,
    surface: Profile | HeightMap,
    length: float | tuple[float, float],
    **load: Any,
) -> WindowContacts:
    """Return the direct contact of each of the `windows` of `surface`.

    Parameters
    ----------
    rubber, **load
        As for `solve_rough_contact`; `periodic` makes no sense here.
    surface, length
        As for `windows`.

    Raises
    ------
    InputError
        As these do.
    """
    return WindowContacts(
        [solve_rough_contact(rubber, window, **load) for window in windows(surface, length)]
    )
