"""A surface profile: heights at equidistant points along a line, some of them perhaps missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.grid import GRID_TOLERANCE, even_grid, uneven_step

FloatArray = NDArray[np.float64]

FEWEST_POINTS = 16
"""Points a profile must have: fewer leave no lag that has both a power law and pairs to average."""

MOST_POINTS = 10_000_000
"""Points beyond which no profile is made."""

CARRIED_STEPS = 4.0
"""Steps in the shortest wavelength that sampling carries: with fewer, the slope of a sine is a
tenth too small, sin(pi/n)/(pi/n) with n steps in a wavelength."""

TURNED_ROUND = "distances fell from row to row: the rows were turned round"
"""What the notes of a profile say where they did."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Heights of a surface along a straight line, at equidistant points.

    Parameters
    ----------
    x : array_like, shape (points,)
        Distance along the line [m], equidistant: no point farther than 0.05 steps from the even
        grid that fits best. Points in falling order are turned round, which `notes` then says.
    z : array_like, shape (points,)
        Height [m], positive upwards; NaN where the height is missing.
    name : str, optional
        What the profile is called in tables and figures.
    source : str, optional
        Where it comes from, such as a file name and a line number.
    reliable : float, optional
        Shortest wavelength [m] the instrument measures reliably, where it is known.
    notes : tuple of str, optional
        What was changed on the way in, such as rows added where some were left out.

    Raises
    ------
    InputError
        If x or z is not a list of numbers, their lengths differ, there are fewer than 16 points,
        x does not go in equal steps (`gripscale.surface.resample` makes them equal), no height is
        left, `reliable` is not above zero, or name, source or a note is no text.
    """

    x: FloatArray
    z: FloatArray
    name: str = ""
    source: str = ""
    reliable: float | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        x = checks.vector("x", self.x, unit="m")
        z = checks.vector("z", self.z, unit="m", missing=True)
        _check_lengths(x, z)
        if not isinstance(self.notes, tuple | list):
            raise InputError(f"notes must be a tuple of texts; got {checks.shown(self.notes)}")
        notes = tuple(checks.text("each of notes", note) for note in self.notes)
        if x[0] > x[-1]:
            x, z = x[::-1].copy(), z[::-1].copy()
            notes += (TURNED_ROUND,)
        _check_steps(x)
        if np.isnan(z).all():
            raise InputError(f"z must have some heights; got {z.size} points, all missing")
        for field, values in (("x", x), ("z", z)):
            values.flags.writeable = False
            object.__setattr__(self, field, values)
        object.__setattr__(self, "notes", notes)
        if self.reliable is not None:
            checks.positive("reliable", self.reliable, unit="m")
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
    def carried(self) -> float:
        """Shortest wavelength the measurement carries [m]: four steps, or `reliable` if longer."""
        return max(CARRIED_STEPS * self.step, self.reliable or 0.0)

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
    grid = even_grid(x)
    if grid is not None and grid.left_out == 0:
        return
    at = uneven_step(x)
    if x[at + 1] <= x[at]:
        raise InputError(
            f"x must increase from point to point; got {x[at]:.9g} m at index {at} "
            f"and {x[at + 1]:.9g} m at index {at + 1}"
        )
    raise InputError(
        f"x must be equidistant, each point within {GRID_TOLERANCE:g} steps of an even grid; "
        f"got a step of {x[at + 1] - x[at]:.6g} m after index {at} (x = {x[at]:.9g} m) where "
        f"{np.median(np.diff(x)):.6g} m is usual; gripscale.surface.resample makes steps equal"
    )
