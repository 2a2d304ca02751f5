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
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
import scipy.fft

from gripscale.half_space.active_set import TOLERANCE, GridContact, solve_grid
from gripscale.half_space.grid import Array, Grid, Mask, PeriodicHeights, doubled
from gripscale.half_space.response import ComplexArray, HalfSpace, Response

# What a contact tells: friction in two ways, friction by wavelength, where the surface is touched.
#
#     mu = mean(p dh/dx) / p_0                                       from the contact traction
#     mu = sum_q q_x |p(q)|^2 2 Im M(q_x v) / (|q| |M|^2) / p_0       from the energy lost
#
# with p(q) the Fourier coefficients of the pressure. The second is the work that every harmonic of
# the pressure loses per sliding distance, so that its sum may be split by wavelength exactly.


def friction_from_traction(grid: Grid, pressure: Array, height: Array) -> float:
    """Return the friction coefficient [-] of a pressure [Pa] on heights [m]."""
    return float(np.mean(pressure * grid.slope(height)) / pressure.mean())


def lost_by_harmonic(compliance: ComplexArray, grid: Grid, pressure: Array) -> Array:
    """Return the friction coefficient each harmonic adds [-], over the spectrum of `grid`."""
    share = np.abs(scipy.fft.rfftn(pressure) / grid.points) ** 2
    lost = -grid.along * compliance.imag * share * grid.weight
    return np.asarray(lost / pressure.mean())


# Real contact area from the points in contact, corrected for the grid.
#
# Line: a contact ends between its last closed and the first open point. Near the end of a smooth
# contact the gap grows as (distance)^(3/2), so gap^(2/3) at the two nearest open points
# extrapolates to zero there, as in `gripscale.theory.half_plane`.
#
# Map: counted points overestimate the area by a share of the border. With n_s the number of
# neighbouring pairs of points of which one is in contact and one is not,
#
#     A/A_0 = (points in contact - (pi - 1 + ln 2)/24 n_s) / points
#
# V. A. Yastrebov, G. Anciaux & J.-F. Molinari, Tribol. Int. 114 (2017) 161,
# doi:10.1016/j.triboint.2017.04.023.
#
# Either way every border is only known to a part of a step, here 0.5 on a line and 0.7 on a map
# (two straight borders may both be half a step out), and the points of one straight stretch of
# border err together: with m their numbers in each stretch, the error of the fraction is that part
# times sqrt(sum m^2) over all points.

_BORDER = (np.pi - 1.0 + np.log(2.0)) / 24.0
_KNOWN_TO = {1: 0.5, 2: 0.7}
"""Where a border is known to be, on lines and maps [steps]."""


def contact_fraction(active: Mask, gap: Array) -> float:
    """Return real over nominal contact area of a periodic line or map [-]."""
    if active.ndim == 1:
        return _fraction_of_line(active, gap)
    border = sum(int((active != np.roll(active, 1, axis=axis)).sum()) for axis in (0, 1))
    return float((active.sum() - _BORDER * border) / active.size)


def border_error(active: Mask) -> float:
    """Return the error of the contact fraction from borders that lie between points [-]."""
    squares = 0
    for axis in range(active.ndim):
        border = np.moveaxis(active != np.roll(active, 1, axis=axis), axis, 0)
        squares += int(border.sum()) if active.ndim == 1 else _squared_stretches(border)
    return float(_KNOWN_TO[active.ndim] * np.sqrt(squares) / active.size)


def _squared_stretches(border: Mask) -> int:
    """Return the sum of the squared lengths of stretches along the last axis."""
    closed = np.pad(border, ((0, 0), (1, 1))).astype(np.int8).reshape(-1)
    turns = np.flatnonzero(np.diff(closed))
    return int(((turns[1::2] - turns[::2]) ** 2).sum())


def _fraction_of_line(active: Mask, gap: Array) -> float:
    points = active.size
    total = float(active.sum())
    for side in (-1, 1):
        last = np.flatnonzero(active & ~np.roll(active, -side))
        near, far = (last + side) % points, (last + 2 * side) % points
        total += float((_beyond(gap[near], gap[far], active[far]) - 0.5).sum())
    return total / points


def _beyond(near: Array, far: Array, closed: Mask) -> Array:
    """Return how far the contact reaches beyond its last closed point [steps, 0 to 1]."""
    here, there = np.maximum(near, 0.0) ** (2.0 / 3.0), np.maximum(far, 0.0) ** (2.0 / 3.0)
    growth = there - here
    fair = ~closed & (growth > 0.0)
    return np.where(fair, np.clip(1.0 - here / np.where(fair, growth, 1.0), 0.0, 1.0), 0.5)


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
class GridSequence:
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


# Estimated errors of contact fraction and friction, from grids that solve the same surface.
#
# With d_n the change from n/2 to n points in the smallest wave, the error at n is estimated as
#
#     contact fraction    max(c d_n, c^2 d_(n/2)), plus in quadrature where borders lie
#     friction            the same max, or |mu - mu_diss| if larger,
#
# c = 0.4: halving the spacing divides errors by two at least (measured on random surfaces; tests
# hold the estimates to grids four times finer), and one small change may be chance.

_SHARE = 0.4
JUDGED_BY = 3
"""Grids that the errors of the last are told from, itself among them."""


def errors(same_surface: Sequence[GridRecord]) -> tuple[float, float]:
    """Return the errors of contact fraction and friction [-] of the last and finest grid.

    NaN if there is only one grid, zero for full contact, which is in closed form.
    """
    last = same_surface[-1]
    if last.full:
        return 0.0, 0.0
    if len(same_surface) == 1:
        return math.nan, math.nan
    area = math.hypot(
        _from_changes([grid.contact_fraction for grid in same_surface]), last.border_error
    )
    traction = _from_changes([grid.friction for grid in same_surface])
    return area, max(traction, abs(last.friction - last.friction_from_dissipation))


def _from_changes(values: Sequence[float]) -> float:
    changes = [abs(b - a) for a, b in pairwise(values)]
    return max(
        _SHARE ** (1 + age) * change
        for age, change in enumerate(reversed(changes[1 - JUDGED_BY :]))
    )
