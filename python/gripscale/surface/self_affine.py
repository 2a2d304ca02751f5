"""Describe a height difference correlation as self-affine up to a cut-off.

    C_z(l) = xi_perp^2 (l / xi_par)^(6 - 2 D)   below the cut-off xi_par,
    C_z(l) = xi_perp^2                          above it,               [LW eq. 6]

with the fractal dimension D of the surface and the Hurst exponent H = 3 - D, so that 6 - 2D = 2H.
[LW] Lind & Wangenheim, ASME IMECE2014-37998, after Klueppel & Heinrich,
Rubber Chem. Technol. 73 (2000) 578.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import InputError
from gripscale.surface.height_difference import (
    HeightDifference,
    find_plateau,
    log_weights,
    require_positive,
)

FEWEST_LAGS = 4
"""Lags a power law must cover."""


class SelfAffineFit(Checked):
    """A power law up to a cut-off, and the plateau above it.

    Raises `InputError` if a value is not a number above zero; the residual may be zero.
    """

    hurst: float = checked(checks.positive)
    """Hurst exponent H [-]: half the slope of log C_z over log lag."""
    xi_parallel: float = checked(checks.positive, unit="m")
    """Cut-off lag [m], where the power law meets the plateau."""
    xi_perpendicular: float = checked(checks.positive, unit="m")
    """Root of the plateau [m]: the root mean square height times the root of 2."""
    lag_min: float = checked(checks.positive, unit="m")
    """Smallest lag over which C_z was found to be a power law [m]."""
    lag_max: float = checked(checks.positive, unit="m")
    """Largest lag over which it was [m]."""
    residual: float = checked(checks.not_negative)
    """Root mean square departure from the power law over that range, in decades of C_z."""

    @property
    def fractal_dimension(self) -> float:
        """Fractal dimension of the surface, D = 3 - H [-]."""
        return 3.0 - self.hurst

    def evaluate(self, lag: ArrayLike) -> Array:
        """Return C_z [m^2] at lags [m], same shape, by [LW eq. 6].

        Raises `InputError` unless the lags are above zero.
        """
        lags = checks.positive_vector("lag", lag, unit="m")
        below = np.minimum(lags / self.xi_parallel, 1.0)
        return np.asarray(self.xi_perpendicular**2 * below ** (2.0 * self.hurst))


def fit_self_affine(
    hdc: HeightDifference, *, tolerance: float = 0.02, shortest_range: float = 0.5
) -> SelfAffineFit:
    """Find the power law and the plateau of a height difference correlation.

    The range of the power law is the widest range of lags below the plateau over which a straight
    line in log C_z departs by no more than `tolerance` rms. If none is as wide as `shortest_range`,
    the straightest range of that width is taken, and `residual` exceeds `tolerance`: the surface is
    then not self-affine.

    Raises `InputError` if C_z vanishes somewhere, does not reach a plateau or does not rise before
    it.

    Parameters
    ----------
    hdc : HeightDifference
        The measured curve; it must reach its plateau.
    tolerance : float, optional
        Largest rms departure from the power law, in decades of C_z.
    shortest_range : float, optional
        Narrowest range accepted, in decades of lag.
    """
    checks.instance("hdc", hdc, HeightDifference)
    checks.positive("tolerance", tolerance)
    checks.positive("shortest_range", shortest_range)
    require_positive(hdc)
    plateau = find_plateau(hdc)
    if plateau is None:
        raise InputError(
            "the height difference correlation must reach a plateau over a factor of two in lag; "
            f"it still rises at {hdc.lag[-1]:.4g} m, so use a longer profile or a larger max_lag"
        )
    rising = hdc.lag < plateau.lag * (1.0 + 1e-9)
    lag, value = hdc.lag[rising], hdc.value[rising]
    ranges = [
        (i, j)
        for i in range(lag.size)
        for j in range(i + FEWEST_LAGS, lag.size + 1)
        if np.log10(lag[j - 1] / lag[i]) >= shortest_range
    ]
    if not ranges:
        raise InputError(
            f"the height difference correlation must have {FEWEST_LAGS} lags over "
            f"{shortest_range:g} decades below its plateau; "
            f"got {lag.size} lags up to {lag[-1]:.4g} m"
        )
    residuals = [_line(lag[i:j], value[i:j])[2] for i, j in ranges]
    straight = [r for r, residual in zip(ranges, residuals, strict=True) if residual <= tolerance]
    first, last = (
        max(straight, key=lambda r: float(np.log10(lag[r[1] - 1] / lag[r[0]])))
        if straight
        else ranges[int(np.argmin(residuals))]
    )
    slope, at_one_metre, residual = _line(hdc.lag[first:last], hdc.value[first:last])
    if slope <= 0.0:
        raise InputError(
            "the height difference correlation must rise before its plateau; "
            f"got a slope of {slope:.3g}"
        )
    # The power law meets the plateau where at_one_metre + slope log10(l) = log10(level).
    cut_off = 10.0 ** ((np.log10(plateau.level) - at_one_metre) / slope)
    return SelfAffineFit(
        hurst=0.5 * slope,
        xi_parallel=float(cut_off),
        xi_perpendicular=float(np.sqrt(plateau.level)),
        lag_min=float(hdc.lag[first]),
        lag_max=float(hdc.lag[last - 1]),
        residual=residual,
    )


def _line(lag: Array, value: Array) -> tuple[float, float, float]:
    """Return slope, log10 value at 1 m and rms departure of a line in log-log, decades alike."""
    x, y, weight = np.log10(lag), np.log10(value), log_weights(lag)
    weight = weight / weight.sum()
    dx, dy = x - weight @ x, y - weight @ y
    slope = float((weight * dx) @ dy / ((weight * dx) @ dx))
    residual = float(np.sqrt(weight @ np.square(dy - slope * dx)))
    return slope, float(weight @ y - slope * (weight @ x)), residual
