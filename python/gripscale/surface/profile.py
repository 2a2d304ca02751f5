"""Measured surfaces: profiles along a line and maps over a rectangle, at equidistant points.

Points are equidistant if they lie near the even grid that fits them best by least squares,

    x_i = a + k_i d,   k_i whole and increasing.

A point off the grid by a small part of a step counts as on it; its height is then wrong by the
slope times that part. Points were left out where k_i increases by more than one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

import gripscale
from gripscale.core import Array, Checked, Finding, InputError, checked, checks, readable
from gripscale.core.described import Pictured, shown_value

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Largest distance of a point from the even grid that fits best, in steps. A distance rounded to a
# tenth of a step is just within. Uniform departures up to it add 2 d^2/3 to the squared distance of
# neighbours, 0.2 % of it.
GRID_TOLERANCE = 0.05
# Largest last decimal place of printed distances, in steps, that still separates neighbours.
_COARSEST_PRINT = 0.5
# Length, in the shortest step, up to which a step counts as single. Printed steps differ by the
# last decimal, at most half as much again; double steps are longer.
_SINGLE = 1.6
# Steps in a gap beyond which floating point cannot tell the grid number of its points.
_LARGEST_NUMBER = 1e12


@dataclass(frozen=True, eq=False)
class EvenGrid:
    """The numbers of points on an even grid."""

    number: NDArray[np.int64]
    step: float

    @property
    def size(self) -> int:
        """Number of points of the grid from the first point to the last."""
        return int(self.number[-1]) + 1

    @property
    def left_out(self) -> int:
        """Number of points of the grid that are missing."""
        return self.size - self.number.size

    def spread(self, values: Array) -> Array:
        """Return values on all points of the grid, NaN where a point was left out."""
        spread = np.full(self.size, np.nan)
        spread[self.number] = values
        return spread

    def points(self, x: Array) -> Array:
        """Return all distances of the grid between the first and the last of `x`."""
        return np.linspace(x[0], x[-1], self.size)


def even_grid(x: Array, resolution: float = 0.0) -> EvenGrid | None:
    """Return the even grid on which increasing distances lie, or None if there is none.

    Distances printed to a `resolution`, in their unit, lie within half of it of the true ones, and
    the grid through them within half again.
    """
    steps = np.diff(x)
    if x.size < 2 or (steps <= 0.0).any():
        return None
    # Printed steps scatter about the true one: only the mean of all single ones is accurate enough
    # to count how many steps a long gap holds.
    single = steps[steps <= _SINGLE * steps.min()].mean()
    # The rounding of x itself must not count: x far from zero has coarse floating-point steps.
    rounding = 4.0 * float(np.finfo(float).eps * np.abs(x).max())
    number = np.arange(x.size)
    for with_gaps in (False, steps.max() <= _LARGEST_NUMBER * single):
        if with_gaps:
            whole = np.maximum(np.rint(steps / single), 1.0)
            number = np.concatenate(([0], np.cumsum(whole))).astype(np.int64)
        mean_number, mean_x = number.mean(), x.mean()
        centred = number - mean_number
        step = float(centred @ (x - mean_x) / (centred @ centred))
        departure = float(np.abs(x - mean_x - step * centred).max())
        printed = 1.01 * resolution if resolution <= _COARSEST_PRINT * step else 0.0
        if departure <= max(GRID_TOLERANCE * step, printed) + rounding:
            return EvenGrid(number, step)
    return None


def uneven_step(x: Array) -> int:
    """Return the index before the first step that falls, or else before the first unusual one."""
    steps = np.diff(x)
    usual = float(np.median(steps))
    uneven = np.abs(steps - usual) > GRID_TOLERANCE * abs(usual)
    return int(np.argmax(steps <= 0.0 if (steps <= 0.0).any() else uneven))


# Points a profile must have: fewer leave no lag that has both a power law and pairs to average.
FEWEST_POINTS = 16
MOST_PROFILE_POINTS = 10_000_000  # points beyond which no profile is made
# Steps in the shortest wavelength that sampling resolves: with fewer, the slope of a sine is a
# tenth too small, sin(pi/n)/(pi/n) with n steps in a wavelength.
RESOLVED_STEPS = 4.0
LAYS = ("along", "across")  # how a profile may lie to the sliding direction
# Note of a profile whose rows were reversed.
TURNED_ROUND = "distances fell from row to row: the rows were turned round"
_T = TypeVar("_T")


def _tuple_of(name: str, value: Any, *, kind: type[_T]) -> tuple[_T, ...]:
    if not isinstance(value, tuple | list):
        raise InputError(f"{name} must be a tuple; got {checks.short_repr(value)}")
    return tuple(checks.instance(f"each of {name}", item, kind) for item in value)


class Profile(Checked, Pictured, eq=False):
    """Heights of a surface along a straight line, at equidistant points.

    Raises `InputError` if x or z is not a list of numbers, their lengths differ, there are fewer
    than 16 points, x does not go in equal steps (`gripscale.surface.resample` makes them equal),
    all heights are missing, `reliable` is not above zero, or name, source or a note is no text, or
    a doubt is no finding.

        >>> gs.Profile(np.arange(100) * 1e-4, np.sin(np.arange(100))).length
        0.0099
    """

    x: Array = checked(checks.vector, unit="m")
    """Distance along the line [m], shape (points,), equidistant: no point farther than 0.05 steps
    from the even grid that fits best. Points in falling order are reversed, and `notes` says so."""
    z: Array = checked(checks.vector, unit="m", missing=True)
    """Height [m], shape (points,), positive upwards; NaN where the height is missing."""
    name: str = checked(checks.text, default="")
    """Name of the profile in tables and figures."""
    source: str = checked(checks.text, default="")
    """Where it comes from, such as a file name and a line number."""
    reliable: float | None = checked(checks.positive, unit="m", default=None)
    """Shortest wavelength [m] the instrument measures reliably, if known."""
    notes: tuple[str, ...] = checked(_tuple_of, kind=str, default=())
    """Changes made by reading, such as rows added where some were left out."""
    doubts: tuple[Finding, ...] = checked(_tuple_of, kind=Finding, default=())
    """Why the file may mean other heights, such as a title that says depth."""
    lay: str = checked(checks.one_of, choices=LAYS, default="along")
    """Whether it lies along the sliding direction, or "across" it to show ridges."""

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.same_length(0, x=self.x, z=self.z)
        if self.x.size < FEWEST_POINTS:
            raise InputError(
                f"a profile must have at least {FEWEST_POINTS} points; got {self.x.size}"
            )
        if self.x[0] > self.x[-1]:
            x, z = self.x[::-1].copy(), self.z[::-1].copy()
            self._set(x=x, z=z, notes=(*self.notes, TURNED_ROUND))
        x, grid = self.x, even_grid(self.x)
        if grid is None or grid.left_out:
            at = uneven_step(x)
            if x[at + 1] <= x[at]:
                raise InputError(
                    f"x must increase from point to point; got {x[at]:.9g} m at index {at} "
                    f"and {x[at + 1]:.9g} m at index {at + 1}"
                )
            raise InputError(
                f"x must be equidistant, each point within {GRID_TOLERANCE:g} steps of an even "
                f"grid; got a step of {x[at + 1] - x[at]:.6g} m after index {at} "
                f"(x = {x[at]:.9g} m) where {np.median(np.diff(x)):.6g} m is usual; "
                "gripscale.surface.resample makes steps equal"
            )
        if np.isnan(self.z).all():
            raise InputError(f"z must have some heights; got {self.z.size} points, all missing")

    @property
    def step(self) -> float:
        """Mean distance between neighbouring points [m]."""
        return float((self.x[-1] - self.x[0]) / (self.x.size - 1))

    @property
    def length(self) -> float:
        """Distance from the first to the last point [m]."""
        return float(self.x[-1] - self.x[0])

    @property
    def resolution_limit(self) -> float:
        """Shortest wavelength the measurement resolves [m]: four steps, or a longer `reliable`."""
        return max(RESOLVED_STEPS * self.step, self.reliable or 0.0)

    @property
    def missing(self) -> int:
        """Number of points whose height is missing."""
        return int(np.isnan(self.z).sum())

    def plot(self, cleaned: Profile | None = None) -> Figure:
        """Draw the profile; with the `cleaned` one also what cleaning removed."""
        if cleaned is None:
            return gripscale.questions.surface_figure(self)
        return gripscale.questions.profile_figure([(self, cleaned)])

    def __len__(self) -> int:
        return int(self.x.size)

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield name, points, heights and source."""
        yield from _shown_rows(self, [("x", len(self), self.step, self.length)])


