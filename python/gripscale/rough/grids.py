"""From coarse grids with few waves to fine grids with all of them, each starting from the last.

A grid has four points in the shortest wave it is given; the next has half the spacing and waves
half as long. The last waves come in on the grid before their own already, with two points each, so
that two grids solve the same surface and show what the spacing does. Finer grids follow if needed.

A grid starts from the pressure p and gap g of the last, with the new roughness dh pressed flat:
p + S dh - s g, S being the inverse of the half-space's response and s a stiffness of the order of
its stiffest wave.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.fft

from gripscale.rough.active_set import TOLERANCE, GridContact, solve_grid
from gripscale.rough.area import border_error, contact_fraction
from gripscale.rough.grid import Array, Grid, doubled
from gripscale.rough.half_space import HalfSpace, Response
from gripscale.rough.heights import PeriodicHeights
from gripscale.rough.outcome import friction_from_traction, lost_by_harmonic

POINTS_IN_WAVE = 4
COARSEST = {1: 128, 2: 32}
"""Fewest points a way, on lines and maps."""
LOSSES = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0)
"""Shares of the loss angle stepped through where the rubber's own does not settle."""
_OPENING = 0.3


@dataclass(frozen=True)
class Level:
    """A grid, and the shortest wave on it [m]."""

    grid: Grid
    cut_off: float

    @property
    def key(self) -> LevelKey:
        """What makes it another level of the same surface: points and shortest wave."""
        return (self.grid.shape, self.cut_off)


LevelKey = tuple[tuple[int, ...], float]


@dataclass(frozen=True)
class GridRecord:
    """Numbers of one grid."""

    points: int
    """Along x."""
    cut_off: float
    """Shortest wave of the surface on it [m]."""
    contact_fraction: float
    border_error: float
    """Of the contact fraction: where borders lie between points [-]."""
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
    """What was found on one level."""

    level: Level
    height: Array
    """[m], of zero mean."""
    contact: GridContact
    record: GridRecord


def levels(heights: PeriodicHeights) -> list[Level]:
    """Return the levels down to four points in the smallest wave."""
    least, lengths = COARSEST[len(heights.grid.shape)], heights.grid.lengths
    fine = [
        max(least, math.ceil(POINTS_IN_WAVE * length / heights.smallest_wavelength - 1e-6))
        for length in lengths
    ]
    halvings = int(math.log2(min(fine) / least))
    coarse = [scipy.fft.next_fast_len(math.ceil(n / 2**halvings), real=True) for n in fine]
    ladder = []
    for step in range(halvings + 1):
        grid = Grid(tuple(n * 2**step for n in coarse), lengths)
        ladder.append(Level(grid, heights.smallest_wavelength * 2 ** (halvings - step)))
    if halvings:
        ladder.insert(-1, replace(ladder[-2], cut_off=heights.smallest_wavelength))
    return ladder


def finer(level: Level) -> Level:
    """Return the level with half the spacing and no new waves."""
    return replace(level, grid=Grid(tuple(2 * n for n in level.grid.shape), level.grid.lengths))


KnownLevels = Mapping[LevelKey, LevelContact]


@dataclass
class Climb:
    """Solves level after level; keeps what the next one starts from."""

    body: HalfSpace
    heights: PeriodicHeights
    pressure: float
    workers: int
    most_iterations: int
    known: KnownLevels = field(default_factory=dict)
    """Contacts of another rubber, to start from."""
    solved: dict[LevelKey, LevelContact] = field(default_factory=dict)
    last: LevelContact | None = None

    def solve(self, level: Level, tolerance: float = TOLERANCE) -> LevelContact:
        """Return the contact on `level`, started from what is known of it or the level before.

        `tolerance` is the pressure that may be missing, over the pressure.
        """
        self.last = self.known.get(level.key, self.last)
        height = self.heights.on(level.grid.shape, level.cut_off)
        response = Response.of(self.body, level.grid, self.workers)
        whole = response.full_contact(height, self.pressure)
        full = bool(whole.min() >= 0.0)
        contact = _filled(whole) if full else self._touching(response, height, whole, tolerance)
        lost = float(lost_by_harmonic(response.compliance, level.grid, contact.pressure).sum())
        record = self._record(level, height, contact, lost, full)
        self.last = LevelContact(level, height, contact, record)
        self.solved[level.key] = self.last
        return self.last

    def _record(
        self, level: Level, height: Array, contact: GridContact, lost: float, full: bool
    ) -> GridRecord:
        return GridRecord(
            level.grid.shape[0],
            level.cut_off,
            contact_fraction(contact.active, contact.gap),
            border_error(contact.active),
            friction_from_traction(level.grid, contact.pressure, height),
            lost,
            contact.iterations,
            contact.products,
            contact.settled,
            full,
            int(contact.active.sum()),
        )

    def _touching(
        self, response: Response, height: Array, whole: Array, tolerance: float
    ) -> GridContact:
        start = self._loaded(whole if self.last is None else self._expected(response, height))
        contact = solve_grid(response, height, start, self.most_iterations, tolerance)
        if contact.settled or not np.iscomplex(response.compliance).any():
            return contact
        return self._through_losses(response, height, start)

    def _through_losses(self, response: Response, height: Array, start: Array) -> GridContact:
        for loss in LOSSES:
            body = replace(self.body, loss=loss)
            part = response if loss == 1.0 else Response.of(body, response.grid, self.workers)
            contact = solve_grid(part, height, start, self.most_iterations)
            start = self._loaded(np.where(contact.active, contact.pressure, 0.0))
        return contact

    def _expected(self, response: Response, height: Array) -> Array:
        assert self.last is not None
        carried = [self.last.contact.pressure, self.last.contact.gap, self.last.height]
        if self.last.height.shape != height.shape:
            carried = [doubled(values) for values in carried]
        pressure, gap, before = carried
        opening = _OPENING / response.smallest_compliance * np.maximum(gap, 0.0)
        return np.asarray(pressure - opening + response.pressure(height - before))

    def _loaded(self, pressure: Array) -> Array:
        """Return `pressure` without tension, scaled to the load; even if there is none."""
        positive = np.maximum(pressure, 0.0)
        mean = positive.mean()
        if mean == 0.0:
            return np.full(pressure.shape, self.pressure)
        return np.asarray(positive * (self.pressure / mean))


def _filled(pressure: Array) -> GridContact:
    everywhere = np.ones(pressure.shape, dtype=bool)
    return GridContact(pressure, np.zeros(pressure.shape), everywhere, 0, 1, 0.0, True)
