"""From measured lines to the isotropic surface they lie on: laws measured on synthetic surfaces.

    ln f = a_0 + a_1 t + a_2 (T / P)^(1/3) + a_3 S,    ln g likewise,
    A_map = erf(f^(1 - A/2) erfinv(A)),    ln(mu_map / mu) = (1 - A^4) ln g + A^4 ln 1.11,

with t, T, P and S of `LineUnderLoad` (`python -m studies.line_to_map`), and the factors of large
strain on a direct contact, with x = p_0/|E*| (`python -m studies.large_strain`):

    area:      ln f = 0.069 (x/A) (1 - A)^0.5,        friction:  ln g = -0.175 x / A^0.5.

docs/isotropic-maps.md and docs/direct-contact.md say what they rest on.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, InputError, checks
from gripscale.half_space.response import HalfSpace
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber
from gripscale.rubber.material import plane_strain_modulus_of
from gripscale.surface import Profile
from gripscale.surface.profile import profile_list

# Length of the lines the law was measured on, in largest waves; longer waves count as a slope.
_PIECE = 16.0
_TINY = 1e-12
# Shares of a line that are higher than its upper height, and than both ends of its tail.
EXCEEDED, TAIL = 0.01, (0.005, 0.02)


class LineUnderLoad(NamedTuple):
    """What the law needs of a line, or of several, and of the load [-]."""

    upper_height: float | Array  # t: height that 1 % of the line exceeds over its rms height
    tail: float | Array  # T: from the height that 2 % exceed to that of 0.5 %, over the rms height
    relative_load: float | Array  # P: pressure times largest wave over modulus times rms height
    softening: float | Array = 0.0  # S: ln of E' over that at twice the strain, smallest wave

    @property
    def columns(self) -> tuple[Array, ...]:
        """What the numbers of a law multiply after its constant."""
        t, tail, load, softening = map(np.asarray, self)
        return t, np.cbrt(tail / load), softening

    @property
    def reach(self) -> Array:
        """The columns over the largest that the law was fitted to, the largest of them."""
        pairs = zip(self.columns[:2], FITTED_TO, strict=True)
        return np.asarray(np.max([column / most for column, most in pairs], axis=0))


class RatioLaw(NamedTuple):
    """ln y = constant + slope t + tail (T / P)^(1/3) + softening S, and how well it is known."""

    constant: float
    slope: float
    tail: float
    softening: float
    # Standard deviation of ln y about the law, over maps of all families, without the error of the
    # lines themselves: at high load, and what few summits add in squares, over (T / P)^(1/3).
    scatter: float
    tail_scatter: float

    def at(self, line: LineUnderLoad) -> Array:
        """Return the ratio of lines."""
        terms = zip(self[1:4], line.columns, strict=True)
        return np.asarray(np.exp(self.constant + sum(number * of for number, of in terms)))

    def uncertainty(self, line: LineUnderLoad) -> Array:
        """Return the standard deviation of ln y about the law."""
        return np.hypot(self.scatter, self.tail_scatter * line.columns[1])


CONTACT_FRACTION_LAW = RatioLaw(-0.120, -0.113, -0.139, 1.068, 0.109, 0.074)
FRICTION_LAW = RatioLaw(-0.336, 0.071, 0.197, -0.233, 0.085, 0.095)
FULL_CONTACT_FRICTION = 1.11
# Degrees of freedom of the scatter: its variance differs from family to family as with so many.
FREEDOM = 64
# The largest t and (T / P)^(1/3) of the fit: beyond, the law is a guess.
FITTED_TO = (4.1, 8.5)
# What the law misses of changes of ln of both ratios on one surface, over that of ln area of lines:
# rms over pressures a factor of ten apart.
LOAD_SENSITIVITY = 0.10


class SurfaceOverLines(NamedTuple):
    """Ratio of a number of an isotropic surface to that of its lines, and its standard error."""

    ratio: Array
    uncertainty: Array  # of the logarithm [-]


def contact_fraction_ratio(line: LineUnderLoad, contact_fraction: ArrayLike) -> SurfaceOverLines:
    """Return the area ratio of a line at contact fractions of the lines [-]."""
    from scipy.special import erf, erfinv

    area = np.clip(np.asarray(contact_fraction, dtype=float), _TINY, 1.0 - _TINY)
    small = CONTACT_FRACTION_LAW.at(line) ** (1.0 - 0.5 * area)
    ratio = erf(small * erfinv(area)) / area
    return SurfaceOverLines(ratio, CONTACT_FRACTION_LAW.uncertainty(line) * np.sqrt(1.0 - area**2))


def friction_ratio(line: LineUnderLoad, contact_fraction: ArrayLike) -> SurfaceOverLines:
    """Return the friction ratio of a line at contact fractions of the lines [-]."""
    full = np.asarray(contact_fraction, dtype=float) ** 4
    law = np.log(FRICTION_LAW.at(line))
    ratio = np.exp((1.0 - full) * law + full * math.log(FULL_CONTACT_FRICTION))
    return SurfaceOverLines(ratio, FRICTION_LAW.uncertainty(line) + 0.0 * ratio)


# The step from lines to a surface, by the number of an answer.
SURFACE_OVER_LINES = {"contact_fraction": contact_fraction_ratio, "friction": friction_ratio}


def line_under_load(
    profile: Profile | Sequence[Profile],
    rubber: Rubber,
    *,
    largest_wavelength: float,
    pressure: float,
    speed: float,
    contact: RoughContact | None = None,
) -> LineUnderLoad:
    """Return how far lines reach up, and how hard they are pressed for their height.

    Heights, without those missing, count from the mean of pieces of sixteen largest waves [m]; the
    mean over all pieces counts. The rubber is at the temperature of the contact, under a nominal
    `pressure` [Pa] at a `speed` [m/s], relaxed at zero; where it is softened or warmed, `contact`
    is that of the line. Raises `InputError` if an argument is out of its range, or no piece has two
    different heights.
    """
    longest = checks.positive("largest_wavelength", largest_wavelength, unit="m")
    pressed = checks.positive("pressure", pressure, unit="Pa")
    number = 2.0 * math.pi / longest
    omega = number * checks.not_negative("speed", speed, unit="m/s")
    shares = np.array([EXCEEDED, *TAIL])
    pieces, rms = [], []
    for line in profile_list(profile):
        for piece in np.array_split(line.z, max(1, round(line.length / (_PIECE * longest)))):
            heights = piece[np.isfinite(piece)]
            if heights.size > 1 and heights.std() > 0.0:
                rms.append(heights.std())
                pieces.append((np.quantile(heights, 1.0 - shares) - heights.mean()) / rms[-1])
    if not pieces:
        raise InputError("profile must have two different heights at least; got none")
    upper, top, next_to_it = np.mean(pieces, axis=0).tolist()
    young, softening = rubber.complex_modulus(omega), 0.0
    if contact is not None and contact.by_scale is not None:
        young = contact.by_scale.complex_modulus(omega, number)
        softening = _further_softening(contact)
    modulus = abs(complex(plane_strain_modulus_of(young, rubber.bulk_modulus)))
    load = pressed * longest / (modulus * float(np.mean(rms)))
    return LineUnderLoad(upper, top - next_to_it, load, softening)


def _further_softening(contact: RoughContact) -> float:
    """Return ln of E' over that at twice the strain of the smallest wave; 0 without softening."""
    conditions, scales = contact.conditions, contact.scales
    if conditions is None or conditions.softening is None or scales is None:
        return 0.0
    smallest = math.log(2.0 * math.pi / contact.smallest_wavelength)
    strain = float(np.interp(smallest, np.log(scales.wavenumber), scales.strain))
    kelvin = conditions.temperature_of(contact.rubber)
    less, more = (conditions.softening.factors(e, kelvin) for e in (strain, 2.0 * strain))
    return math.log(float(less.storage) / float(more.storage))


