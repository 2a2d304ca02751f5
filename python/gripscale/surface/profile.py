"""A surface profile: heights at equidistant points along a line, some of them perhaps missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError

FloatArray = NDArray[np.float64]

FEWEST_POINTS = 16
"""Points a profile must have: fewer leave no lag that has both a power law and pairs to average."""

STEP_TOLERANCE = 1e-3
"""Largest departure of one step from the mean step, as a fraction of the mean step."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Heights of a surface along a straight line, at equidistant points.

    Parameters
    ----------
    x : array_like, shape (points,)
        Distance along the line [m], strictly increasing, equidistant within 0.1 % of the step.
    z : array_like, shape (points,)
        Height [m], positive upwards; NaN where the height is missing.
    name : str, optional
        What the profile is called in tables and figures.
    source : str, optional
        Where it comes from, such as a file name and a line number.

    Raises
    ------
    InputError
        If x or z is not a list of numbers, their lengths differ, there are fewer than 16 points,
        x does not increase in equal steps, no height is left, or name or source is no text.
    """

    x: FloatArray
    z: FloatArray
    name: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        x = checks.vector("x", self.x, unit="m")
        z = checks.vector("z", self.z, unit="m", missing=True)
        _check_lengths(x, z)
        _check_steps(x)
        if np.isnan(z).all():
            raise InputError(f"z must have some heights; got {z.size} points, all missing")
        for field, values in (("x", x), ("z", z)):
            values.flags.writeable = False
            object.__setattr__(self, field, values)
        for field in ("name", "source"):
            checks.text(field, getattr(self, field))

    @property
    def step(self) -> float:
        """Mean distance between neighbouring points [m]."""
        return float((self.x[-1] - self.x[0]) / (self.x.size - 1))

    @property
    def length(self) -> float:
        """Distance from the first to the last point [m]."""
        return float(self.x[-1] - self.x[0])

    @property
    def missing(self) -> int:
        """Number of points whose height is missing."""
        return int(np.isnan(self.z).sum())

    def __len__(self) -> int:
        return int(self.x.size)

    def __repr__(self) -> str:
        return (
            f"Profile({self.name or 'unnamed'}: {len(self)} points, step {self.step:.4g} m, "
            f"length {self.length:.4g} m, {self.missing} missing)"
        )


def _check_lengths(x: FloatArray, z: FloatArray) -> None:
    if x.size != z.size:
        raise InputError(f"x and z must have the same length; got {x.size} and {z.size}")
    if x.size < FEWEST_POINTS:
        raise InputError(f"a profile must have at least {FEWEST_POINTS} points; got {x.size}")


def _check_steps(x: FloatArray) -> None:
    at = uneven_step(x)
    if at is None:
        return
    if x[at + 1] <= x[at]:
        raise InputError(
            f"x must increase from point to point; got {x[at]:.9g} m at index {at} "
            f"and {x[at + 1]:.9g} m at index {at + 1}"
        )
    mean = (x[-1] - x[0]) / (x.size - 1)
    raise InputError(
        f"x must be equidistant within {STEP_TOLERANCE:g} of the mean step {mean:.6g} m; "
        f"got a step of {x[at + 1] - x[at]:.6g} m after index {at} (x = {x[at]:.9g} m)"
    )


def uneven_step(x: FloatArray) -> int | None:
    """Return the index before the first step that falls or differs from the mean, or None."""
    steps = np.diff(x)
    if (steps <= 0.0).any():
        return int(np.argmax(steps <= 0.0))
    mean = (x[-1] - x[0]) / (x.size - 1)
    departure = np.abs(steps - mean)
    # The rounding of x itself must not count: x far from zero has coarse floating-point steps.
    allowed = STEP_TOLERANCE * mean + 4.0 * np.finfo(float).eps * np.abs(x).max()
    return int(np.argmax(departure > allowed)) if (departure > allowed).any() else None
