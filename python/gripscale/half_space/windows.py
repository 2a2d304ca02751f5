"""How far one measurement speaks for the surface: the contact of its windows, and their scatter."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import Any, TypeVar

import numpy as np
import scipy.fft
from scipy import stats

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.half_space.grid import DEFAULT_STEPS, Array, joined, periodic_heights
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile, SineStack
from gripscale.surface.profile import FEWEST_POINTS
from gripscale.surface.resampling import filled

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
            f"length must be one of a profile, one or two of a map; got {checks.short_repr(length)}"
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


# Surfaces to compare with: one period of a line, superposed sines, and random phases.

Surface = TypeVar("Surface", Profile, HeightMap)

POINTS_IN_WAVE = 8
MOST_POINTS = 10_000_000


def one_period(line: Profile, smallest_wavelength: float | None = None) -> Profile:
    """Return a line as `solve_rough_contact` sees it, for any model to take with `periodic=True`.

    Missing heights are filled, ends joined, and waves left out that are shorter than
    `smallest_wavelength` [m], by default four steps. The points are the fewest that carry the
    waves that are left, four in the smallest.

    Raises
    ------
    InputError
        As `solve_rough_contact` does for its surface.
    """
    checks.instance("line", line, Profile)
    heights = periodic_heights(line, smallest_wavelength=smallest_wavelength, periodic=False)
    period = heights.grid.lengths[0]
    waves = int(period / heights.smallest_wavelength * (1.0 + 1e-9))
    points = max(FEWEST_POINTS, DEFAULT_STEPS * waves)
    x = heights.origin[0] + np.linspace(0.0, period, points, endpoint=False)
    return Profile(x, heights.on((points,)), line.name, source=line.source)


def surface_of_sines(stack: SineStack, length: float, seed: int) -> Profile:
    """Return a periodic line of superposed sine waves, each with a random phase.

    Parameters
    ----------
    stack : SineStack
        The waves; each wavelength is changed to the nearest that fits `length` a whole number of
        times, its amplitude with it, so that slopes stay.
    length : float
        Period [m], at least the largest wavelength.
    seed : int
        Seed of the random phases.

    Raises
    ------
    InputError
        If an argument is out of its range, or there would be more than ten million points.
    """
    checks.instance("stack", stack, SineStack)
    period = checks.positive("length", length, unit="m")
    if period < stack.wavelength.max():
        raise InputError(
            f"length must be at least the largest wavelength, {stack.wavelength.max():g} m; "
            f"got {period:g} m"
        )
    counts = np.rint(period / stack.wavelength)
    points = max(64, POINTS_IN_WAVE * int(counts.max()))
    if points > MOST_POINTS:
        raise InputError(
            f"length over the smallest wavelength must be at most {MOST_POINTS // POINTS_IN_WAVE}; "
            f"got {int(counts.max())}"
        )
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    place = np.arange(points) / points
    amplitudes = stack.amplitude * (period / counts) / stack.wavelength
    z = np.zeros(points)
    for count, amplitude in zip(counts, amplitudes, strict=True):
        z += amplitude * np.cos(2.0 * np.pi * (count * place + random.random()))
    return Profile(place * period, z, name=f"{len(stack)} sine waves", source=f"seed {seed}")


def random_phases(surface: Surface, seed: int) -> Surface:
    """Return a periodic surface with the spectrum of `surface` and random phases.

    Missing heights are filled and ends joined as `solve_rough_contact` does. The height difference
    correlation of that filled surface stays; where the roughness sits, and the distribution of
    heights, do not. Steep lines that bridge gaps are in the spectrum of the filled surface: where
    steep flanks are missing it is rougher than the pairs of measured heights say.

    Raises
    ------
    InputError
        If `seed` is not a whole number that is not negative.
    """
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    if not isinstance(surface, Profile | HeightMap):
        raise InputError(f"surface must be a Profile or a HeightMap; got {type(surface).__name__}")
    steps = surface.step if isinstance(surface, HeightMap) else ()
    z = joined(filled(surface.z, steps))
    spectrum = scipy.fft.rfftn(random.standard_normal(z.shape))  # phases of a real surface
    size = np.abs(spectrum)
    spectrum *= np.abs(scipy.fft.rfftn(z)) / np.where(size > 0.0, size, 1.0)
    drawn = scipy.fft.irfftn(spectrum, s=z.shape)
    name, source = f"{surface.name}, random phases".lstrip(", "), f"seed {seed}"
    if isinstance(surface, Profile):
        return Profile(surface.x, drawn, name, source)
    return HeightMap(surface.x, surface.y, drawn, name, source)
