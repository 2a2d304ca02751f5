"""A surface profile: heights at equidistant points along a line, some of them perhaps missing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError

# Are points equidistant? The even grid that fits best, and what stands off it.
#
#     x_i = a + k_i d,   k_i whole and increasing
#
# by least squares. Points off the grid by a small part of a step are on it: a slope times that part
# is what their heights are wrong by. Where k jumps, points were left out.

FloatArray = NDArray[np.float64]

GRID_TOLERANCE = 0.05
"""Largest distance of a point from the even grid that fits best, in steps.

A distance rounded to a tenth of a step is just within. Uniform departures up to it add 2 d^2/3 to
the squared distance of neighbours, 0.2 % of it.
"""

COARSEST_PRINT = 0.5
"""Largest last decimal place of printed distances, in steps, that still tells neighbours apart."""

SINGLE = 1.6
"""Length, in the shortest step, to which steps are single.

Printed ones differ by the last decimal, at most half as much again; two in one are longer still.
"""


_MOST_PLACES = 1e12
"""Steps in a gap beyond which its points stand on no grid that floating point tells."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Whole places of points on an even grid, and the largest distance from it in steps."""

    place: NDArray[np.int64]
    step: float
    departure: float

    @property
    def size(self) -> int:
        """Number of points of the grid from the first point to the last."""
        return int(self.place[-1]) + 1

    @property
    def left_out(self) -> int:
        """Number of points of the grid that are not there."""
        return self.size - self.place.size

    def spread(self, values: FloatArray) -> FloatArray:
        """Return values on all points of the grid, NaN where a point was left out."""
        every = np.full(self.size, np.nan)
        every[self.place] = values
        return every

    def points(self, x: FloatArray) -> FloatArray:
        """Return all distances of the grid between the first and the last of `x`."""
        return np.linspace(x[0], x[-1], self.size)


def even_grid(x: FloatArray, resolution: float = 0.0) -> Grid | None:
    """Return the even grid that increasing distances stand on, or None if there is none.

    Parameters
    ----------
    x : array, shape (points,)
        Distances, in any unit.
    resolution : float, optional
        Last decimal place to which they are printed, in that unit. A printed distance stands
        within half of it of the true one, and the grid through printed ones within half again.
    """
    steps = np.diff(x)
    if x.size < 2 or (steps <= 0.0).any():
        return None
    for place in (np.arange(x.size), _places(steps)):
        mean_place, mean_x = place.mean(), x.mean()
        centred = place - mean_place
        step = float(centred @ (x - mean_x) / (centred @ centred))
        departure = float(np.abs(x - mean_x - step * centred).max())
        if departure <= _allowed(x, step, resolution):
            return Grid(place, step, departure / step)
    return None


def _allowed(x: FloatArray, step: float, resolution: float) -> float:
    """Return how far a point may stand from the grid, in the unit of `x`."""
    printed = 1.01 * resolution if resolution <= COARSEST_PRINT * step else 0.0
    # The rounding of x itself must not count: x far from zero has coarse floating-point steps.
    rounding = 4.0 * float(np.finfo(float).eps * np.abs(x).max())
    return max(GRID_TOLERANCE * step, printed) + rounding


def _places(steps: FloatArray) -> NDArray[np.int64]:
    """Return the whole places of points these steps apart.

    Printed steps scatter about the true one, and only the mean of all single ones tells it well
    enough to count how many a long gap holds.
    """
    step = steps[steps <= SINGLE * steps.min()].mean()
    if steps.max() > _MOST_PLACES * step:
        return np.arange(steps.size + 1)
    whole = np.maximum(np.rint(steps / step), 1.0)
    return np.concatenate(([0], np.cumsum(whole))).astype(np.int64)


def uneven_step(x: FloatArray) -> int:
    """Return the index before the first step that falls, or else that is not the usual one."""
    steps = np.diff(x)
    usual = float(np.median(steps))
    uneven = np.abs(steps - usual) > GRID_TOLERANCE * abs(usual)
    return int(np.argmax(steps <= 0.0 if (steps <= 0.0).any() else uneven))


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
            raise InputError(f"notes must be a tuple of texts; got {checks.short_repr(self.notes)}")
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


# A surface map: heights at equidistant points along x and y, some of them perhaps missing.