def _axis(name: str, value: ArrayLike) -> Array:
    """Return the distances of a map along one axis; raise `InputError` unless equidistant."""
    axis = checks.vector(name, value, unit="m")
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


def height_table(name: str, value: ArrayLike) -> Array:
    """Return the heights of a map; raise `InputError` unless they are a table of numbers."""
    expected = f"{name} must be a table of heights [m], numbers or NaN, with two dimensions"
    z = checks.array(value, expected)
    if z.ndim != 2:
        raise InputError(f"{expected}; got {z.ndim} dimensions")
    if (np.abs(z) > checks.MOST).any():
        raise InputError(f"{expected}; got {z[np.abs(z) > checks.MOST][0]:g}")
    if np.isnan(z).all():
        raise InputError(f"{name} must have some heights; got {z.size} points, all missing")
    return z


class HeightMap(Checked, Pictured, eq=False):
    """Heights of a surface over a rectangle, at equidistant points each way.

    Raises `InputError` if x, y or z are not such numbers, their shapes differ, there are fewer than
    16 points a way, all heights are missing, or name or source is no text, or a doubt
    is no finding.

        >>> gs.HeightMap(height_map.x, height_map.y, 2.0 * height_map.z).step
        (0.0002, 0.0002)
    """

    x: Array = checked(_axis)
    """Distance along the way of sliding [m], shape (nx,), strictly increasing, equidistant: no
    point farther than 0.05 steps from the even grid that fits best."""
    y: Array = checked(_axis)
    """Distance across it [m], shape (ny,), likewise; its step may differ from that of x."""
    z: Array = checked(height_table)
    """Height [m], shape (nx, ny), positive upwards; NaN where the height is missing."""
    name: str = checked(checks.text, default="")
    source: str = checked(checks.text, default="")
    reliable: float | None = checked(checks.positive, unit="m", default=None)
    doubts: tuple[Finding, ...] = checked(_tuple_of, kind=Finding, default=())
    """As those of a `Profile`."""

    def __post_init__(self) -> None:
        super().__post_init__()
        shape = (self.x.size, self.y.size)
        if self.z.shape != shape:
            raise InputError(
                f"z must have shape {shape}, heights along x and then y; got {self.z.shape}"
            )

    @property
    def step(self) -> tuple[float, float]:
        """Mean distance between neighbouring points along x and y [m]."""
        along, across = self.length
        return along / (self.x.size - 1), across / (self.y.size - 1)

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

        Raises `InputError` if `direction` is neither.
        """
        checks.one_of("direction", direction, ("x", "y"))
        measured = np.isfinite(self.z).any(axis=0 if direction == "x" else 1)
        numbers = np.flatnonzero(measured).tolist()
        first = self.line(numbers[0], direction)
        heights = self.z.T if direction == "x" else self.z
        lines = []
        for number in numbers:  # the first one was checked, and with it all others
            line = copy(first)
            name, source = (line_label(t, number, direction) for t in (self.name, self.source))
            line._set(z=heights[number].copy(), name=name, source=source)
            lines.append(line)
        return lines

    def line(self, number: int, direction: str = "x") -> Profile:
        """Return one line along "x" or "y", counted from 0 across it.

        Raises `InputError` if there is no such line, or it has no height.
        """
        along_x = checks.one_of("direction", direction, ("x", "y")) == "x"
        axis, heights = (self.x, self.z.T) if along_x else (self.y, self.z)
        row = checks.whole("number", number, least=0, most=len(heights) - 1)
        name, source = (line_label(text, row, direction) for text in (self.name, self.source))
        return Profile(axis, heights[row], name, source, self.reliable, doubts=self.doubts)

    def turned(self) -> HeightMap:
        """Return the map turned by a quarter, for sliding along its y: x becomes y, and y is -x."""
        heights = self.z[::-1].T
        return replace(self, x=self.y, y=-self.x[::-1], z=heights)

    def plot(self) -> Figure:
        """Draw the heights from above; the rubber slides along x."""
        return gripscale.questions.surface_figure(self)

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield name, points, heights and source."""
        axes = zip(("x", "y"), self.z.shape, self.step, self.length, strict=True)
        yield from _shown_rows(self, axes)


