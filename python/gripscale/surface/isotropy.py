"""From the spectrum of lines to that of the isotropic surface they were measured on.

A line sees a wave of wavenumber q at an angle phi as one of q cos(phi), so that

    C_1(k) = 4 int_k^inf q C(q) dq / sqrt(q^2 - k^2)
    C(q)   = -1/(2 pi) int_q^inf C_1'(k) dk / sqrt(k^2 - q^2)

The first is Abel's integral equation, the second its solution (R. N. Bracewell, The Fourier
Transform and Its Applications, 3rd ed. (2000), ch. 13; for surfaces P. R. Nayak, J. Lubr. Technol.
93 (1971) 398, doi:10.1115/1.3451608). For C_1 ~ q^(-1 - 2H) it is, by the beta function,

    C(q) = C_1(q) / (2 sqrt(pi) q Gamma(H + 1/2) / Gamma(H + 1)),

1.6 to 2 times (H from 0.5 to 1) the C_1/(2 pi q) that takes every wave to run along the line. The
solution needs the derivative of a measured, scattered curve; C is found here by least squares on
the first equation instead, and not negative.
"""

from __future__ import annotations

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.profile import FloatArray
from gripscale.surface.spectrum import PER_DECADE, ArealSpectrum, ProfileSpectrum

_TAIL_POINTS = 4
"""Last points whose power law is taken to go on."""

_SLOWEST_FALL = 1.0
"""Least exponent of C_1 there: with less the variance beyond would be infinite."""

_ABSCISSAE, _WEIGHTS = np.polynomial.legendre.leggauss(6)


def areal_spectrum(
    spectrum: ProfileSpectrum, *, hurst: float | None = None, per_decade: int = PER_DECADE
) -> ArealSpectrum:
    """Return the spectrum of the isotropic surface whose lines have the given one.

    The Abel equation is solved for the C >= 0 at the averaged wavenumbers that fits C_1 there best,
    relative to its scatter. Beyond the last point C_1 is taken to go on as the power law of its
    last points: those waves are seen at smaller k, too, but are no part of the result.

    Parameters
    ----------
    spectrum : ProfileSpectrum
        Of lines in any direction.
    hurst : float, optional
        Hurst exponent of a surface that is self-affine all over: the closed form is used then.
    per_decade : int
        Wavenumbers a decade to which the spectrum is averaged first.

    Raises
    ------
    InputError
        If `hurst` is not above 0 and up to 1, or there are fewer than four points.
    """
    from scipy.optimize import nnls
    from scipy.special import gamma

    checks.instance("spectrum", spectrum, ProfileSpectrum)
    mean = spectrum.averaged(per_decade)
    q, density = mean.wavenumber, mean.density
    if q.size < _TAIL_POINTS or not (density >= checks.LEAST).all():
        raise InputError(
            f"spectrum must have at least {_TAIL_POINTS} points above zero to be turned into that "
            f"of a surface; got {int((density >= checks.LEAST).sum())}"
        )
    if hurst is not None:
        exponent = checks.positive("hurst", hurst)
        if exponent > 1.0:
            raise InputError(f"hurst must be at most 1; got {hurst:g}")
        ratio = gamma(exponent + 0.5) / gamma(exponent + 1.0)
        areal = density / (2.0 * np.sqrt(np.pi) * q * ratio)
    else:
        certainty = np.sqrt(mean.width) / density
        size = density / q
        matrix = certainty[:, None] * _seen_by_lines(q, density) * size
        areal = size * nnls(matrix, certainty * density)[0]
    return ArealSpectrum(q, areal, mean.interpolated)


def _seen_by_lines(q: FloatArray, density: FloatArray) -> FloatArray:
    """Return the matrix from C to C_1 at `q`: C_1(q) = 4 int C k dtheta, k = q cosh(theta)."""
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
    return np.asarray(matrix * q**3 + _seen_beyond(q, density))


def _seen_beyond(q: FloatArray, density: FloatArray) -> FloatArray:
    """Return what waves beyond the last point add, C going on as C_1/q does at the end.

    4 int_Q^inf C q dq / sqrt(q^2 - k^2) = 2 C(Q) Q (Q/k)^s B(k^2/Q^2; s/2, 1/2), C ~ q^(-1 - s).
    """
    from scipy.special import beta, betainc

    fall = np.log(density[-_TAIL_POINTS] / density[-1]) / np.log(q[-1] / q[-_TAIL_POINTS])
    s = max(float(fall), _SLOWEST_FALL)
    incomplete = betainc(s / 2.0, 0.5, (q / q[-1]) ** 2) * beta(s / 2.0, 0.5)
    added = np.zeros((q.size, q.size))
    added[:, -1] = 2.0 * q[-1] * (q[-1] / q) ** s * incomplete
    return added