@dataclass(frozen=True, eq=False)
class HeightMap:
    """Heights of a surface over a rectangle, at equidistant points each way.

    Parameters
    ----------
    x : array_like, shape (nx,)
        Distance along the way of sliding [m], strictly increasing, equidistant: no point farther
        than 0.05 steps from the even grid that fits best.
    y : array_like, shape (ny,)
        Distance across it [m], likewise; its step may differ from that of x.
    z : array_like, shape (nx, ny)
        Height [m], positive upwards; NaN where the height is missing.
    name : str, optional
        What the map is called in tables and figures.
    source : str, optional
        Where it comes from, such as a file name.
    reliable : float, optional
        Shortest wavelength [m] the instrument measures reliably, where it is known.

    Raises
    ------
    InputError
        If x, y or z are not such numbers, their shapes differ, there are fewer than 16 points a
        way, no height is left, or name or source is no text.
    """

    x: FloatArray
    y: FloatArray
    z: FloatArray
    name: str = ""
    source: str = ""
    reliable: float | None = None

    def __post_init__(self) -> None:
        x, y = _axis("x", self.x), _axis("y", self.y)
        z = _heights(self.z)
        if z.shape != (x.size, y.size):
            raise InputError(
                f"z must have shape ({x.size}, {y.size}), heights along x and then y; got {z.shape}"
            )
        if np.isnan(z).all():
            raise InputError(f"z must have some heights; got {z.size} points, all missing")
        for field, values in (("x", x), ("y", y), ("z", z)):
            values.flags.writeable = False
            object.__setattr__(self, field, values)
        if self.reliable is not None:
            checks.positive("reliable", self.reliable, unit="m")
        for field in ("name", "source"):
            checks.text(field, getattr(self, field))

    @property
    def step(self) -> tuple[float, float]:
        """Mean distance between neighbouring points along x and y [m]."""
        return _mean_step(self.x), _mean_step(self.y)

    @property
    def length(self) -> tuple[float, float]:
        """Distance from the first to the last point along x and y [m]."""
        return float(self.x[-1] - self.x[0]), float(self.y[-1] - self.y[0])

    @property
    def missing(self) -> int:
        """Number of points whose height is missing."""
        return int(np.isnan(self.z).sum())

    def lines(self, direction: str = "x") -> list[Profile]:
        """Return the lines of the map along "x" or "y" that have a height, in their order.

        Raises
        ------
        InputError
            If `direction` is another one.
        """
        checks.one_of("direction", direction, ("x", "y"))
        some = np.isfinite(self.z).any(axis=0 if direction == "x" else 1)
        return [self.line(int(number), direction) for number in np.flatnonzero(some)]

    def line(self, number: int, direction: str = "x") -> Profile:
        """Return one line along "x" or "y", counted from 0 across it.

        Raises
        ------
        InputError
            If there is no such line, or it has no height.
        """
        along_x = checks.one_of("direction", direction, ("x", "y")) == "x"
        place, heights = (self.x, self.z.T) if along_x else (self.y, self.z)
        chosen = checks.whole("number", number, least=0, most=len(heights) - 1)
        name, source = (line_label(text, chosen, direction) for text in (self.name, self.source))
        return Profile(place, heights[chosen], name, source, self.reliable)

    def turned(self) -> HeightMap:
        """Return the map turned by a quarter, for sliding along its y: x becomes y, and y is -x."""
        turned = self.z[::-1].T
        return HeightMap(self.y, -self.x[::-1], turned, self.name, self.source, self.reliable)

    def __repr__(self) -> str:
        (dx, dy), (nx, ny) = self.step, self.z.shape
        return (
            f"HeightMap({self.name or 'unnamed'}: {nx} x {ny} points, steps {dx:.4g} m and "
            f"{dy:.4g} m, {self.missing} missing)"
        )


def line_label(text: str, number: int, direction: str) -> str:
    """Return what a line of a map is called, the map being called `text`."""
    return f"{text}, line {number} along {direction}".lstrip(", ")


def _axis(name: str, values: FloatArray) -> FloatArray:
    axis = checks.vector(name, values, unit="m")
    if axis.size < FEWEST_POINTS:
        raise InputError(
            f"a map must have at least {FEWEST_POINTS} points a way; got {axis.size} along {name}"
        )
    grid = even_grid(axis)
    if grid is None or grid.left_out:
        at = uneven_step(axis)
        raise InputError(
            f"{name} must increase in equal steps, each point within {GRID_TOLERANCE:g} steps of "
            f"an even grid; got {axis[at + 1] - axis[at]:.6g} m after index {at} where "
            f"{np.median(np.diff(axis)):.6g} m is usual"
        )
    return axis


def _heights(values: FloatArray) -> FloatArray:
    expected = "z must be a table of heights [m], numbers or NaN, with two dimensions"
    z = checks.array(values, expected)
    if z.ndim != 2:
        raise InputError(f"{expected}; got {z.ndim} dimensions")
    if (np.abs(z) > checks.MOST).any():
        raise InputError(f"{expected}; got {z[np.abs(z) > checks.MOST][0]:g}")
    return z


def _mean_step(axis: FloatArray) -> float:
    return float((axis[-1] - axis[0]) / (axis.size - 1))


# Arguments that are one profile or several of the same surface.

SAME_STEP = 1e-3
"""Relative difference of steps up to which they are the same."""


def one_or_several(profile: Profile | Sequence[Profile]) -> list[Profile]:
    """Return one profile or several as a list; raise `InputError` if it is neither."""
    given: object = [profile] if isinstance(profile, Profile) else profile
    profiles = list(given) if isinstance(given, Sequence) else []
    if not profiles or not all(isinstance(one, Profile) for one in profiles):
        raise InputError(
            f"profile must be a Profile or a list of them; got {checks.short_repr(profile)}"
        )
    return profiles


def of_one_step(profile: Profile | Sequence[Profile], what: str) -> list[Profile]:
    """Return one profile or several, to be pooled or averaged as `what` says, as a list.

    Raises `InputError` if it is neither, or their steps differ.
    """
    profiles = one_or_several(profile)
    step = profiles[0].step
    for at, one in enumerate(profiles):
        if abs(one.step - step) > SAME_STEP * step:
            raise InputError(
                f"profiles must have the same step to be {what}; got {step:g} m at index 0 and "
                f"{one.step:g} m at index {at}"
            )
    return profiles