def _shown_rows(
    surface: Profile | HeightMap, axes: Iterable[tuple[str, int, float, float]]
) -> Iterator[tuple[str, str]]:
    yield "name", surface.name or "unnamed"
    for axis, count, step, length in axes:
        words = f"step {readable(step, 'm')}, length {readable(length, 'm')}"
        yield axis, f"{count} points, {words}"
    spread = readable(float(np.nanstd(surface.z)), "m")
    yield "z", f"{shown_value(surface.z, 'm')}, rms {spread}, {surface.missing} missing"
    if surface.reliable is not None:
        yield "reliable", readable(surface.reliable, "m")
    if surface.source:
        yield "source", surface.source


def line_label(text: str, number: int, direction: str) -> str:
    """Return the name or source of a line of a map, `text` being that of the map."""
    return f"{text}, line {number} along {direction}".lstrip(", ")


_SAME_STEP = 1e-3  # relative difference of steps up to which they are the same


def profile_list(profile: Profile | Sequence[Profile]) -> list[Profile]:
    """Return one profile or several as a list; raise `InputError` if it is neither."""
    profiles = [profile] if isinstance(profile, Profile) else profile
    listed = list(profiles) if isinstance(profiles, Sequence) else []
    if not listed or not all(isinstance(item, Profile) for item in listed):
        raise InputError(
            f"profile must be a Profile or a list of them; got {checks.short_repr(profile)}"
        )
    return listed


def of_one_step(profile: Profile | Sequence[Profile], purpose: str) -> list[Profile]:
    """Return one profile or several of the same step as a list.

    Raises `InputError` if it is neither, or their steps differ; its message gives the `purpose`,
    such as "pooled".
    """
    profiles = profile_list(profile)
    step = profiles[0].step
    for at, other in enumerate(profiles):
        if abs(other.step - step) > _SAME_STEP * step:
            raise InputError(
                f"profiles must have the same step to be {purpose}; got {step:g} m at index 0 and "
                f"{other.step:g} m at index {at}"
            )
    return profiles
