"""Measuring power spectra: windows of a line, rings of a map.

    C_1(q) = 2 / (2 pi)   |F{w z}|^2 step / sum(w^2)             for q > 0
    C(q)   = 1 / (2 pi)^2 < |F{w z}|^2 > step_x step_y / sum(w^2)

with windows w and the discrete Fourier transform F; < > is the mean over the plane waves of a ring.
P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70, doi:10.1109/TAU.1967.1161901.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.gaps import filled
from gripscale.surface.profile import FEWEST_POINTS, FloatArray, Profile
from gripscale.surface.several import of_one_step
from gripscale.surface.spectrum import PER_DECADE, ArealSpectrum, ProfileSpectrum, first_of_bins

TAPERS: dict[str, tuple[str, Literal["linear", "constant"]]] = {
    "hann": ("hann", "linear"),
    "none": ("boxcar", "constant"),
}
"""What is done to each window: its weights, and the trend taken out of it before."""

WINDOWS = 4
"""Windows a tapered line is cut into by default; as many fit again between them."""


def profile_spectrum(
    profile: Profile | Sequence[Profile], *, window: float | None = None, taper: str = "hann"
) -> ProfileSpectrum:
    """Return the one-sided power spectrum of one profile, or the mean over several.

    Windows overlap by a half; each is freed of its trend and weighted. The sum over the wavenumbers
    is mean(w^2 z^2)/mean(w^2): with taper "none" and one window the variance of the heights
    exactly, with "hann" their variance about the trends, as the windows weigh it.

    Parameters
    ----------
    profile : Profile or sequence of Profile
        Cleaned profiles; several must have the same step (within 0.1 %). Missing heights are
        interpolated linearly, and their share is reported.
    window : float, optional
        Length of the windows and so of the longest wave [m]; by default a quarter of the shortest
        profile, or all of it without a taper.
    taper : str
        "hann" for a measured line, whose ends do not meet: without it their jump would be spread
        over all small waves; a straight line is taken out of each window. "none" for a line that is
        a whole number of periods: only the mean is taken out.

    Raises
    ------
    InputError
        If the steps differ, the window does not fit or a word is unknown.
    """
    from scipy import signal

    profiles = of_one_step(profile, "averaged")
    step = profiles[0].step
    weights, trend = TAPERS[checks.one_of("taper", taper, TAPERS)]
    shortest = min(len(one) for one in profiles)
    parts = WINDOWS if taper == "hann" else 1
    points = max(shortest // parts, FEWEST_POINTS)
    if window is not None:
        points = _points(shortest, step, window)
    detrend = partial(signal.detrend, type=trend)
    heights = [filled(one.z, periodic=taper == "none") for one in profiles]
    powers = [signal.welch(z, 1.0 / step, weights, points, detrend=detrend)[1] for z in heights]
    density = np.average(powers, axis=0, weights=[len(one) for one in profiles])
    q = 2.0 * np.pi / (points * step) * np.arange(1.0, points // 2 + 1)
    missing = sum(one.missing for one in profiles) / sum(len(one) for one in profiles)
    return ProfileSpectrum(q, density[1:] / (2.0 * np.pi), np.full(q.size, q[0]), missing)


def map_spectrum(
    z: ArrayLike,
    *,
    x_step: float,
    y_step: float,
    taper: str = "hann",
    per_decade: int = PER_DECADE,
) -> ArealSpectrum:
    """Return the power spectrum of a height map, mean over directions.

    The mean of all plane waves within rings of absolute wavenumber, up to the ring that still fits
    into the sampled wavenumbers; the corners beyond are left out.

    Parameters
    ----------
    z : array_like, shape (nx, ny)
        Heights [m]; missing ones are NaN and filled as those of a membrane over the gap.
    x_step, y_step : float
        Steps of the map [m].
    taper : str
        "hann" for a measured map: a plane is taken out and the edges are weighted down. "none" for
        a map that is one period of its surface: only the mean is taken out.
    per_decade : int
        Points a decade of wavenumber, where there are enough rings.

    Raises
    ------
    InputError
        If a value is out of range or no height is there.
    """
    steps = (
        checks.positive("x_step", x_step, unit="m"),
        checks.positive("y_step", y_step, unit="m"),
    )
    heights = _heights(z)
    each = checks.whole("per_decade", per_decade, least=1, most=1000)
    checks.one_of("taper", taper, TAPERS)
    whole = filled(heights, steps, periodic=taper == "none")
    power, q = _plane_waves(whole, steps, tapered=taper == "hann")
    ring = max(2.0 * np.pi / (n * step) for n, step in zip(heights.shape, steps, strict=True))
    number = np.rint(q / ring).astype(int)
    rings = int(np.pi / max(steps) / ring)
    if rings < 1:
        raise InputError(
            "x_step and y_step must leave the map longer each way than twice the larger of them "
            f"[m]; got {steps[0]:g} and {steps[1]:g}, of shape {heights.shape}"
        )
    start = first_of_bins(np.arange(1, rings + 1), each) + 1
    inside = (number >= 1) & (number <= rings)
    which = np.searchsorted(start, number[inside], side="right") - 1
    count = np.bincount(which)
    return ArealSpectrum(
        np.exp(np.bincount(which, np.log(q[inside])) / count),
        np.bincount(which, power[inside]) / count,
        float(np.isnan(heights).mean()),
    )


def _plane_waves(
    z: FloatArray, steps: tuple[float, float], *, tapered: bool
) -> tuple[FloatArray, FloatArray]:
    """Return the density [m^4] of every plane wave, and its absolute wavenumber [rad/m]."""
    z = z - z.mean()
    windows = [np.ones(n) for n in z.shape]
    if tapered:
        x, y = np.meshgrid(*(np.arange(n) - 0.5 * (n - 1) for n in z.shape), indexing="ij")
        z = z - x * (z * x).sum() / (x * x).sum() - y * (z * y).sum() / (y * y).sum()
        windows = [np.hanning(n + 1)[:-1] for n in z.shape]
    window = windows[0][:, None] * windows[1]
    area = steps[0] * steps[1] / (4.0 * np.pi**2 * np.square(window).sum())
    power = np.asarray(area * np.abs(np.fft.fft2(window * z)) ** 2, dtype=np.float64)
    qx, qy = (2.0 * np.pi * np.fft.fftfreq(n, d) for n, d in zip(z.shape, steps, strict=True))
    return power, np.asarray(np.hypot(qx[:, None], qy), dtype=np.float64)


def _points(most: int, step: float, window: float) -> int:
    """Return how many heights a window holds, of `most`."""
    points = round(checks.positive("window", window, unit="m") / step)
    if not FEWEST_POINTS <= points <= most:
        raise InputError(
            f"window must be from {FEWEST_POINTS * step:g} m to {most * step:g} m long; "
            f"got {window:g}"
        )
    return points


def _heights(z: ArrayLike) -> FloatArray:
    expected = f"z must be heights of shape (nx, ny), at least {FEWEST_POINTS} each way [m]"
    heights = checks.array(z, expected)
    if heights.ndim != 2 or min(heights.shape) < FEWEST_POINTS:
        raise InputError(f"{expected}; got shape {heights.shape}")
    if (np.abs(heights) > checks.MOST).any():
        raise InputError(f"{expected}; got one beyond {checks.MOST:g}")
    if np.isnan(heights).all():
        raise InputError(f"z must have some heights; got {heights.size} points, all missing")
    return heights
