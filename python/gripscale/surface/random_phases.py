"""A surface known by its power spectrum only: lines of it with random phases, and its correlation.

With J_0 the Bessel function, the lines of an isotropic surface have (Wiener and Khinchin; Abel)

    C_z(l) = 4 pi int_0^inf q C(q) (1 - J_0(q l)) dq,
    C_1(k) = 4 int_k^inf q C(q) dq / sqrt(q^2 - k^2).

A line of N steps d has waves k_n = 2 pi n/(N d) of the amplitudes sqrt(2 C_1(k_n) k_1), and drawn
phases: Gaussian heights. Those of a real surface are not, which changes an answer by `REAL_PHASES`
(`python -m studies.spectrum_phases`). A map of four million points holds too few decades of waves.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Finding, InputError, Severity, Topic, checked, checks, in_mm
from gripscale.surface.height_difference import HeightDifference
from gripscale.surface.low_pass import MOST_SHARE, PER_FOOTPRINT, transmission
from gripscale.surface.profile import MOST_PROFILE_POINTS, Profile
from gripscale.surface.spectrum import ArealSpectrum

PHASES_OF = "phases_of_spectrum"  # attribute of a result of a spectrum: the phases it is for
# Area and friction over those with random phases, each with the standard deviation of its logarithm
# from surface to surface, both logarithms over 1 - A; and degrees of freedom.
REAL_PHASES = {
    "real": ((1.34, 1.07), (0.81, 1.16), 33.0),
    "worn": ((2.9, 0.63), (0.33, 0.68), 21.0),
}
_LINES, _WAVES = 4, 16  # lines that are drawn, and longest waves in each
_ENOUGH_POINTS = 2**17  # of a line: with more it holds fewer of its longest waves, at least one
_POINTS_IN_WAVE = 8  # steps in the smallest wave
_PER_DECADE, _LAGS_PER_DECADE = 200, 20  # points of an integral and of a correlation


class Spectrum(ArealSpectrum, eq=False):
    """A surface known by its power spectrum only: <z^2> = 2 pi int_0^inf q C(q) dq.

    C is the mean over directions, zero outside its points. Raises as `ArealSpectrum` does.

        >>> round(gs.Spectrum([1e3, 1e4, 1e5], [1e-14, 2e-18, 5e-22]).rms_height, 6)
        0.000207
    """

    name: str = checked(checks.text, default="")
    """Name of the surface in tables and figures."""
    source: str = checked(checks.text, default="")
    """Where it comes from, such as a file name."""
    phases: str = checked(checks.one_of, choices=(*REAL_PHASES, "random"), default="real")
    """What an answer is for: "real" phases of any surface, or "worn" ones, of flat tops (negative
    skewness), as most roads, both with their scatter; or "random" ones, of Gaussian heights."""

    def of_lines(self, wavenumber: ArrayLike) -> Array:
        """Return C_1 [m^3] of its lines at wavenumbers above zero [rad/m], shape (points,)."""
        k, last = np.asarray(wavenumber, dtype=float), float(self.wavenumber[-1])
        nodes = _middles(0.98 * float(k.min()), last)[0]
        most = np.arccosh(last / nodes)
        q = nodes[:, None] * np.cosh(most[:, None] * (np.arange(400) + 0.5) / 400)
        density = 4.0 * most * np.mean(q * self.at(q), axis=1)  # q = k cosh(angle)
        return np.where(k <= last, np.interp(np.log(k), np.log(nodes), density), 0.0)

    def height_difference(self, lag: ArrayLike) -> HeightDifference:
        """Return the correlation C_z of its lines at lags [m], shape (lags,)."""
        from scipy.special import j0

        first, last = self.wavenumber[[0, -1]].tolist()
        lags, (q, width) = np.asarray(lag, dtype=float), _middles(first, last)
        power = 4.0 * np.pi * width * q**2 * self.at(q)
        value = np.array([power @ (1.0 - j0(q * each)) for each in lags])
        return HeightDifference(lags, value, resolution_limit=2.0 * np.pi / last)

    def without_long_waves(self, longest: float) -> Spectrum:
        """Return it without the waves beyond the cut-off `longest` [m] (`surface.low_pass`)."""
        kept = 1.0 - transmission(self.wavenumber, longest)
        return replace(self, density=self.density * kept**2)

    def lines(
        self, footprint: float, smallest_wavelength: float | None = None
    ) -> tuple[list[Profile], HeightDifference]:
        """Return lines of it with random phases, always the same ones, and its correlation.

        Each has the whole variance, waves to a quarter of the smallest wavelength [m], and up to
        sixteen of the longest or of 1.5 footprints [m]. Waves beyond the footprint are left out if
        they hold most of it, as of profiles. Raises `InputError` if one has too many points.
        """
        shortest, longest = (2.0 * np.pi / self.wavenumber[[-1, 0]]).tolist()
        longest = min(longest, PER_FOOTPRINT * footprint)
        held = self.without_long_waves(longest)
        decide = held.rms_height**2 < (1.0 - MOST_SHARE) * self.rms_height**2
        spectrum = held if decide and longest == PER_FOOTPRINT * footprint else self
        step = max(smallest_wavelength or shortest, shortest) / _POINTS_IN_WAVE
        if longest > MOST_PROFILE_POINTS * step:
            end = _POINTS_IN_WAVE * longest / MOST_PROFILE_POINTS
            raise InputError(f"smallest_wavelength must be at least {end:.2g} m; got {8 * step:g}")
        enough = max(min(_WAVES * longest / step, _ENOUGH_POINTS), longest / step)
        points = 2 * math.ceil(0.5 * enough)
        x, first = step * np.arange(points), 2.0 * np.pi / (points * step)
        amplitude = np.sqrt(2.0 * first * spectrum.of_lines(first * np.arange(1, points // 2)))
        lines = []
        for number in range(_LINES):
            phase = np.random.default_rng(number).uniform(0.0, 2.0 * np.pi, amplitude.size)
            waves = np.pad(0.5 * points * amplitude * np.exp(1j * phase), 1)
            name = f"{self.name or 'spectrum'} {number + 1}"
            lines.append(Profile(x, np.fft.irfft(waves, points), name, self.source, shortest))
        lags = np.geomspace(step, 0.25 * x[-1], int(_LAGS_PER_DECADE * math.log10(points)))
        return lines, spectrum.height_difference(lags)

    @property
    def finding(self) -> Finding:
        """What an answer from it rests on."""
        shortest = in_mm(2.0 * np.pi / float(self.wavenumber[-1]), 2)
        (area, _), (friction, _), _ = REAL_PHASES["worn"]
        text = (
            f"The surface is known by its spectrum (rms height {in_mm(self.rms_height, 3)}, rms "
            f"slope {self.rms_gradient():.2g} down to {shortest}), which does not tell its phases: "
            f'with worn or flat tops, as of most roads (phases = "worn" in [surface]), they make '
            f"{area:.2g} times the area and {friction:.2g} times the friction of random phases."
        )
        changes = (friction - 1.0, area - 1.0) if self.phases == "random" else (math.nan, math.nan)
        return Finding(Severity.WARNING, text, *changes, Topic.SURFACE)


def _middles(first: float, last: float) -> tuple[Array, float]:
    """Return the middles of even steps in log q between two wavenumbers, and the step."""
    count = max(64, math.ceil(_PER_DECADE * math.log10(last / first)))
    width = math.log(last / first) / count
    return first * np.exp(width * (np.arange(count) + 0.5)), width
