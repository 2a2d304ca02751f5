"""Power spectra of lines and surfaces: the height variance by wavenumber.

    <z^2> = int_0^inf C_1(q) dq                       line, one-sided, C_1 [m^3]
    <z^2> = 2 pi int_0^inf q C(q) dq                  surface, mean over directions, C [m^4]
    C_1(k) = 4 int_k^inf q C(q) dq / sqrt(q^2 - k^2)  lines of a surface (Abel)

in the conventions of B. N. J. Persson et al., J. Phys.: Condens. Matter 17 (2005) R1,
doi:10.1088/0953-8984/17/1/R01. The mean square gradient of an isotropic surface is twice the mean
square slope of its lines: every number here says which of the two it is. How spectra are measured
and why Abel's equation is solved by least squares is in docs/derivations.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike, NDArray

from gripscale.core import Array, Checked, InputError, Quantity, checked, checks
from gripscale.surface.low_pass import STEEPEST, followed_lines, upper_envelope
from gripscale.surface.profile import FEWEST_POINTS, HeightMap, Profile, height_table, of_one_step
from gripscale.surface.resampling import fill_gaps, without_line

_PER_DECADE = 10  # wavenumbers a decade where a spectrum is averaged
_ABSCISSAE, _WEIGHTS = np.polynomial.legendre.leggauss(6)


class ProfileSpectrum(Checked, eq=False):
    """One-sided power spectrum of a line; arrays have the shape (points,).

    Raises `InputError` if lengths differ or a value is out of range.
    """

    wavenumber: Array = checked(checks.increasing_vector, unit="rad/m")
    """2 pi over the wavelength [rad/m], above zero, increasing."""
    density: Array = checked(checks.not_negative_vector, unit="m^3")
    """C_1 [m^3], not negative: the mean over the wavenumbers each point represents."""
    width: Array = checked(checks.vector, unit="rad/m", default=None)
    """Range of wavenumbers that each point represents [rad/m]; half way (in the logarithm) to its
    neighbours by default, and to the first and last point."""
    interpolated: float = checked(checks.not_negative, default=0.0)
    """Share of the heights that were missing and interpolated [-]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        q, width = self.wavenumber, self.width
        checks.same_length(2, wavenumber=q, density=self.density)
        if width is None:
            width = np.diff(np.concatenate((q[:1], np.sqrt(q[1:] * q[:-1]), q[-1:])))
        if width.size != q.size or (width <= 0.0).any():
            raise InputError(
                f"width must have {q.size} entries above zero; got {checks.short_repr(width)}"
            )
        self._set(width=width)

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

    def averaged(self, per_decade: int = _PER_DECADE) -> ProfileSpectrum:
        """Return the spectrum at fewer points, evenly spaced in log q where there are enough.

        The variance is kept exactly.
        """
        each = checks.whole("per_decade", per_decade, least=1, most=1000)
        start = first_of_bins(self.wavenumber, each)
        width = np.add.reduceat(self.width, start)
        middle = np.add.reduceat(np.log(self.wavenumber) * self.width, start) / width
        power = np.add.reduceat(self.density * self.width, start)
        return ProfileSpectrum(np.exp(middle), power / width, width, self.interpolated)


