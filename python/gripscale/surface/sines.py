"""A surface as superposed sine waves, largest first.

Wave i is A_i cos(2 pi x / lambda_i), A_i being half its height from valley to peak. Waves of
unrelated phase add in the height difference correlation:

    C_z(l) = sum_i A_i^2 (1 - cos(2 pi l / lambda_i))

since < (cos(k(x+l)) - cos(kx))^2 > = 1 - cos(kl) over x. Usually both lengths shrink by constant
magnification factors, lambda_{i+1} = lambda_i / s_lambda and A_{i+1} = A_i / s_A.
Lind & Wangenheim, ASME IMECE2014-37998.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.surface.profile import FloatArray

GEOMETRIC_TOLERANCE = 0.01
"""Largest departure of a ratio from the mean ratio for waves to count as geometric."""


@dataclass(frozen=True, eq=False)
class SineStack:
    """Superposed sine waves, largest first.

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
        Shortest wavelength of the roughness the waves stand for [m], where it is not the last wave.

    Raises
    ------
    InputError
        If lengths differ, an entry is not above zero, wavelengths do not decrease, a factor
        contradicts the waves, or `cut_off` is above the last wave.
    """

    wavelength: FloatArray
    amplitude: FloatArray
    s_wavelength: float | None = None
    s_amplitude: float | None = None
    residual: float | None = None
    lag_range: tuple[float, float] | None = None
    cut_off: float | None = None

    def __post_init__(self) -> None:
        wavelength = checks.positive_vector("wavelength", self.wavelength, unit="m")
        amplitude = checks.positive_vector("amplitude", self.amplitude, unit="m")
        if wavelength.size == 0 or wavelength.size != amplitude.size:
            raise InputError(
                "wavelength and amplitude must have the same length, at least 1; "
                f"got {wavelength.size} and {amplitude.size}"
            )
        if (np.diff(wavelength) >= 0.0).any():
            at = int(np.argmax(np.diff(wavelength) >= 0.0)) + 1
            raise InputError(
                f"wavelength must decrease from wave to wave; got {wavelength[at]:g} m at index "
                f"{at} after {wavelength[at - 1]:g} m"
            )
        if self.residual is not None:
            checks.not_negative("residual", self.residual)
        if self.cut_off is not None:
            end = checks.positive("cut_off", self.cut_off, unit="m")
            if end > wavelength[-1]:
                raise InputError(
                    f"cut_off must not exceed the last wave, {wavelength[-1]:g} m; got {end:g} m"
                )
        factors = {
            "s_wavelength": _factor("s_wavelength", wavelength, self.s_wavelength),
            "s_amplitude": _factor("s_amplitude", amplitude, self.s_amplitude),
        }
        for array in (wavelength, amplitude):
            array.flags.writeable = False
        for field, value in (factors | {"wavelength": wavelength, "amplitude": amplitude}).items():
            object.__setattr__(self, field, value)

    def __len__(self) -> int:
        return int(self.wavelength.size)

    @property
    def slope(self) -> FloatArray:
        """Largest slope of each wave, 2 pi A / lambda."""
        return np.asarray(2.0 * np.pi * self.amplitude / self.wavelength)

    @property
    def roughness_end(self) -> float:
        """Shortest wavelength of the roughness the waves stand for [m]."""
        return float(self.wavelength[-1]) if self.cut_off is None else self.cut_off

    @property
    def rms_slope(self) -> float:
        """Root mean square slope of all waves together, sqrt(sum (2 pi A / lambda)^2 / 2)."""
        return float(np.sqrt(0.5 * np.sum(self.slope**2)))

    def height_difference(self, lag: ArrayLike) -> FloatArray:
        """Return C_z [m^2] of the waves at lags [m]: sum A^2 (1 - cos(2 pi l / lambda))."""
        lags = checks.vector("lag", lag, unit="m")
        # 1 - cos(2a) = 2 sin(a)^2, which keeps its digits at small lags.
        half_phase = np.pi * lags[:, None] / self.wavelength
        return np.asarray(2.0 * np.sin(half_phase) ** 2 @ self.amplitude**2)


def _factor(name: str, lengths: FloatArray, given: float | None) -> float | None:
    """Return the common ratio of neighbours, checked against the one given."""
    if given is not None:
        given = checks.positive(name, given)
    if lengths.size == 1:
        return given
    ratios = lengths[:-1] / lengths[1:]
    mean = float(np.exp(np.log(ratios).mean()))
    departure = float(np.abs(ratios / (given or mean) - 1.0).max())
    if departure <= GEOMETRIC_TOLERANCE:
        return given or mean
    if given is None:
        return None
    raise InputError(
        f"{name} must be the ratio of neighbouring waves within {GEOMETRIC_TOLERANCE:g}; "
        f"got {given:g} for a mean ratio of {mean:g}"
    )
