"""A surface as superposed sine waves, largest first.

Wave i is A_i cos(2 pi x / lambda_i), A_i being half its height from valley to peak. Waves of
unrelated phase add in the height difference correlation:

    C_z(l) = sum_i A_i^2 (1 - cos(2 pi l / lambda_i))

since < (cos(k(x+l)) - cos(kx))^2 > = 1 - cos(kl) over x. Usually both lengths shrink by constant
magnification factors, lambda_{i+1} = lambda_i / s_lambda and A_{i+1} = A_i / s_A.
Lind & Wangenheim, ASME IMECE2014-37998.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import InputError

GEOMETRIC_TOLERANCE = 0.01
"""Largest departure of a ratio from the mean ratio for waves to count as geometric."""


class SineStack(Checked, eq=False):
    """Superposed sine waves, largest first.

    Raises `InputError` if lengths differ, an entry is not above zero, wavelengths do not decrease,
    a factor contradicts the waves, or `cut_off` is above the last wave.

    Parameters
    ----------
    wavelength : array_like, shape (waves,)
        Wavelengths [m], positive, strictly decreasing.
    amplitude : array_like, shape (waves,)
        Amplitudes [m], positive: half the height from valley to peak.
    s_wavelength, s_amplitude : float, optional
        Magnification factors between neighbouring waves. If not given they are the geometric mean
        of the ratios, or None where the ratios differ by more than 1 % or there is one wave.
    residual : float, optional
        Rms difference from the curve the waves were fitted to, in decades of C_z.
    lag_range : (float, float), optional
        Smallest and largest lag the waves were fitted to [m].
    cut_off : float, optional
        Shortest wavelength of the roughness the waves represent [m], if it is not the last wave.
    """

    wavelength: Array = checked(checks.positive_vector, unit="m")
    amplitude: Array = checked(checks.positive_vector, unit="m")
    s_wavelength: float | None = checked(checks.positive, default=None)
    s_amplitude: float | None = checked(checks.positive, default=None)
    residual: float | None = checked(checks.not_negative, default=None)
    lag_range: tuple[float, float] | None = None
    cut_off: float | None = checked(checks.positive, unit="m", default=None)

    def __post_init__(self) -> None:
        super().__post_init__()
        wavelength, amplitude = self.wavelength, self.amplitude
        checks.same_length(1, wavelength=wavelength, amplitude=amplitude)
        rises = np.diff(wavelength) >= 0.0
        if rises.any():
            at = int(np.argmax(rises)) + 1
            raise InputError(
                f"wavelength must decrease from wave to wave; got {wavelength[at]:g} m at index "
                f"{at} after {wavelength[at - 1]:g} m"
            )
        if self.cut_off is not None and self.cut_off > wavelength[-1]:
            raise InputError(
                f"cut_off must not exceed the last wave, {wavelength[-1]:g} m; "
                f"got {self.cut_off:g} m"
            )
        self._set(
            s_wavelength=_factor("s_wavelength", wavelength, self.s_wavelength),
            s_amplitude=_factor("s_amplitude", amplitude, self.s_amplitude),
        )

    def __len__(self) -> int:
        return int(self.wavelength.size)

    @property
    def slope(self) -> Array:
        """Largest slope of each wave, 2 pi A / lambda."""
        return np.asarray(2.0 * np.pi * self.amplitude / self.wavelength)

    @property
    def cutoff_wavelength(self) -> float:
        """Shortest wavelength of the roughness the waves represent [m]."""
        return float(self.wavelength[-1]) if self.cut_off is None else self.cut_off

    @property
    def rms_slope(self) -> float:
        """Root mean square slope of all waves together, sqrt(sum (2 pi A / lambda)^2 / 2)."""
        return float(np.sqrt(0.5 * np.sum(self.slope**2)))

    def height_difference(self, lag: ArrayLike) -> Array:
        """Return C_z [m^2] of the waves at lags [m]: sum A^2 (1 - cos(2 pi l / lambda))."""
        lags = checks.vector("lag", lag, unit="m")
        # 1 - cos(2a) = 2 sin(a)^2, which keeps its digits at small lags.
        half_phase = np.pi * lags[:, None] / self.wavelength
        return np.asarray(2.0 * np.sin(half_phase) ** 2 @ self.amplitude**2)


def _factor(name: str, lengths: Array, argument: float | None) -> float | None:
    """Return the common ratio of neighbours, checked against a stated one; None if it varies."""
    if lengths.size == 1:
        return argument
    ratios = lengths[:-1] / lengths[1:]
    mean = float(np.exp(np.log(ratios).mean()))
    factor = argument or mean
    if float(np.abs(ratios / factor - 1.0).max()) <= GEOMETRIC_TOLERANCE:
        return factor
    if argument is None:
        return None
    raise InputError(
        f"{name} must be the ratio of neighbouring waves within {GEOMETRIC_TOLERANCE:g}; "
        f"got {argument:g} for a mean ratio of {mean:g}"
    )