class ArealSpectrum(Checked, eq=False):
    """Power spectrum of a surface, mean over directions; arrays have the shape (points,).

    Between its points q^3 C(q) is linear in log q; outside them there are no waves. Raises
    `InputError` if lengths differ or a value is out of range.
    """

    wavenumber: Array = checked(checks.increasing_vector, unit="rad/m")
    """Absolute wavenumber 2 pi/wavelength [rad/m], above zero, increasing, at least two."""
    density: Array = checked(checks.not_negative_vector, unit="m^4")
    """C [m^4], not negative."""
    interpolated: float = checked(checks.not_negative, default=0.0)
    """Share of the heights that were missing and interpolated [-]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.same_length(2, wavenumber=self.wavenumber, density=self.density)

    def at(self, wavenumber: ArrayLike) -> Array:
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


def last_wavenumber(q: Array, smallest_wavelength: float | None) -> float:
    """Return 2 pi over the smallest wavelength, by default the last of `q` [rad/m]."""
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


# Weights of a window: with "hann" its straight line is subtracted before, else its mean.
_TAPERS = ("hann", "none")
_WINDOWS = 4  # windows a tapered line is cut into by default; as many fit again between them


def profile_spectrum(
    profile: Profile | Sequence[Profile] | HeightMap,
    *,
    window: Quantity | None = None,
    taper: str = "hann",
    steepest: float = STEEPEST,
) -> ProfileSpectrum:
    """Return the one-sided power spectrum of one profile, or the mean over several.

    Windows overlap by a half; each is freed of its trend and weighted. The sum over the wavenumbers
    is mean(w^2 z^2)/mean(w^2): with taper "none" and one window the variance of the heights
    exactly, with "hann" their variance about the trends, as the windows weigh it. Raises
    `InputError` if the steps differ, the window does not fit or a word is unknown.

    Parameters
    ----------
    profile : Profile, sequence of Profile or HeightMap
        Cleaned profiles, or a map for its lines along x; several must have the same step (within
        0.1 %). Missing heights are interpolated linearly, and their share is reported.
    window : float, optional
        Length of the windows and so of the longest wave [m]; by default a quarter of the shortest
        profile, or all of it without a taper.
    taper : str
        "hann" for a measured line, whose ends do not meet: without it their jump would be spread
        over all small waves; a straight line is taken out of each window. "none" for a line that is
        a whole number of periods: only the mean is taken out.
    steepest : float
        Flanks above this slope [-] are filled first, since rubber does not follow them; infinity
        keeps them.
    """
    periodic = checks.one_of("taper", taper, _TAPERS) == "none"
    profiles = of_one_step(followed_lines(profile, steepest, periodic=periodic), "averaged")
    step = profiles[0].step
    shortest = min(len(p) for p in profiles)
    parts = 1 if periodic else _WINDOWS
    points = max(shortest // parts, FEWEST_POINTS)
    if window is not None:
        points = round(checks.positive("window", window, unit="m") / step)
        if not FEWEST_POINTS <= points <= shortest:
            raise InputError(
                f"window must be from {FEWEST_POINTS * step:g} m to {shortest * step:g} m long; "
                f"got {window:g}"
            )
    weights = np.ones(points) if periodic else np.hanning(points + 1)[:-1]
    powers = []
    for line in profiles:
        z = fill_gaps(line.z, periodic=periodic)
        windows = sliding_window_view(z, points)[:: points - points // 2]
        mean = windows.mean(axis=1, keepdims=True)
        windows = windows - mean if periodic else without_line(windows)
        power = np.mean(np.abs(np.fft.rfft(weights * windows)) ** 2, axis=0) / (weights @ weights)
        power[1 : (points + 1) // 2] *= 2.0  # the highest wave of an even number has no mirror
        powers.append(power)
    density = step / (2.0 * np.pi) * np.average(powers, axis=0, weights=[len(p) for p in profiles])
    q = 2.0 * np.pi / (points * step) * np.arange(1.0, points // 2 + 1)
    missing = sum(p.missing for p in profiles) / sum(len(p) for p in profiles)
    return ProfileSpectrum(q, density[1:], np.full(q.size, q[0]), missing)


def map_spectrum(
    z: ArrayLike,
    *,
    x_step: Quantity,
    y_step: Quantity,
    taper: str = "hann",
    per_decade: int = _PER_DECADE,
    steepest: float = STEEPEST,
) -> ArealSpectrum:
    """Return the power spectrum of a height map, mean over directions.

    The mean of all plane waves within rings of absolute wavenumber, up to the ring that still fits
    into the sampled wavenumbers; the corners beyond are left out. Raises `InputError` if a value is
    out of range or no height is there.

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
    steepest : float
        As in `profile_spectrum`.
    """
    from scipy import fft

    steps = checks.positive("x_step", x_step, unit="m"), checks.positive("y_step", y_step, unit="m")
    heights = height_table("z", z)
    if min(heights.shape) < FEWEST_POINTS:
        raise InputError(
            f"z must have at least {FEWEST_POINTS} heights each way; got shape {heights.shape}"
        )
    each = checks.whole("per_decade", per_decade, least=1, most=1000)
    periodic = checks.one_of("taper", taper, _TAPERS) == "none"
    slope = checks.positive("steepest", steepest, infinite=True)
    whole = fill_gaps(heights, steps, periodic=periodic)
    whole = upper_envelope(whole, steps, slope, periodic=periodic)
    whole = whole - whole.mean()
    windows = [np.ones(n) for n in whole.shape]
    if taper == "hann":
        x, y = (np.arange(n) - 0.5 * (n - 1) for n in whole.shape)
        nx, ny = whole.shape
        tilt_x, tilt_y = x @ whole.sum(axis=1) / (ny * x @ x), whole.sum(axis=0) @ y / (nx * y @ y)
        whole = whole - (tilt_x * x)[:, None] - tilt_y * y
        windows = [np.hanning(n + 1)[:-1] for n in whole.shape]
    weights = windows[0][:, None] * windows[1]
    area = steps[0] * steps[1] / (4.0 * np.pi**2 * np.square(weights).sum())
    power = np.asarray(area * np.abs(fft.rfft2(weights * whole)) ** 2, dtype=np.float64)
    qx = 2.0 * np.pi * np.fft.fftfreq(whole.shape[0], steps[0])
    qy = 2.0 * np.pi * np.fft.rfftfreq(whole.shape[1], steps[1])
    q = np.asarray(np.hypot(qx[:, None], qy), dtype=np.float64)
    # all columns but the first, and the last of an even number, stand for their mirror, too
    twice = np.full(power.shape, 2.0)
    twice[:, 0] = 1.0
    if whole.shape[1] % 2 == 0:
        twice[:, -1] = 1.0
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
    twice = twice[inside]
    count = np.bincount(which, twice)
    middle = np.exp(np.bincount(which, twice * np.log(q[inside])) / count)
    density = np.bincount(which, twice * power[inside]) / count
    return ArealSpectrum(middle, density, float(np.isnan(heights).mean()))


_TAIL_POINTS = 4  # last points of a spectrum whose power law is continued
_SLOWEST_FALL = 1.0  # least exponent of C_1 beyond them: with less the variance would be infinite


def areal_spectrum(spectrum: ProfileSpectrum) -> ArealSpectrum:
    """Return the spectrum of the isotropic surface whose lines have a measured one.

    The Abel equation is solved for the C >= 0 at the averaged wavenumbers that fits C_1 there best,
    relative to its scatter. Beyond the last point C_1 is continued as the power law of its last
    points: lines see those waves at smaller k, too, but they are no part of the result. The
    `spectrum` of lines in any direction is averaged to ten wavenumbers a decade first. Raises
    `InputError` if there are fewer than four points.
    """
    from scipy.optimize import nnls

    checks.instance("spectrum", spectrum, ProfileSpectrum)
    mean = spectrum.averaged()
    q, density = mean.wavenumber, mean.density
    if q.size < _TAIL_POINTS or not (density >= checks.LEAST).all():
        raise InputError(
            f"spectrum must have at least {_TAIL_POINTS} points above zero to be turned into that "
            f"of a surface; got {int((density >= checks.LEAST).sum())}"
        )
    certainty = np.sqrt(mean.width) / density
    size = density / q
    matrix = certainty[:, None] * _abel_matrix(q, density) * size
    areal = size * nnls(matrix, certainty * density)[0]
    return ArealSpectrum(q, areal, mean.interpolated)


def _abel_matrix(q: Array, density: Array) -> Array:
    """Return the matrix from C to C_1 at `q`: C_1(q) = 4 int C k dtheta, k = q cosh(theta).

    Waves beyond the last point Q, C continuing as C_1/q does at the end, C ~ q^(-1 - s), add
    4 int_Q^inf C q dq / sqrt(q^2 - k^2) = 2 C(Q) Q (Q/k)^s B(k^2/Q^2; s/2, 1/2).
    """
    from scipy.special import beta, betainc

    matrix = np.zeros((q.size, q.size))
    logs = np.log(q)
    for row, start in enumerate(q):
        angle = np.arccosh(np.maximum(q[row:] / start, 1.0))
        half = 0.5 * np.diff(angle)[:, None]
        k = start * np.cosh(angle[:-1, None] + half * (1.0 + _ABSCISSAE))
        share = (np.log(k) - logs[row:-1, None]) / np.diff(logs)[row:, None]
        part = 4.0 * half * _WEIGHTS / k**2
        matrix[row, row:-1] += (part * (1.0 - share)).sum(axis=1)
        matrix[row, row + 1 :] += (part * share).sum(axis=1)
    matrix *= q**3
    fall = np.log(density[-_TAIL_POINTS] / density[-1]) / np.log(q[-1] / q[-_TAIL_POINTS])
    s = max(float(fall), _SLOWEST_FALL)
    incomplete = betainc(s / 2.0, 0.5, (q / q[-1]) ** 2) * beta(s / 2.0, 0.5)
    matrix[:, -1] += 2.0 * q[-1] * (q[-1] / q) ** s * incomplete
    return matrix
