"""From measured lines to the isotropic surface they lie on: a law measured on synthetic surfaces.

A line is solved in plane strain, as if the surface were grooves across the sliding direction. On an
isotropic surface rubber escapes sideways, and high places beside the line carry load in its place.
On maps of eight families (`python -m studies.line_to_map`) the contact of the map over that of its
lines follows how far the heights of a line reach up:

    ln(A_map / A_line) = a_0 + a_1 t,    ln(mu_map / mu_line) = b_0 + b_1 t,
    t = (height that 1 % of a line exceeds - mean height) / rms height.

Rubber, speed, pressure and cut-off change the ratios by less than their scatter from map to map.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.surface import Profile
from gripscale.surface.profile import profile_list

PIECE = 16.0
"""Length of the lines the law was measured on, in largest waves; longer waves count as a slope."""
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


CONTACT_FRACTION = RatioLaw(-0.075, -0.185, 0.09)
FRICTION = RatioLaw(-0.295, 0.171, 0.10)
FREEDOM = 6
"""Degrees of freedom of the scatter: eight families less the two numbers of the law."""
MEASURED_BETWEEN = (1.0, 4.0)
"""Upper heights of the families."""


def upper_height(profile: Profile | Sequence[Profile], largest_wavelength: float) -> float:
    """Return how far a line reaches up: the height 1 % of it exceeds over the rms height.

    Both are from the mean of pieces of sixteen largest waves, or of the whole line where it is
    shorter; the mean over all pieces counts. Missing heights are left out.

    Raises `InputError` if an argument is out of its range, or no piece has two heights.

    Parameters
    ----------
    profile : Profile or sequence of Profile
        Cleaned profiles of one surface.
    largest_wavelength : float
        Largest wave that counts as roughness [m].
    """
    longest = PIECE * checks.positive("largest_wavelength", largest_wavelength, unit="m")
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
