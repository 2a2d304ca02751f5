"""The rms slope of a measured surface by wavelength, and the rules that cut its roughness off.

    h'_line(q)^2    = int_0^q k^2 C_1(k) dk                  waves along the lines
    h'_surface(q)^2 = 2 pi int_0^q k^3 C(k) dk               waves of any direction
    h'(q)^2         = m + b q_m^(2-2H) ((q/q_m)^(2-2H) - 1)/(2 - 2H)    beyond the measured q_m

A rule is a length, an rms slope (B. Lorenz et al., J. Chem. Phys. 142 (2015) 194701,
doi:10.1063/1.4919221) or the instrument: docs/cut-off.md.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from gripscale.core import Array, Checked, Described, InputError, checked, checks
from gripscale.core.units import in_mm, parse_quantity, unit_of
from gripscale.surface.low_pass import STEEPEST, followed
from gripscale.surface.profile import RESOLVED_STEPS, HeightMap, Profile
from gripscale.surface.spectrum import (
    ArealSpectrum,
    ProfileSpectrum,
    areal_spectrum,
    map_spectrum,
    profile_spectrum,
)

# Whose slope: the length of the surface's gradient, or the slope along its lines.
DEFINITIONS = ("surface", "profile")
_ROUNDING = 1e-9  # relative difference below which two wavelengths are the same
# Range of wavenumbers, as a ratio, below the last resolved one to which a power law is fitted.
_FITTED = 10.0
_FEWEST = 4  # points this range must have


@dataclass(frozen=True)
class PowerLaw:
    """Continuation of a mean square slope below the measured wavelengths."""

    hurst: float
    """Exponent H of the continued surface."""
    growth: float
    """Growth of the mean square slope per unit of log q at the last wavenumber measured."""

    def added(self, ratio: float) -> float:
        """Return the mean square slope down to the `ratio`-th part of the last wavelength."""
        power, log = 2.0 - 2.0 * self.hurst, math.log(ratio)
        return self.growth * (math.expm1(power * log) / power if power else log)

    def ratio(self, wanted: float) -> float:
        """Return the ratio at which `wanted` mean square slope was added; infinite if never."""
        power, part = 2.0 - 2.0 * self.hurst, wanted / self.growth
        if not power:
            return math.exp(part)
        reached = 1.0 + power * part
        return reached ** (1.0 / power) if reached > 0.0 else math.inf


@dataclass(frozen=True, eq=False, repr=False)
class SlopeByWavelength(Described):
    """Rms slope of a measured surface down to any wavelength, see `slope_by_wavelength`."""

    line: ProfileSpectrum = field(repr=False)
    """Of the lines along the way of sliding."""
    areal: ArealSpectrum | None = field(repr=False)
    """Of the surface; None where the lines do not determine it."""
    resolution_limit: float
    """Shortest wavelength the measurement resolves [m]."""
    isotropic: bool = True
    """Whether the surface is the isotropic one of the lines, not a measured map."""

    @property
    def wavelength(self) -> Array:
        """Wavelengths [m], ten a decade, from the longest measured to the resolution limit."""
        limit = self.resolution_limit
        longest = float(2.0 * np.pi / self.line.wavenumber[0])
        count = max(2, math.ceil(10.0 * math.log10(max(longest / limit, 1.0))) + 1)
        return np.asarray(np.geomspace(max(longest, limit), limit, count))

    def down_to(self, wavelength: float, of: str = "surface") -> float:
        """Return the rms slope [-] of the waves not shorter than `wavelength` [m].

        `of` "surface" it is the rms length of the gradient, of "profile" the slope along lines.
        Beyond `resolution_limit` it is continued as a power law. NaN for a surface whose spectrum
        the lines do not determine, and beyond one that does not end as a power law.
        """
        length = checks.positive("wavelength", wavelength, unit="m")
        checks.one_of("of", of, DEFINITIONS)
        limit = self.resolution_limit
        if length >= limit * (1.0 - _ROUNDING):
            return self._measured(length, of)
        try:
            law = self.power_law(of)
        except InputError:
            return math.nan
        return math.sqrt(self._measured(limit, of) ** 2 + law.added(limit / length))

    def reaches(self, slope: float, of: str = "surface") -> float:
        """Return the longest wavelength [m] down to which the measured rms slope is `slope`.

        NaN if the measurement does not reach it.
        """
        from scipy.optimize import brentq

        checks.positive("slope", slope)
        checks.one_of("of", of, DEFINITIONS)
        total = self._measured(self.resolution_limit, of)
        if not total >= slope * (1.0 - _ROUNDING):
            return math.nan
        if of == "profile":
            sums = np.cumsum(_mean_square(self.line))
            first = int(np.searchsorted(sums, slope**2 * (1.0 - _ROUNDING)))
            return float(2.0 * np.pi / self.line.wavenumber[first])
        assert self.areal is not None
        if total <= slope:
            return self.resolution_limit
        longest = math.log(2.0 * np.pi / self.areal.wavenumber[0])

        def excess(log: float) -> float:
            return self._measured(math.exp(log), of) - slope

        return math.exp(brentq(excess, longest, math.log(self.resolution_limit), xtol=1e-12))

    def power_law(self, of: str = "surface") -> PowerLaw:
        """Return the power law by which the slope continues beyond the measurement.

        For the surface of profiles the exponent is that of their own spectrum, with the closed form
        of `areal_spectrum`. Raises `InputError` if the last resolved decade has fewer than four
        points, or does not fall as the spectrum of a self-affine surface (H above zero).
        """
        from scipy.special import gamma

        checks.one_of("of", of, DEFINITIONS)
        measured_map = of == "surface" and not self.isotropic
        if measured_map and self.areal is not None:
            q, growth = self.areal.wavenumber, 2.0 * np.pi * self.areal.wavenumber**4
            growth = growth * self.areal.density
        else:
            mean = self.line.averaged()
            q, growth = mean.wavenumber, mean.wavenumber**3 * mean.density
        last = 2.0 * np.pi / self.resolution_limit
        used = (q <= last * (1.0 + _ROUNDING)) & (q >= last / _FITTED) & (growth > 0.0)
        if used.sum() < _FEWEST:
            raise InputError(
                f"the spectrum must have {_FEWEST} points above zero in the decade above "
                f"{self.resolution_limit:.4g} m to be continued; got {used.sum()}"
            )
        # bins evenly spaced in log q hold waves in proportion to q, and scatter by their root
        logs, weight = np.log(q[used] / last), np.sqrt(q[used])
        power, log_growth = np.polyfit(logs, np.log(growth[used]), 1, w=weight)
        hurst = 1.0 - 0.5 * float(power)
        if hurst <= 0.0:
            raise InputError(
                f"the spectrum must fall as that of a self-affine surface to be continued; above "
                f"{self.resolution_limit:.4g} m its exponent is H = {hurst:.2f}, as of noise"
            )
        law = PowerLaw(hurst, math.exp(float(log_growth)))
        if measured_map or of == "profile":
            return law
        ratio = math.sqrt(math.pi) * gamma(law.hurst + 1.0) / gamma(law.hurst + 0.5)
        return PowerLaw(law.hurst, float(ratio) * law.growth)

    def _measured(self, length: float, of: str) -> float:
        """Return the slope down to a resolved length; zero above the longest wave."""
        spectrum = self.line if of == "profile" else self.areal
        if spectrum is None:
            return math.nan
        number = 2.0 * np.pi / length * (1.0 + _ROUNDING)
        if isinstance(spectrum, ProfileSpectrum):
            counted = spectrum.wavenumber <= number
            return float(np.sqrt(_mean_square(spectrum)[counted].sum()))
        if number <= spectrum.wavenumber[0] * (1.0 + 2.0 * _ROUNDING):
            return 0.0
        return spectrum.rms_gradient(length if number < spectrum.wavenumber[-1] else None)


def slope_by_wavelength(
    surface: Profile | Sequence[Profile] | HeightMap, *, steepest: float = STEEPEST
) -> SlopeByWavelength:
    """Return the rms slope of a measured surface, as cleaned, down to each wavelength.

    They reach down to four steps of the measurement, or to the shortest wavelength that the
    instrument measures reliably if that is known and longer. Profiles are taken as lines on an
    isotropic surface; several must have the same step (within 0.1 %). Of a map the gradient is
    measured, and its lines along x are the profiles. Missing heights are interpolated. Flanks above
    a slope of `steepest` [-] are filled first, since rubber does not follow them; infinity keeps
    them. Raises `InputError` if `surface` is something else, or the steps of its profiles differ.
    """
    if isinstance(surface, HeightMap):
        x_step, y_step = surface.step
        heights, kept = followed(surface, steepest), math.inf
        # many lines need no windows: the waves longer than a window have their slope, too
        line = profile_spectrum(heights, window=x_step * surface.x.size, steepest=kept)
        areal = map_spectrum(heights.z, x_step=x_step, y_step=y_step, steepest=kept)
        limit = max(RESOLVED_STEPS * max(surface.step), surface.reliable or 0.0)
        return SlopeByWavelength(line, areal, limit, isotropic=False)
    line = profile_spectrum(surface, steepest=steepest)
    profiles = [surface] if isinstance(surface, Profile) else surface
    isotropic: ArealSpectrum | None
    try:
        isotropic = areal_spectrum(line)
    except InputError:  # too few waves
        isotropic = None
    return SlopeByWavelength(line, isotropic, max(p.resolution_limit for p in profiles))


def _mean_square(line: ProfileSpectrum) -> Array:
    """Return the part of each point of the spectrum in the mean square slope."""
    return np.asarray(line.wavenumber**2 * line.density * line.width)


_INSTRUMENT = "instrument"  # the word for the shortest wavelength that the measurement resolves
# Ratio of the shortest wavelength measured to the shortest that it may be continued to.
_MOST_CONTINUED = 100.0


class RmsSlope(Checked):
    """The rule that the roughness ends where its rms slope adds up to a value.

    Raises `InputError` if a value cannot be used.
    """

    rms_slope: float = checked(checks.positive)
    """The value [-], above zero."""
    of: str = checked(checks.one_of, choices=DEFINITIONS, default="surface")
    """"surface": of the isotropic surface, the rms length of its gradient. "profile": of the slope
    along a line, which is smaller by about sqrt(2)."""
    extrapolate: bool = checked(checks.flag, default=False)
    """Whether the spectrum is continued as a power law, two decades at most, if the measurement
    does not reach the value. The result then rests on waves that were not measured."""

    def __str__(self) -> str:
        return f"rms slope {self.rms_slope:g} of the {self.of}"


CutOffRule = float | Literal["instrument"] | RmsSlope
"""A length [m], "instrument" or an `RmsSlope`."""


@dataclass(frozen=True, repr=False)
class SurfaceCutOff(Described):
    """The cut-off of a measured surface, its rule and the slopes down to it."""

    wavelength: float
    """Shortest wavelength that counts [m]."""
    rule: str
    """The rule, in words."""
    surface_slope: float
    """Rms length of the surface's gradient down to it [-]. NaN where the measurement does not
    determine it; continued as a power law if `beyond_measurement`."""
    profile_slope: float
    """Rms slope along a line down to it [-], likewise."""
    resolution_limit: float
    """Shortest wavelength that the measurement resolves [m]."""

    @property
    def beyond_measurement(self) -> bool:
        """Whether the roughness includes waves that the measurement does not resolve."""
        return self.wavelength < self.resolution_limit * (1.0 - _ROUNDING)

    def __str__(self) -> str:
        slopes = (
            f"rms slope down to it {self.surface_slope:.3g} of the surface, "
            f"{self.profile_slope:.3g} along a profile"
        )
        text = f"{in_mm(self.wavelength, 3)} ({self.rule}), {slopes}"
        if self.beyond_measurement:
            text += (
                "; beyond the measurement, which ends at "
                f"{in_mm(self.resolution_limit, 3)}: slopes and waves below are extrapolated"
            )
        return text


def find_cut_off(
    surface: Profile | Sequence[Profile] | HeightMap | SlopeByWavelength, rule: CutOffRule
) -> SurfaceCutOff:
    """Return where the roughness of a measured surface ends by a rule.

    Raises `InputError` if the rule is none of these, or the measurement does not reach the slope:
    the message says which it reaches, and where. Continued as a power law, if it is still not
    reached two decades below the measurement, or the spectrum does not end as a power law.

    Parameters
    ----------
    surface : Profile, sequence of Profile, HeightMap or SlopeByWavelength
        The surface as measured and cleaned, or its slopes.
    rule : float, "instrument" or RmsSlope
        A length [m]; the shortest wavelength that the measurement resolves; or the wavelength at
        which the rms slope adds up to a value.
    """
    slopes = surface if isinstance(surface, SlopeByWavelength) else slope_by_wavelength(surface)
    limit = slopes.resolution_limit
    if isinstance(rule, RmsSlope):
        length, words = _length_of_slope(slopes, rule), str(rule)
    elif isinstance(rule, str) and not unit_of(rule, "length"):
        checks.one_of("rule", rule, [_INSTRUMENT])
        length, words = limit, "the shortest wavelength that the measurement carries"
    else:
        length, words = checks.positive("rule", rule, unit="m"), "a stated length"
    surface_slope, profile_slope = (slopes.down_to(length, of) for of in DEFINITIONS)
    return SurfaceCutOff(length, words, surface_slope, profile_slope, limit)


def cut_off_rule(value: Any) -> CutOffRule:
    """Return the rule that a case file or a command line states.

    `value` is a length such as "0.1 mm" or in m, "instrument",
    { rms_slope = 1.3, of = "surface", extrapolate = false }, or the latter in words: "rms_slope 1.3
    of surface extrapolate". Raises `ValueError` with what was expected; the caller adds the place.
    """
    if value == _INSTRUMENT or isinstance(value, RmsSlope):
        return value  # type: ignore[no-any-return]
    if isinstance(value, dict):
        unknown = set(value) - {"rms_slope", "of", "extrapolate"}
        if unknown or "rms_slope" not in value:
            raise ValueError('expected a table such as { rms_slope = 1.3, of = "surface" }')
        return RmsSlope(**value)
    words = _WORDS.fullmatch(value) if isinstance(value, str) else None
    if words is not None:
        number, of, extrapolate = words.groups()
        if not _NUMBER.fullmatch(number):
            raise ValueError('expected a number after rms_slope, such as "rms_slope 1.3"')
        return RmsSlope(float(number), of or "surface", extrapolate is not None)
    try:
        length = parse_quantity(value, "length")
    except ValueError as error:
        raise ValueError(
            f'{error}, or "{_INSTRUMENT}", or {{ rms_slope = 1.3, of = "surface" }}'
        ) from error
    if length <= 0.0:
        raise ValueError("expected a length greater than zero")
    return length


_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_WORDS = re.compile(r"\s*rms_slope\s+(\S+)(?:\s+of\s+(\w+))?(\s+extrapolate)?\s*")


def _length_of_slope(slopes: SlopeByWavelength, rule: RmsSlope) -> float:
    """Return the wavelength down to which the slope adds up to that of `rule` [m]."""
    length, limit = slopes.reaches(rule.rms_slope, rule.of), slopes.resolution_limit
    if math.isfinite(length):
        # the last points of a spectrum may stand for waves a little shorter than is resolved
        return max(length, limit)
    reached = slopes.down_to(limit, rule.of)
    if math.isnan(reached):
        raise InputError(f"cut_off: the profiles are too short to tell the slope of the {rule.of}")
    if not rule.extrapolate:
        raise InputError(
            f"cut_off must be an rms slope of the {rule.of} that the measurement reaches, at most "
            f"{reached:.3g} at {in_mm(limit, 3)}, the shortest wavelength it carries; got "
            f"{rule.rms_slope:g} (extrapolate = true continues its spectrum as a power law)"
        )
    law = slopes.power_law(rule.of)
    ratio = law.ratio(rule.rms_slope**2 - reached**2)
    if ratio > _MOST_CONTINUED:
        raise InputError(
            f"cut_off must be an rms slope of the {rule.of} reached within a factor of "
            f"{_MOST_CONTINUED:g} below {in_mm(limit, 3)}, where it is {reached:.3g} and goes "
            f"on with H = {law.hurst:.2f}; got {rule.rms_slope:g}"
        )
    return limit / ratio
