"""Contact of a map in water: open regions that close keep their volume and carry load.

The load is raised in steps. After each, the open regions that do not percolate are pools with the
water they hold (`gripscale.half_space.pools`), which later steps press upon: B. N. J. Persson, U.
Tartaglino, O. Albohr & E. Tosatti, Nature Materials 3 (2004) 882, doi:10.1038/nmat1255. Regions
that percolate drain, and their water has no pressure: the sliding is slow (`gripscale.flow` says
how slow). Water does not compress.

A film of the mean thickness d fills the surface at rest up to one level; a pool then holds what
lies below that level, and may have room left.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from gripscale.core import checks, units
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.core.status import Status
from gripscale.half_space.active_set import CONTACT_TOLERANCE, START_TOLERANCE, solve_grid
from gripscale.half_space.grid import Grid, resampled
from gripscale.half_space.grid_sequence import (
    friction_from_traction,
    grid_contact_fraction,
    lost_by_harmonic,
)
from gripscale.half_space.pools import Pools
from gripscale.half_space.regions import periodic_regions
from gripscale.half_space.response import Response
from gripscale.half_space.result import RoughContact, TrappedWater
from gripscale.theory.half_plane import GridContact

POOL_TOLERANCE = 1e-7
"""Missing pressure over pressure at the end: the volume of the smallest pools then is kept to a
thousandth."""
FIRST_LOAD, LOAD_STEPS = 0.1, 48
"""First load over the load, and the steps that raise it by equal ratios, of 5 %. A region that
closes within a step is trapped at its end, with less water. Half the steps change the friction of
a map by up to 3 %, where the contact percolates."""


def water_film(water: object) -> float:
    """Return the film that `water` asks for [m]: infinite if flooded, zero if dry."""
    if isinstance(water, bool | np.bool_):
        return np.inf if water else 0.0
    try:
        film = units.parse_quantity(water, "length")
    except ValueError as error:
        raise InputError(
            f"water must be True, False or the thickness of a film: {error}"
        ) from error
    return checks.positive("water", film, unit="m")


@dataclass(frozen=True)
class _Wet:
    """Contact with pools on one grid, and the numbers of the dry and the wet one."""

    contact: GridContact
    pools: Pools
    dry: dict[str, float]
    numbers: dict[str, float]


def with_water(contact: RoughContact, film: float, *, workers: int, most: int) -> RoughContact:
    """Return a dry contact with trapped water, solved on its grid and more coarsely.

    The coarse solution has half the points each way and half the steps of load.
    Errors are those of the dry contact and the change of wet over dry between the two.
    """
    fine = _solve_wet(contact, contact.height, film, LOAD_STEPS, workers, most)
    shape = tuple(n // 2 for n in contact.grid.shape)
    half = resampled(scipy.fft.rfftn(contact.height), contact.grid.shape, shape)
    coarse = _solve_wet(contact, half, film, LOAD_STEPS // 2, workers, most)
    area_ratio, area_change = _change(fine, coarse, "contact_fraction")
    friction_ratio, friction_change = _change(fine, coarse, "friction_from_dissipation")
    settled = fine.contact.settled
    pressure, active = fine.contact.pressure, fine.contact.active
    label = np.where(active, 0, fine.pools.label.reshape(active.shape))
    water = TrappedWater(
        film=film,
        pool=label,
        pool_pressure=fine.pools.pressures(pressure.reshape(-1), active.reshape(-1))[1:],
        pool_volume=fine.pools.volume[1:] * float(np.prod(contact.grid.spacing)),
        dry_contact_fraction=contact.contact_fraction,
        dry_friction=contact.friction_from_dissipation,
    )
    return replace(
        contact,
        **fine.numbers,
        contact_fraction_error=contact.contact_fraction_error * area_ratio + area_change,
        friction_error=contact.friction_error * friction_ratio + friction_change,
        status=contact.status if settled else Status.ACTIVE_SET_NOT_SETTLED,
        full_contact=bool(active.all()),
        pressure=np.maximum(pressure, 0.0),
        gap=np.where(active, 0.0, np.maximum(fine.contact.gap, 0.0)),
        water=water,
    )


def _change(fine: _Wet, coarse: _Wet, name: str) -> tuple[float, float]:
    """Return wet over dry of a number, and the error of the wet number by the coarse solution."""
    ratios = [each.numbers[name] / (each.dry[name] or np.inf) for each in (fine, coarse)]
    return ratios[0], abs(ratios[0] - ratios[1]) * abs(fine.dry[name])


def _solve_wet(
    contact: RoughContact, height: Array, film: float, steps: int, workers: int, most: int
) -> _Wet:
    """Return the contact on a grid under loads that rise, from one that is dry."""
    grid = Grid(height.shape, contact.grid.lengths)
    response = Response.of(contact.body, grid, workers)
    level = _water_level(height, film)
    dry = solve_grid(response, height, _start(contact, height), most, CONTACT_TOLERANCE)
    loads = contact.nominal_pressure * np.geomspace(FIRST_LOAD, 1.0, steps)
    start = response.full_contact(height, loads[0])
    step = solve_grid(response, height, _loaded(start, loads[0]), most, START_TOLERANCE)
    pools = _trapped(Pools(np.zeros(height.size, dtype=np.intp), np.zeros(1)), step, height, level)
    for load in loads[1:]:
        goal = POOL_TOLERANCE if load == loads[-1] else START_TOLERANCE
        start = _loaded(step.pressure, load)
        step = solve_grid(response, height, start, most, goal, pools=pools, active=step.active)
        last, pools = pools, _trapped(pools, step, height, level)
    return _Wet(step, last, _numbers(response, height, dry), _numbers(response, height, step))


def _trapped(pools: Pools, contact: GridContact, height: Array, level: float) -> Pools:
    """Return the pools of a contact, with the water that was in them under the load before."""
    active, gap = contact.active.reshape(-1), contact.gap.reshape(-1)
    opened = np.where(active, 0.0, np.maximum(gap, 0.0))
    depth = np.minimum(opened, np.maximum(level - height.reshape(-1), 0.0))
    capacity = pools.capacity(gap, active)
    share = np.divide(pools.volume, capacity, out=np.zeros_like(capacity), where=capacity > 0.0)
    inside = pools.label > 0
    depth[inside] = (opened * np.minimum(share, 1.0)[pools.label])[inside]
    regions = periodic_regions(~contact.active)
    closed = ~regions.percolates.any(axis=1)
    number = np.append(0, np.cumsum(closed) * closed)
    label = number[regions.labels].reshape(-1)
    return Pools(label, np.bincount(label, depth, int(closed.sum()) + 1))


def _water_level(height: Array, film: float) -> float:
    """Return the level of a film of the mean thickness `film` on the heights [m]."""
    if np.isinf(film):
        return np.inf
    below = np.sort(height.reshape(-1))
    mean_depth = (below * np.arange(1, below.size + 1) - np.cumsum(below)) / below.size
    if film >= mean_depth[-1]:
        return float(below[-1] + film - mean_depth[-1])
    return float(np.interp(film, mean_depth, below))


def _start(contact: RoughContact, height: Array) -> Array:
    """Return the pressure of the dry contact on a grid."""
    if height.shape == contact.grid.shape:
        return contact.pressure
    every = tuple(slice(None, None, 2) for _ in height.shape)
    pressure = contact.pressure[every][tuple(slice(n) for n in height.shape)]
    return _loaded(pressure, contact.nominal_pressure)


def _loaded(pressure: Array, load: float) -> Array:
    """Return `pressure` without tension, scaled to a load [Pa]."""
    positive = np.maximum(pressure, 0.0)
    return np.asarray(positive * (load / positive.mean()))


def _numbers(response: Response, height: Array, contact: GridContact) -> dict[str, float]:
    """Return contact fraction and frictions by their names in a result."""
    lost = lost_by_harmonic(response.compliance, response.grid, contact.pressure)
    return {
        "contact_fraction": grid_contact_fraction(contact.active, contact.gap),
        "friction": friction_from_traction(response.grid, contact.pressure, height),
        "friction_from_dissipation": float(lost.sum()),
    }
