"""Which smallest wavelength counts: the rules in use, and what they give on a measured surface.

The roughness of a surface goes on far below what a profile shows, and each octave adds friction
and takes contact area: where it is cut off is a choice that every prediction rests on. In use are

- a length: of dust, of a film of water, of the damage that sliding does to the rubber;
- an rms slope, 1.3 or about 1: the wavelength down to which the rms slope of the surface adds up
  to it (B. Lorenz, Y. R. Oh, S. K. Nam, S. H. Jeon, B. N. J. Persson, J. Chem. Phys. 142 (2015)
  194701, doi:10.1063/1.4919221); beyond, the strain is taken to be too large for the rubber to
  last. A. Genovese, F. Farroni, A. Papangelo, M. Ciavarella, Lubricants 7 (2019) 85,
  doi:10.3390/lubricants7100085, discuss how arbitrary it is;
- the instrument: the shortest wavelength that the measurement carries.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.height_map import HeightMap
from gripscale.surface.profile import Profile
from gripscale.surface.slope import (
    DEFINITIONS,
    ROUNDING,
    SlopeByWavelength,
    slope_by_wavelength,
)
from gripscale.units import parse_quantity

INSTRUMENT = "instrument"
"""The word for the shortest wavelength that the measurement carries."""

MOST_CONTINUED = 100.0
"""Ratio of the shortest wavelength measured to the shortest that it may be continued to."""


@dataclass(frozen=True)
class RmsSlope:
    """The rule that the roughness ends where its rms slope adds up to a value.

    Parameters
    ----------
    rms_slope : float
        The value [-], above zero.
    of : str
        "surface": of the isotropic surface, the rms length of its gradient. "profile": of the slope
        along a line, which is smaller by about sqrt(2).
    extrapolate : bool
        Whether, where the measurement does not reach the value, its spectrum is continued as a
        power law, two decades at most. What rests on it was not measured.

    Raises
    ------
    InputError
        If a value cannot be used.
    """

    rms_slope: float
    of: str = "surface"
    extrapolate: bool = False

    def __post_init__(self) -> None:
        slope = checks.positive("rms_slope", self.rms_slope)
        object.__setattr__(self, "rms_slope", slope)
        checks.one_of("of", self.of, DEFINITIONS)
        checks.flag("extrapolate", self.extrapolate)

    def __str__(self) -> str:
        return f"rms slope {self.rms_slope:g} of the {self.of}"


CutOffRule = float | Literal["instrument"] | RmsSlope
"""A length [m], "instrument" or an `RmsSlope`."""


@dataclass(frozen=True)
class CutOff:
    """Where the roughness of a measured surface ends, by which rule, and what that means.

    Attributes
    ----------
    wavelength
        Shortest wavelength that counts [m].
    rule
        Why it is this one, in words.
    surface_slope, profile_slope
        Rms slope down to it [-]: length of the surface's gradient, and along a line. NaN where the
        measurement does not tell; continued as a power law where `beyond_measurement`.
    carried
        Shortest wavelength that the measurement carries [m].
    """

    wavelength: float
    rule: str
    surface_slope: float
    profile_slope: float
    carried: float

    @property
    def beyond_measurement(self) -> bool:
        """Whether waves count that the measurement does not carry."""
        return self.wavelength < self.carried * (1.0 - ROUNDING)

    def __str__(self) -> str:
        slopes = (
            f"rms slope down to it {self.surface_slope:.3g} of the surface, "
            f"{self.profile_slope:.3g} along a profile"
        )
        text = f"{_mm(self.wavelength)} ({self.rule}), {slopes}"
        if self.beyond_measurement:
            text += (
                f"; beyond the measurement, which ends at {_mm(self.carried)}: slopes and waves "
                "below are extrapolated"
            )
        return text


def find_cut_off(
    surface: Profile | Sequence[Profile] | HeightMap | SlopeByWavelength, rule: CutOffRule
) -> CutOff:
    """Return where the roughness of a measured surface ends by a rule.

    Parameters
    ----------
    surface : Profile, sequence of Profile, HeightMap or SlopeByWavelength
        The surface as measured and cleaned, or its slopes.
    rule : float, "instrument" or RmsSlope
        A length [m]; the shortest wavelength that the measurement carries; or where the rms slope
        adds up to a value.

    Returns
    -------
    CutOff
        The wavelength, the slopes down to it, and whether it lies beyond the measurement.

    Raises
    ------
    InputError
        If the rule is none of these, or the measurement does not reach the slope: the message says
        which it reaches, and where. Continued as a power law, if it is still not reached two
        decades below the measurement, or the spectrum does not end as a power law.
    """
    slopes = surface if isinstance(surface, SlopeByWavelength) else slope_by_wavelength(surface)
    if isinstance(rule, RmsSlope):
        return _at(slopes, _of_slope(slopes, rule), str(rule))
    if isinstance(rule, str):
        checks.one_of("rule", rule, [INSTRUMENT])
        return _at(slopes, slopes.carried, "the shortest wavelength that the measurement carries")
    return _at(slopes, checks.positive("rule", rule, unit="m"), "a stated length")


def cut_off_rule(value: Any) -> CutOffRule:
    """Return the rule that a case file or a command line states.

    Parameters
    ----------
    value : str, float, mapping or rule
        A length such as "0.1 mm" or in m, "instrument", { rms_slope = 1.3, of = "surface",
        extrapolate = false }, or that in words: "rms_slope 1.3", "rms_slope 1.3 of profile",
        "rms_slope 1.3 of surface extrapolate".

    Raises
    ------
    ValueError
        With what was expected; the caller adds the place.
    """
    if value == INSTRUMENT or isinstance(value, RmsSlope):
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
            f'{error}, or "{INSTRUMENT}", or {{ rms_slope = 1.3, of = "surface" }}'
        ) from error
    if length <= 0.0:
        raise ValueError("expected a length greater than zero")
    return length


_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_WORDS = re.compile(r"\s*rms_slope\s+(\S+)(?:\s+of\s+(\w+))?(\s+extrapolate)?\s*")


def _at(slopes: SlopeByWavelength, length: float, why: str) -> CutOff:
    surface, profile = (slopes.down_to(length, of) for of in DEFINITIONS)
    return CutOff(length, why, surface, profile, slopes.carried)


def _of_slope(slopes: SlopeByWavelength, rule: RmsSlope) -> float:
    """Return the wavelength down to which the slope adds up to that of `rule` [m]."""
    found = slopes.reaches(rule.rms_slope, rule.of)
    if math.isfinite(found):
        # the last points of a spectrum may stand for waves a little shorter than is carried
        return max(found, slopes.carried)
    reached = slopes.down_to(slopes.carried, rule.of)
    if math.isnan(reached):
        raise InputError(f"cut_off: the profiles are too short to tell the slope of the {rule.of}")
    if not rule.extrapolate:
        raise InputError(
            f"cut_off must be an rms slope of the {rule.of} that the measurement reaches, at most "
            f"{reached:.3g} at {_mm(slopes.carried)}, the shortest wavelength it carries; got "
            f"{rule.rms_slope:g} (extrapolate = true continues its spectrum as a power law)"
        )
    law = slopes.power_law(rule.of)
    ratio = law.ratio(rule.rms_slope**2 - reached**2)
    if ratio > MOST_CONTINUED:
        raise InputError(
            f"cut_off must be an rms slope of the {rule.of} reached within a factor of "
            f"{MOST_CONTINUED:g} below {_mm(slopes.carried)}, where it is {reached:.3g} and goes "
            f"on with H = {law.hurst:.2f}; got {rule.rms_slope:g}"
        )
    return slopes.carried / ratio


def _mm(length: float) -> str:
    return f"{length * 1e3:.3g} mm"
