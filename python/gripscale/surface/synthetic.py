"""Synthetic profiles and surfaces with stated statistics, for tests and studies."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from gripscale.core import InputError, Quantity, checks
from gripscale.surface.height_difference import height_difference
from gripscale.surface.profile import FEWEST_POINTS, MOST_PROFILE_POINTS, Profile
from gripscale.surface.sine_fit import fit_sines
from gripscale.surface.surface import Measured, Surface


def self_affine_profile(
    hurst: float,
    xi_parallel: Quantity,
    xi_perpendicular: Quantity,
    length: Quantity,
    step: Quantity,
    seed: int,
) -> Profile:
    """Return a Gaussian random profile that is self-affine below a cut-off.

    Its height difference correlation is, in the mean over seeds,

        C_z(l) = xi_perp^2 (1 - exp(-(l / xi_par)^(2H))),

    with a smooth bend: a sharp one is no covariance of a line for H > 1/2. It is drawn exactly, by
    circulant embedding (C. R. Dietrich & G. N. Newsam, SIAM J. Sci. Comput. 18 (1997) 1088,
    doi:10.1137/S1064827592240555), with heights about zero, of the variance xi_perp^2/2 in the
    mean over seeds. Raises `InputError` if an argument is out of range.

    Parameters
    ----------
    hurst : float
        Hurst exponent, above 0 and up to 1.
    xi_parallel, xi_perpendicular : float
        Cut-off lag and root of the plateau [m].
    length, step : float
        Length and step of the profile [m].
    seed : int
        Seed of the random numbers.
    """
    exponent = 2.0 * checks.fraction("hurst", hurst)
    cut_off = checks.positive("xi_parallel", xi_parallel, unit="m")
    variance = 0.5 * checks.positive("xi_perpendicular", xi_perpendicular, unit="m") ** 2
    step = checks.positive("step", step, unit="m")
    points = round(checks.positive("length", length, unit="m") / step) + 1
    if not FEWEST_POINTS <= points <= MOST_PROFILE_POINTS:
        raise InputError(
            f"length / step must give {FEWEST_POINTS} to {MOST_PROFILE_POINTS} points; got {points}"
        )
    x = step * np.arange(points, dtype=np.float64)
    # A period twice as long as needed, and ten cut-offs more, keeps the spectrum positive.
    if x.size + 10.0 * cut_off / step > MOST_PROFILE_POINTS:
        raise InputError(
            f"length + 10 xi_parallel must be at most {MOST_PROFILE_POINTS} steps; got xi_parallel "
            f"{cut_off:g} m at steps of {x[1]:g} m"
        )
    half = 2 ** int(np.ceil(np.log2(x.size + 10.0 * cut_off / step)))
    lag = step * np.concatenate((np.arange(half + 1), np.arange(half - 1, 0, -1)))
    spectrum = np.fft.fft(variance * np.exp(-((lag / cut_off) ** exponent))).real
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    noise = random.standard_normal(lag.size) + 1j * random.standard_normal(lag.size)
    drawn = np.fft.fft(np.sqrt(np.maximum(spectrum, 0.0) / lag.size) * noise).real
    return Profile(x, drawn[: x.size], name=f"self-affine, H = {hurst:g}", source=f"seed {seed}")


# Arguments of `self_affine_profile` by the name of a surface, of the order of a dense asphalt; none
# was measured.
SYNTHETIC_SURFACES: dict[str, dict[str, Any]] = {
    "synthetic_dense_asphalt": {
        "hurst": 0.8,
        "xi_parallel": 2e-3,
        "xi_perpendicular": 0.6e-3,
        "length": 1.6,
        "step": 37.5e-6,
        "seed": 2014,
    }
}
_WAVES, _SMALLEST_WAVELENGTH = 7, 0.1e-3


def with_profile(name: str) -> Surface:
    """Return a synthetic surface as if its profile had been measured, with as many waves."""
    surface, profile = synthetic_surface(name), self_affine_profile(**SYNTHETIC_SURFACES[name])
    return replace(surface, fit={**surface.fit, "scales": _WAVES}, measured=Measured.of([profile]))


@lru_cache(maxsize=4)
def synthetic_surface(name: str) -> Surface:
    """Return a synthetic surface, with its statistics as its source."""
    s = SYNTHETIC_SURFACES[name]
    # the stated statistics are those of the profile with all its flanks
    correlation = height_difference(self_affine_profile(**s), steepest=math.inf)
    sines = fit_sines(correlation, scales=_WAVES, smallest_wavelength=_SMALLEST_WAVELENGTH)
    source = (
        f"{name}: synthetic, self-affine, H = {s['hurst']:g}, "
        f"xi_parallel = {s['xi_parallel'] * 1e3:g} mm, "
        f"xi_perpendicular = {s['xi_perpendicular'] * 1e3:g} mm, "
        f"{s['length']:g} m in steps of {s['step'] * 1e6:g} um, seed {s['seed']}"
    )
    fit = {"smallest_wavelength": float(sines.wavelength[-1])}
    return Surface(sines, source, correlation, fit)
