"""What is drawn of the inputs of a case, on paper and on the page, by the fits themselves."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.rubber import MasterCurve, Rubber
from gripscale.surface import Profile, SineStack
from gripscale.surface.sine_fit import as_fitted

Array = NDArray[np.float64]
BINS = 1200
"""Pieces a profile is cut into; each keeps its lowest and its highest height."""
CLOSE_UP = 30e-3
"""Length of the piece of a profile that is shown point by point [m]."""


def envelope(x: ArrayLike, z: ArrayLike, bins: int = BINS) -> Array:
    """Return middle, lowest and highest height of each piece of a profile, shape (3, bins).

    A piece without heights has NaN; of fewer points than `bins`, the rest is NaN.
    """
    abscissa, height = np.asarray(x, dtype=float), np.asarray(z, dtype=float)
    count = min(bins, abscissa.size)
    first = np.linspace(0, abscissa.size, count, endpoint=False).astype(int)
    out = np.full((3, bins), math.nan)
    sizes = np.diff(np.append(first, abscissa.size))
    out[0, :count] = np.add.reduceat(abscissa, first) / sizes
    out[1, :count] = np.fmin.reduceat(height, first)
    out[2, :count] = np.fmax.reduceat(height, first)
    return out


def trace(x: ArrayLike, lowest: ArrayLike, highest: ArrayLike) -> tuple[Array, Array]:
    """Return an envelope as one line that runs from lowest to highest in each piece."""
    return np.repeat(np.asarray(x), 2), np.column_stack([lowest, highest]).ravel()


def close_up(profile: Profile) -> Array:
    """Return abscissa and height [m] of a piece from the middle of a profile, shape (2, points)."""
    start = 0.5 * (profile.x[0] + profile.x[-1])
    inside = (profile.x >= start) & (profile.x <= start + CLOSE_UP)
    return np.array([profile.x[inside], profile.z[inside]])


def sine_curves(sines: SineStack, lag: ArrayLike) -> tuple[Array, Array]:
    """Return C_z [m^2] of the waves as `fit_sines` uses it and of the pure sines.

    As fitted, the first wave counts by its mean over phases beyond a quarter of its length, and
    shorter waves than those of the stack count where it has a cut-off. Beyond the whole length of
    the first wave both are NaN.
    """
    lags, longest = np.asarray(lag, dtype=float), float(sines.wavelength[0])
    shown = np.where(lags <= longest, lags, math.nan)
    pure = np.where(lags <= longest, sines.height_difference(np.minimum(lags, longest)), math.nan)
    first = SineStack(sines.wavelength[:1], sines.amplitude[:1])
    held = first.height_difference(np.minimum(lags, 0.25 * longest))
    counted = as_fitted(sines).height_difference(np.minimum(lags, longest))
    rest = counted - first.height_difference(np.minimum(lags, longest))
    return np.where(np.isnan(shown), math.nan, rest + held), pure


def excited(speed: float, sines: SineStack) -> Array:
    """Return the angular frequencies the waves excite at `speed` [rad/s]; none at rest."""
    omega = 2.0 * math.pi * speed / np.asarray(sines.wavelength)
    return np.asarray(omega if speed > 0.0 else omega[:0])


def band(rubber: Rubber, master: MasterCurve | None, excitation: ArrayLike, points: int) -> Array:
    """Return angular frequencies [rad/s] over everything measured and excited, or all terms.

    A decade more on both sides where the uncertainty beyond the data is known, else half of one.
    """
    ends = [*np.asarray(excitation, dtype=float), *(rubber.valid_band or ())]
    if master is not None:
        ends += [*master.angular_frequency[[0, -1]]]
    ends = ends or [*(1.0 / rubber.relaxation_times)] or [1.0]
    margin = 3.0 if rubber.admissible is None else 10.0
    return np.geomspace(min(ends) / margin, max(ends) * margin, points)
