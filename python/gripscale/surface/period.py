"""One period of a measured line: gaps filled, ends joined, flanks no steeper than rubber follows.

The profile of a contact is the smallest one above the heights z without slopes above s (E. J.
McShane, Bull. Amer. Math. Soc. 40 (1934) 837, doi:10.1090/S0002-9904-1934-05978-0),

    e(x) = max_y (z(y) - s |x - y|),

the upper envelope of cones on all points. A surface of rubber that follows a flank of slope s is
stretched by up to sqrt(1 + s^2). The envelope keeps every summit, and every face below that slope;
waves that are then cut off do not ring beside a step, by 9 % of its height (J. W. Gibbs, Nature 59
(1899) 606).
"""

from __future__ import annotations

import math

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.surface.profile import FEWEST_POINTS, RESOLVED_STEPS, Profile
from gripscale.surface.resampling import filled

STEEPEST = 4.0
"""Slope that rubber is taken to follow: stretched to 4.1, near the elongation at break of tread."""


def one_period(
    line: Profile, smallest_wavelength: float | None = None, *, steepest: float = STEEPEST
) -> Profile:
    """Return a periodic line, for any model with `periodic=True`.

    Missing heights are filled, the line through the end points subtracted, and flanks above a slope
    of `steepest` [-] replaced by the smallest heights above the line without them; infinity keeps
    all. Then waves shorter than `smallest_wavelength` [m], by default four steps, are left out.
    The smallest wave has four points.

    Raises `InputError` if `steepest` is not above zero, or `smallest_wavelength` is not from two
    steps of the line to its length.
    """
    checks.instance("line", line, Profile)
    slope = checks.positive("steepest", steepest, infinite=True)
    step, period = line.step, len(line) * line.step
    z = filled(line.z)
    z = z - np.linspace(0.0, z[-1] - z[0], z.size, endpoint=False)
    z -= z.mean()
    if smallest_wavelength is None:
        smallest = min(RESOLVED_STEPS * step, period)
    else:
        smallest = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    if smallest < 2.0 * step * (1.0 - 1e-9):
        raise InputError(
            f"smallest_wavelength must be at least two steps of the line, {2.0 * step:.4g} m; "
            f"got {smallest:.4g} m"
        )
    envelope = z if math.isinf(slope) else _envelope(z, slope * step)
    whole = Profile(line.x, envelope, line.name, line.source)
    return without_short_waves(whole, smallest)


def _envelope(z: Array, rise: float) -> Array:
    """Return the least heights above a period of `z` that change by `rise` a step at most."""
    periods = np.tile(z, 3)
    ramp = rise * np.arange(periods.size)
    behind = np.maximum.accumulate(periods + ramp) - ramp
    before = (np.maximum.accumulate(periods[::-1] + ramp) - ramp)[::-1]
    return np.asarray(np.maximum(behind, before)[z.size : 2 * z.size])


def without_short_waves(line: Profile, smallest_wavelength: float) -> Profile:
    """Return a periodic line without shorter waves [m], with four points in the smallest left.

    Raises `InputError` if that is longer than the period.
    """
    cut = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    period = len(line) * line.step
    # round-off must not drop a wave that is exactly the smallest
    waves = math.floor(min(period / cut * (1.0 + 1e-9), len(line)))
    if waves < 1:
        raise InputError(
            f"smallest_wavelength must be at most the period {period:g} m; got {cut:g} m"
        )
    spectrum = np.fft.rfft(line.z)[: waves + 1]
    points = max(FEWEST_POINTS, 4 * (spectrum.size - 1))
    z = np.fft.irfft(spectrum, points) * (points / len(line))
    x = line.x[0] + np.linspace(0.0, period, points, endpoint=False)
    return Profile(x, z, line.name, source=line.source)
