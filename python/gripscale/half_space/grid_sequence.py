"""Contact on a sequence of grids, from coarse ones with few waves to fine ones with all of them.

A grid has four points in the shortest wave on it; the next has half the spacing and waves half as
long. The shortest waves already enter on the grid before the last, with two points each, so that
two grids solve the same surface and show the effect of the spacing. Finer grids follow if needed.
docs/derivations.md has the start of a grid, the two frictions, the contact fraction between points,
and how the errors are estimated.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
import scipy

from gripscale.core import Array, ComplexArray, Described, Mask
from gripscale.half_space.active_set import CONTACT_ACCURACY, Accuracy, solve_grid
from gripscale.half_space.grid import Grid, PeriodicHeights, doubled, nearest, resampled
from gripscale.half_space.response import HalfSpace, Response
from gripscale.theory.half_plane import GridContact

POINTS_IN_WAVE = 4
COARSEST = {1: 128, 2: 32}  # fewest points along each axis, on lines and maps
# Fractions of the loss angle, solved in turn if the full angle does not settle.
LOSSES = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0)
ERROR_GRIDS = 3  # grids of the same surface from which the errors of the last one are estimated
_BORDER = (np.pi - 1.0 + np.log(2.0)) / 24.0
# Uncertainty of the position of a border, on lines and maps [steps].
_BORDER_ERROR = {1: 0.5, 2: 0.7}
_ERROR_RATIO = 0.4  # c, the error after halving the spacing over the change by it
_OPENING = 0.3  # s, over the stiffness of the stiffest wave


def friction_from_traction(grid: Grid, pressure: Array, height: Array) -> float:
    """Return the friction coefficient [-] of a pressure [Pa] on heights [m]."""
    product = grid.slope(height)
    product *= pressure
    return float(product.mean(dtype=np.float64) / pressure.mean(dtype=np.float64))


def lost_by_harmonic(compliance: ComplexArray, grid: Grid, pressure: Array) -> Array:
    """Return the friction coefficient each harmonic adds [-], over the spectrum of `grid`."""
    spectrum = scipy.fft.rfftn(pressure)
    lost = np.empty(grid.spectrum_shape, dtype=grid.real)
    for rows, waves in grid.parts():
        share = np.abs(spectrum[rows] / grid.points) ** 2
        lost[rows] = -waves.along * compliance[rows].imag * share * grid.weight
    lost /= pressure.mean(dtype=np.float64)
    return lost


def grid_contact_fraction(active: Mask, gap: Array, loss_angle: float = 0.0) -> float:
    """Return real over nominal contact area of a periodic line or map [-].

    A line takes the `loss_angle` [rad] of the shortest waves, positive in a slide towards +x.
    """
    if active.ndim == 2:
        border = sum(int((active != np.roll(active, 1, axis=axis)).sum()) for axis in (0, 1))
        return float((active.sum() - _BORDER * border) / active.size)
    points, total = active.size, float(active.sum())
    for side in (-1, 1):
        opening = 1.5 + max(0.0, side * loss_angle) * 2.0 / np.pi
        last = np.flatnonzero(active & ~np.roll(active, -side))
        near, far = (last + side) % points, (last + 2 * side) % points
        inner = np.maximum(gap[near], 0.0) ** (1.0 / opening)
        growth = np.maximum(gap[far], 0.0) ** (1.0 / opening) - inner
        # without two open points, or a gap that grows, the border is taken half way
        smooth = ~active[far] & (growth > 0.0)
        end = np.clip(1.0 - inner / np.where(smooth, growth, 1.0), 0.0, 1.0)
        total += float((np.where(smooth, end, 0.5) - 0.5).sum())
    return total / points


def border_error(active: Mask) -> float:
    """Return the error of the contact fraction from borders that lie between points [-]."""
    squares = 0
    for axis in range(active.ndim):
        border = np.moveaxis(active != np.roll(active, 1, axis=axis), axis, 0)
        if active.ndim == 1:
            squares += int(border.sum())
        else:  # squared lengths of the stretches along the other axis
            closed = np.pad(border, ((0, 0), (1, 1))).astype(np.int8).reshape(-1)
            ends = np.flatnonzero(np.diff(closed))
            squares += int(((ends[1::2] - ends[::2]) ** 2).sum())
    return float(_BORDER_ERROR[active.ndim] * np.sqrt(squares) / active.size)


def errors(same_surface: Sequence[GridRecord]) -> tuple[float, float]:
    """Return the errors of area and friction [-] of the last grid; NaN of one, zero if full."""
    last = same_surface[-1]
    if last.full:
        return 0.0, 0.0
    if len(same_surface) == 1:
        return math.nan, math.nan

    def error(name: str) -> float:
        changes = [getattr(b, name) - getattr(a, name) for a, b in pairwise(same_surface)]
        newest_first = enumerate(reversed(changes[1 - ERROR_GRIDS :]), start=1)
        return float(max(_ERROR_RATIO**age * abs(change) for age, change in newest_first))

    area, traction = error("contact_fraction"), error("friction")
    dissipation, before = error("friction_from_dissipation"), same_surface[-2]
    # of a map the share of new borders is zero: `border_error` times the points falls there
    borders = [(grid.border_error * grid.points) ** 2 for grid in (before, last)]
    new = max(0.0, 1.0 - borders[0] / borders[1]) if borders[1] > 0.0 else 0.0
    area += new * abs(last.contact_fraction - before.contact_fraction)
    difference = abs(last.friction - last.friction_from_dissipation)
    return math.hypot(area, last.border_error), max(traction, difference + dissipation)


@dataclass(frozen=True)
class Level:
    """A grid, and the shortest wave on it [m]."""

    grid: Grid
    cut_off: float


@dataclass(frozen=True, repr=False)
class GridRecord(Described):
    """Numbers of one grid."""

    points: int
    """Along x."""
    cut_off: float
    """Shortest wave of the surface on it [m]."""
    contact_fraction: float
    border_error: float
    """Of the contact fraction, because borders lie between points [-]."""
    friction: float
    """From the contact traction."""
    friction_from_dissipation: float
    iterations: int
    products: int
    settled: bool
    full: bool
    in_contact: int
    """Points in contact."""


@dataclass(frozen=True)
class LevelContact:
    """The contact on one level."""

    level: Level
    height: Array  # [m], of zero mean
    contact: GridContact
    record: GridRecord


def levels(heights: PeriodicHeights) -> list[Level]:
    """Return the levels from the coarsest to four points in the smallest wave."""
    least, lengths = COARSEST[len(heights.grid.shape)], heights.grid.lengths
    fine = [
        max(least, math.ceil(POINTS_IN_WAVE * length / heights.smallest_wavelength - 1e-6))
        for length in lengths
    ]
    halvings = int(math.log2(min(fine) / least))
    coarse = [scipy.fft.next_fast_len(math.ceil(n / 2**halvings), real=True) for n in fine]
    out = []
    for step in range(halvings + 1):
        grid = Grid(tuple(n * 2**step for n in coarse), lengths)
        out.append(Level(grid, heights.smallest_wavelength * 2 ** (halvings - step)))
    if halvings:
        out.insert(-1, replace(out[-2], cut_off=heights.smallest_wavelength))
    return out


def finer(level: Level) -> Level:
    """Return the level with half the spacing and no new waves."""
    return replace(level, grid=Grid(tuple(2 * n for n in level.grid.shape), level.grid.lengths))


KnownLevels = Mapping[Level, LevelContact]


@dataclass
class GridSequence:
    """Solves level after level, each from the contact of the last."""

    body: HalfSpace
    heights: PeriodicHeights
    pressure: float
    workers: int
    start: KnownLevels = field(default_factory=dict)  # contacts with another rubber, to start from
    for_next: bool = True  # whether all contacts stay in `solved`, for the next rubber
    solved: dict[Level, LevelContact] = field(default_factory=dict)
    # Contact on other heights of the same lengths, that the first level starts from.
    other: LevelContact | None = None
    last: LevelContact | None = None
    # When solving ends with `OutOfTime`, on the clock of `time.monotonic` [s].
    deadline: float = math.inf

    def solve(self, level: Level, accuracy: Accuracy = CONTACT_ACCURACY) -> LevelContact:
        """Return the contact on `level`, from its contact in `start` or the level before."""
        self.last = self.start.get(level, self.last or self.other)
        height = self.heights.on(level.grid.shape, level.cut_off, self.workers)
        response = Response.of(self.body, level.grid, self.workers, self.deadline)
        contact = self._full(response, height)
        full = contact is not None
        if contact is None:
            # no name for the start: the solver frees it early
            contact = solve_grid(response, height, self._start(response, height), accuracy)
            if not contact.settled and np.iscomplex(response.compliance).any():
                contact = self._through_losses(response, height, contact)
        lost = lost_by_harmonic(response.compliance, level.grid, contact.pressure)
        record = GridRecord(
            points=level.grid.shape[0],
            cut_off=level.cut_off,
            contact_fraction=grid_contact_fraction(
                contact.active, contact.gap, response.loss_angle
            ),
            border_error=border_error(contact.active),
            friction=friction_from_traction(level.grid, contact.pressure, height),
            friction_from_dissipation=float(lost.sum(dtype=np.float64)),
            iterations=contact.iterations,
            products=contact.products,
            settled=contact.settled,
            full=full,
            in_contact=int(contact.active.sum()),
        )
        self.last = LevelContact(level, height, contact, record)
        if self.for_next:
            self.solved[level] = self.last
        return self.last

    def _full(self, response: Response, height: Array) -> GridContact | None:
        """Return the contact without a gap, if it has no tension."""
        pressure = response.full_contact(height, self.pressure)
        if pressure.min() < 0.0:
            return None
        everywhere = np.ones(height.shape, dtype=bool)
        gap = np.zeros(height.shape, dtype=height.dtype)
        return GridContact(pressure, gap, everywhere, 0, settled=True, products=1)

    def _through_losses(
        self, response: Response, height: Array, contact: GridContact
    ) -> GridContact:
        """Return the contact, reached by raising the loss angle from that of `contact` in steps."""
        start = self._start(response, height)
        for loss in LOSSES:
            part = response
            if loss != 1.0:
                body = replace(self.body, loss=loss)
                part = Response.of(body, response.grid, self.workers, self.deadline)
            step = solve_grid(part, height, start)
            contact = replace(
                step,
                iterations=contact.iterations + step.iterations,
                products=contact.products + step.products,
            )
            start = loaded(np.where(contact.active, contact.pressure, 0.0), self.pressure)
        return contact

    def _start(self, response: Response, height: Array) -> Array:
        """Return the start p + S dh - s g from the last contact, under the load; at first S h."""
        if self.last is None:
            return loaded(response.full_contact(height, self.pressure), self.pressure)
        last, shape = self.last, height.shape
        twice = shape == tuple(2 * points for points in last.height.shape)

        def here(values: Array) -> Array:
            values = values.astype(height.dtype, copy=False)
            return doubled(values) if twice else nearest(values, shape)

        opening = np.maximum(here(last.contact.gap), 0.0)
        opening *= _OPENING / response.smallest_compliance
        expected = here(last.contact.pressure) - opening
        del opening
        # not the heights of the last grid, doubled: S would press their kinks flat
        if last is self.other:
            spectrum = scipy.fft.rfftn(last.height)
            before = resampled(spectrum, last.height.shape, response.grid)
        else:
            before = self.heights.on(shape, last.level.cut_off, self.workers)
        np.subtract(height, before, out=before)
        if before.any():
            expected += response.pressure(before)
        return loaded(expected, self.pressure)


def loaded(pressure: Array, load: float) -> Array:
    """Return `pressure` without tension, scaled to a load [Pa]; uniform if nothing is left."""
    positive = np.maximum(pressure, 0.0)
    mean = positive.mean(dtype=np.float64)
    if mean == 0.0:
        return np.full(pressure.shape, load, dtype=pressure.dtype)
    positive *= load / mean
    return positive
