"""Heights at unequal steps, put on equal ones by straight lines between neighbours.

    z(x) = z_i + (z_(i+1) - z_i) (x - x_i) / (x_(i+1) - x_i),   x_i <= x <= x_(i+1)

Its error is at most h^2 max|z''| / 8 over a distance h of neighbours (C. de Boor, A Practical Guide
to Splines (1978), ch. III): of a sine of wavelength L, 5 (h/L)^2 of its amplitude.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.profile import (
    CARRIED_STEPS,
    FEWEST_POINTS,
    MOST_POINTS,
    TURNED_ROUND,
    FloatArray,
    Profile,
)

LONGEST_BRIDGE = 2.0
"""Longest distance of neighbours that is bridged by default, in usual distances or new steps."""


def resample(
    x: ArrayLike,
    z: ArrayLike,
    step: float,
    *,
    bridge: float | None = None,
    name: str = "",
    source: str = "",
) -> Profile:
    """Return a profile with equal steps from heights at unequal ones.

    Heights are taken between neighbours, not averaged: with a step longer than those measured,
    roughness shorter than two new steps is folded into longer wavelengths.

    Parameters
    ----------
    x : array_like, shape (points,)
        Distance along the line [m], rising throughout or falling throughout.
    z : array_like, shape (points,)
        Height [m]; NaN where it is missing.
    step : float
        Distance of neighbours in the profile [m].
    bridge : float, optional
        Longest distance of neighbours to draw a line over [m]; over a longer one heights are
        missing. Twice the step or twice the median distance by default, whichever is longer.
    name, source : str, optional
        As those of a profile.

    Returns
    -------
    Profile
        From the first distance on, missing where a height is missing on either side. Its
        shortest reliable wavelength is four of the usual distances, if those are the longer ones.

    Raises
    ------
    InputError
        If x or z is not a list of numbers, their lengths differ, x neither rises nor falls
        throughout, `step` or `bridge` is not above zero, or the step gives too few or too many
        points.
    """
    place, height = _rising(x, z)
    even = checks.positive("step", step, unit="m")
    points = int(np.floor((place[-1] - place[0]) / even * (1.0 + 1e-12))) + 1
    if not FEWEST_POINTS <= points <= MOST_POINTS:
        raise InputError(
            f"step must give {FEWEST_POINTS} to {MOST_POINTS} points over "
            f"{place[-1] - place[0]:g} m; {even:g} m gives {points}"
        )
    usual = float(np.median(np.diff(place)))
    longest = LONGEST_BRIDGE * max(usual, even)
    if bridge is not None:
        longest = checks.positive("bridge", bridge, unit="m")
    new = place[0] + even * np.arange(points)
    notes = [
        f"put on steps of {even * 1e3:.4g} mm by straight lines; {usual * 1e3:.4g} mm were usual"
    ]
    if np.asarray(x, dtype=float)[0] > place[0]:
        notes.insert(0, TURNED_ROUND)
    return Profile(
        new,
        _between(place, height, new, longest),
        name,
        source,
        reliable=CARRIED_STEPS * max(usual, even),
        notes=tuple(notes),
    )


def _rising(x: ArrayLike, z: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return distances in rising order and their heights."""
    place = checks.vector("x", x, unit="m")
    height = checks.vector("z", z, unit="m", missing=True)
    if place.size != height.size or place.size < FEWEST_POINTS:
        raise InputError(
            f"x and z must have the same length, at least {FEWEST_POINTS}; "
            f"got {place.size} and {height.size}"
        )
    if place[0] > place[-1]:
        place, height = place[::-1], height[::-1]
    steps = np.diff(place)
    if (steps <= 0.0).any():
        at = int(np.argmax(steps <= 0.0))
        raise InputError(
            f"x must rise or fall from point to point throughout; got {place[at]:.9g} m and "
            f"{place[at + 1]:.9g} m side by side"
        )
    return place, height


def _between(place: FloatArray, height: FloatArray, new: FloatArray, longest: float) -> FloatArray:
    """Return heights on the lines between neighbours at most `longest` apart, NaN elsewhere."""
    left = np.clip(np.searchsorted(place, new, side="right") - 1, 0, place.size - 2)
    share = (new - place[left]) / (place[left + 1] - place[left])
    # on a measured point its height alone counts, or a missing neighbour would take it away
    share = np.clip(share, 0.0, 1.0)
    one, other = height[left], height[left + 1]
    z = np.where(share == 0.0, one, np.where(share == 1.0, other, one + share * (other - one)))
    apart = place[left + 1] - place[left] > longest * (1.0 + 1e-9)
    return np.where(apart & (share > 0.0) & (share < 1.0), np.nan, z)
