"""From measured lines to the isotropic surface they lie on: a law measured on synthetic surfaces.

A line is solved in plane strain, as if the surface were grooves across the sliding direction. On an
isotropic surface rubber escapes sideways, and high places beside the line carry load in its place.
On maps of eight families (`python -m studies.line_to_map`) the contact of the map over that of its
lines follows how far the heights of a line reach up:

    ln f = a_0 + a_1 t,    ln g = b_0 + b_1 t,
    t = (height that 1 % of a line exceeds - mean height) / rms height,

f for small areas A of contact, g for friction. Towards full contact the areas meet and the friction
of the map is 1.11 times that of its lines, whatever the heights:

    A_map = erf(f^(1 - A/2) erfinv(A)),    ln(mu_map / mu) = (1 - A^4) ln g + A^4 ln 1.11.

Rubber, speed, cut-off and pressure change the ratios by less than their scatter from map to map:
20 m/s in place of 0.3 m/s by 3 and 4 %, 1 bar in place of 3 bar by 10 and 9 %.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.surface import Profile, Surface
from gripscale.surface.profile import profile_list

_PIECE = 16.0
"""Length of the lines the law was measured on, in largest waves; longer waves count as a slope."""
_TINY = 1e-12
EXCEEDED = 0.01
"""Share of a line that is higher than its upper height."""


class RatioLaw(NamedTuple):
    """A ratio ln y = constant + slope t, and how well it is known."""

    constant: float
    slope: float
    scatter: float
    """Standard deviation of ln y about the law, over maps of all families."""

    def at(self, upper_height: float) -> float:
        """Return the ratio at an upper height t."""
        return float(np.exp(self.constant + self.slope * upper_height))


CONTACT_FRACTION_LAW = RatioLaw(-0.031, -0.195, 0.12)
FRICTION_LAW = RatioLaw(-0.385, 0.179, 0.11)
"""Scatter: between that about the law (0.110, 0.098) and that of families which a law of the other
families misses (0.132, 0.122)."""
FULL_CONTACT_FRICTION = 1.11
FREEDOM = 6
"""Degrees of freedom of the scatter: eight families less the two numbers of the law."""


LOAD_SENSITIVITY = 0.09
"""Change of the logarithm of both ratios for an e-fold of the load: a third of the pressure changes
them by 10 and 9 %."""


class SurfaceOverLines(NamedTuple):
    """Ratio of a number of an isotropic surface to that of its lines, and its standard error."""

    ratio: Array
    uncertainty: Array
    """Of the logarithm [-]."""


def contact_fraction_ratio(upper_height: float, contact_fraction: ArrayLike) -> SurfaceOverLines:
    """Return the area ratio at an upper height t and contact fractions of the lines [-]."""
    from scipy.special import erf, erfinv

    area = np.clip(np.asarray(contact_fraction, dtype=float), _TINY, 1.0 - _TINY)
    small = CONTACT_FRACTION_LAW.at(upper_height) ** (1.0 - 0.5 * area)
    ratio = erf(small * erfinv(area)) / area
    return SurfaceOverLines(ratio, CONTACT_FRACTION_LAW.scatter * np.sqrt(1.0 - area**2))


def friction_ratio(upper_height: float, contact_fraction: ArrayLike) -> SurfaceOverLines:
    """Return the friction ratio at an upper height t and contact fractions of the lines [-]."""
    full = np.asarray(contact_fraction, dtype=float) ** 4
    law = math.log(FRICTION_LAW.at(upper_height))
    ratio = np.exp((1.0 - full) * law + full * math.log(FULL_CONTACT_FRICTION))
    return SurfaceOverLines(ratio, np.full_like(ratio, FRICTION_LAW.scatter))


def upper_height(profile: Profile | Sequence[Profile], largest_wavelength: float) -> float:
    """Return how far a line reaches up: the height 1 % of it exceeds over the rms height.

    Both are from the mean of pieces of sixteen largest waves, or of the whole line where it is
    shorter; the mean over all pieces counts. Missing heights are left out.
    Raises `InputError` if an argument is out of its range, or no piece has two heights.
    """
    longest = _PIECE * checks.positive("largest_wavelength", largest_wavelength, unit="m")
    ratios = []
    for line in profile_list(profile):
        for piece in np.array_split(line.z, max(1, round(line.length / longest))):
            heights = piece[np.isfinite(piece)]
            if heights.size > 1 and heights.std() > 0.0:
                top = np.quantile(heights, 1.0 - EXCEEDED) - heights.mean()
                ratios.append(top / heights.std())
    if not ratios:
        raise InputError("profile must have two different heights at least; got none")
    return float(np.mean(ratios))


def upper_height_of(surface: Surface) -> float | None:
    """Return the upper height of the measured lines of a surface; None without lines, of a map."""
    measured = surface.measured
    if measured is None or measured.map is not None:
        return None
    return upper_height(list(measured.cleaned), float(surface.sines.wavelength[0]))
