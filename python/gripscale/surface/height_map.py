"""A surface map: heights at equidistant points along x and y, some of them perhaps missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.grid import GRID_TOLERANCE, even_grid, uneven_step
from gripscale.surface.profile import FEWEST_POINTS, Profile

FloatArray = NDArray[np.float64]


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
