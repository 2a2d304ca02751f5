"""Power spectra of lines and surfaces: how much of the height variance each wavenumber carries.

    <z^2> = int_0^inf C_1(q) dq                       line, one-sided, C_1 [m^3]
    <z^2> = 2 pi int_0^inf q C(q) dq                  surface, mean over directions, C [m^4]
    <|grad z|^2> = 2 pi int_0^inf q^3 C(q) dq

The conventions are those of B. N. J. Persson et al., J. Phys.: Condens. Matter 17 (2005) R1,
doi:10.1088/0953-8984/17/1/R01. The mean square gradient of an isotropic surface is twice the mean
square slope of its lines: every number here says which of the two it is. Spectra are measured in
`gripscale.surface.periodogram`; `gripscale.surface.isotropy` leads from lines to surfaces.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.profile import FloatArray

PER_DECADE = 10
"""Wavenumbers a decade where a spectrum is averaged."""

_ABSCISSAE, _WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True, eq=False)
class ProfileSpectrum:
    """One-sided power spectrum of a line.

    Parameters
    ----------
    wavenumber : array_like, shape (points,)
        2 pi over the wavelength [rad/m], above zero, increasing.
    density : array_like, shape (points,)
        C_1 [m^3], not negative: the mean over the wavenumbers each point stands for.
    width : array_like, shape (points,), optional
        How many wavenumbers each point stands for [rad/m]; up to half way (in the logarithm) to its
        neighbours by default, and to the first and last point.
    interpolated : float
        Share of the heights that were missing and interpolated [-].

    Raises
    ------
    InputError
        If lengths differ or a value is out of range.
    """

    wavenumber: FloatArray
    density: FloatArray
    width: FloatArray = field(default_factory=lambda: np.zeros(0))
    interpolated: float = 0.0

    def __post_init__(self) -> None:
        _keep(self, "m^3")
        q = self.wavenumber
        width = checks.vector("width", self.width, unit="rad/m")
        if width.size == 0:
            width = np.diff(np.concatenate((q[:1], np.sqrt(q[1:] * q[:-1]), q[-1:])))
        if width.size != q.size or (width <= 0.0).any():
            raise InputError(
                f"width must have {q.size} entries above zero; got {checks.shown(width)}"
            )
        object.__setattr__(self, "width", width)

    @property
    def rms_height(self) -> float:
        """Root mean square height [m]."""
        return float(np.sqrt(self.density @ self.width))

    def rms_slope(self, smallest_wavelength: float | None = None) -> float:
        """Return the root mean square slope of the line [-], of the waves down to a length [m].

        Points whose wavenumber lies beyond it do not count.
        """
        last = last_wavenumber(self.wavenumber, smallest_wavelength)
        counted = np.where(self.wavenumber <= last, self.wavenumber**2 * self.width, 0.0)
        return float(np.sqrt(self.density @ counted))

    def averaged(self, per_decade: int = PER_DECADE) -> ProfileSpectrum:
        """Return the spectrum at fewer points, evenly spaced in log q where there are enough.

        The variance stays exactly what it is.
        """
        each = checks.whole("per_decade", per_decade, least=1, most=1000)
        start = first_of_bins(self.wavenumber, each)
        width = np.add.reduceat(self.width, start)
        middle = np.add.reduceat(np.log(self.wavenumber) * self.width, start) / width
        power = np.add.reduceat(self.density * self.width, start)
        return ProfileSpectrum(np.exp(middle), power / width, width, self.interpolated)


@dataclass(frozen=True, eq=False)
class ArealSpectrum:
    """Power spectrum of a surface, mean over directions.

    Between its points q^3 C(q) is linear in log q; outside them there are no waves.

    Parameters
    ----------
    wavenumber : array_like, shape (points,)
        Absolute wavenumber 2 pi/wavelength [rad/m], above zero, increasing, at least two.
    density : array_like, shape (points,)
        C [m^4], not negative.
    interpolated : float
        Share of the heights that were missing and interpolated [-].

    Raises
    ------
    InputError
        If lengths differ or a value is out of range.
    """

    wavenumber: FloatArray
    density: FloatArray
    interpolated: float = 0.0

    def __post_init__(self) -> None:
        _keep(self, "m^4")

    def at(self, wavenumber: ArrayLike) -> FloatArray:
        """Return C [m^4] at absolute wavenumbers [rad/m], same shape."""
        q, points = np.asarray(wavenumber, dtype=float), self.wavenumber
        weighted = points**3 * self.density
        between = np.interp(np.log(q), np.log(points), weighted, left=0.0, right=0.0)
        return np.asarray(between / q**3)

    @property
    def rms_height(self) -> float:
        """Root mean square height [m]."""
        return float(np.sqrt(self._moment(0, None)))

    def rms_gradient(self, smallest_wavelength: float | None = None) -> float:
        """Return the root mean square of the gradient's length [-], of the waves down to a length.

        That is sqrt(2) times the `profile_rms_slope` of the same waves.
        """
        return float(np.sqrt(self._moment(2, smallest_wavelength)))

    def profile_rms_slope(self, smallest_wavelength: float | None = None) -> float:
        """Return the root mean square slope [-] of lines through the waves down to a length [m]."""
        return self.rms_gradient(smallest_wavelength) / float(np.sqrt(2.0))

    def _moment(self, power: int, smallest_wavelength: float | None) -> float:
        """Return 2 pi int q^(power + 1) C dq, by Gauss points in log q between the points."""
        last = last_wavenumber(self.wavenumber, smallest_wavelength)
        nodes = np.log(np.append(self.wavenumber[self.wavenumber < last], last))
        half = 0.5 * np.diff(nodes)[:, None]
        q = np.exp(nodes[:-1, None] + half * (1.0 + _ABSCISSAE))
        return float(2.0 * np.pi * np.sum(half * _WEIGHTS * q ** (power + 2) * self.at(q)))


def last_wavenumber(q: FloatArray, smallest_wavelength: float | None) -> float:
    """Return 2 pi over the smallest wavelength, by default the last of `q` [rad/m].

    Raises `InputError` if it is not among the wavelengths of `q`.
    """
    if smallest_wavelength is None:
        return float(q[-1])
    length = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    least, most = 2.0 * np.pi / q[-1], 2.0 * np.pi / q[0]
    if not least * (1.0 - 1e-9) <= length < most:
        raise InputError(
            f"smallest_wavelength must be among those of the spectrum, {least:.4g} to "
            f"{most:.4g} m; got {length:.4g}"
        )
    return min(float(2.0 * np.pi / length), float(q[-1]))


def first_of_bins(values: NDArray[Any], per_decade: int) -> NDArray[np.intp]:
    """Return the index of the first of the values in each bin of log value that has any."""
    bins = np.floor(per_decade * np.log10(values / values[0]) + 1e-9)
    return np.flatnonzero(np.diff(bins, prepend=-1.0))


def _keep(spectrum: ProfileSpectrum | ArealSpectrum, unit: str) -> None:
    """Check wavenumbers and densities, and store them read-only."""
    q = checks.positive_vector("wavenumber", spectrum.wavenumber, unit="rad/m")
    density = checks.vector("density", spectrum.density, unit=unit)
    if q.size < 2 or q.size != density.size:
        raise InputError(
            f"wavenumber and density must have the same length, at least 2; "
            f"got {q.size} and {density.size}"
        )
    if (np.diff(q) <= 0.0).any():
        at = int(np.argmax(np.diff(q) <= 0.0)) + 1
        raise InputError(f"wavenumber must increase; got {q[at]:g} rad/m at index {at}")
    if (density < 0.0).any():
        at = int(np.argmax(density < 0.0))
        raise InputError(f"density must not be negative; got {density[at]:g} {unit} at index {at}")
    checks.not_negative("interpolated", spectrum.interpolated)
    for name, values in (("wavenumber", q), ("density", density)):
        values.flags.writeable = False
        object.__setattr__(spectrum, name, values)