_WAVE = 1.0 / 7.0  # wave of the modulus over the largest wave: 4 mm on the shipped road
# Mean of the logarithm and its standard deviation, over what both are proportional to; x <= 1.1.
AREA_GROWTH, AREA_SCATTER = 0.069, 0.08
FRICTION_GROWTH, FRICTION_SCATTER = -0.175, 0.16


def pressure_over_modulus(body: HalfSpace, pressure: float, largest_wavelength: float) -> float:
    """Return p_0/|E*| [-] of the rubber as it slides, under a pressure [Pa] on waves [m]."""
    number = 2.0 * math.pi / (_WAVE * largest_wavelength)
    if body.by_scale is None:
        return pressure / abs(complex(body.rubber.complex_modulus(body.speed * number)))
    return pressure / abs(complex(body.by_scale.complex_modulus(body.speed * number, number)))


def finite_over_small(
    quantity: str, pressed: ArrayLike, contact_fraction: ArrayLike
) -> tuple[Array, Array]:
    """Return the factor on "contact_fraction" or "friction", and the error of its logarithm [-].

    `pressed` is that of `pressure_over_modulus`, the contact fraction [-] that at small strain.
    """
    area = np.clip(np.asarray(contact_fraction, dtype=float), 1e-12, 1.0)
    size = pressed / np.sqrt(area)
    if quantity == "friction":
        return np.exp(FRICTION_GROWTH * size), FRICTION_SCATTER * size
    size = size * np.sqrt((1.0 - area) / area)
    return np.minimum(np.exp(AREA_GROWTH * size), 1.0 / area), AREA_SCATTER * size
