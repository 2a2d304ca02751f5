"""Contact of a map in water: open regions that close keep their volume and carry load.

The load is raised in steps. After each, the open regions that do not percolate are pools with the
water they hold (`gripscale.half_space.regions`), which later steps press upon: B. N. J. Persson, U.
Tartaglino, O. Albohr & E. Tosatti, Nature Materials 3 (2004) 882, doi:10.1038/nmat1255. Regions
that percolate drain without pressure, as in slow sliding. A film fills the surface up to one level.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from gripscale.core import Array, Mask, Status
from gripscale.half_space.active_set import DIFFERENCE_ACCURACY, Accuracy, solve_grid
from gripscale.half_space.grid import Grid, resampled
from gripscale.half_space.grid_sequence import (
    friction_from_traction,
    grid_contact_fraction,
    loaded,
    lost_by_harmonic,
)
from gripscale.half_space.regions import Pools, periodic_regions
from gripscale.half_space.response import Response
from gripscale.half_space.result import RoughContact, TrappedWater
from gripscale.theory.half_plane import GridContact

# Missing pressure over pressure at the end: the volume of the smallest pools then is kept to a
# thousandth.
POOL_ACCURACY = Accuracy(1e-7)
# First load over the load, and the steps that raise it by equal ratios, of 5 %. Half the steps
# change the friction of a map by up to 3 %, where the contact percolates.
FIRST_LOAD, LOAD_STEPS = 0.1, 48
# Load over the load at which a region that is closed under the first load, and was here already,
# has its water: all but this share of what closes at the first touch.
TOUCH = 1e-3
_ERRORS = ("contact_fraction_error", "friction_error")


def with_water(contact: RoughContact, film: float, *, workers: int) -> RoughContact:
    """Return a dry contact with trapped water, solved on its grid and one of half the points.

    Errors are those of the dry contact, and the change of wet over dry between the two grids.
    """
    response = Response.of(contact.body, contact.grid, workers)
    load = contact.nominal_pressure
    step, pools = _under_rising_load(response, contact.height, load, film, LOAD_STEPS)
    numbers = _numbers(response, contact.height, step)

    half = Grid(tuple(n // 2 for n in contact.grid.shape), contact.grid.lengths)
    response = Response.of(contact.body, half, workers)
    height = resampled(scipy.fft.rfftn(contact.height), contact.grid.shape, half)
    start = loaded(response.full_contact(height, load), load)
    before = _numbers(response, height, solve_grid(response, height, start, DIFFERENCE_ACCURACY))
    coarse, _ = _under_rising_load(response, height, load, film, LOAD_STEPS // 2)
    after = _numbers(response, height, coarse)
    changed: dict[str, Any] = {**numbers}
    for error, name in zip(_ERRORS, ("contact_fraction", "friction_from_dissipation"), strict=True):
        dry = getattr(contact, name) or math.inf
        ratio, coarse_ratio = numbers[name] / dry, after[name] / (before[name] or math.inf)
        changed[error] = getattr(contact, error) * ratio + abs(numbers[name] - coarse_ratio * dry)
    flat, active = step.pressure.reshape(-1), step.active
    water = TrappedWater(
        film=film,
        pool=np.where(active, 0, pools.label.reshape(active.shape)),
        pool_pressure=pools.pressures(flat, active.reshape(-1))[1:],
        pool_volume=pools.volume[1:] * math.prod(contact.grid.spacing),
        dry_contact_fraction=contact.contact_fraction,
        dry_friction=contact.friction_from_dissipation,
    )
    return replace(
        contact,
        **changed,
        status=contact.status if step.settled else Status.ACTIVE_SET_NOT_SETTLED,
        residuals={**contact.residuals, "pressure": step.missing},
        full_contact=bool(active.all()),
        pressure=np.maximum(step.pressure, 0.0),
        gap=np.where(active, 0.0, np.maximum(step.gap, 0.0)),
        water=water,
    )


def _under_rising_load(
    response: Response, height: Array, load: float, film: float, steps: int
) -> tuple[GridContact, Pools]:
    """Return the contact on a grid under loads that rise from a dry one, and its pools."""
    level = _water_level(height, film)
    loads = load * np.geomspace(FIRST_LOAD, 1.0, steps)
    start = loaded(response.full_contact(height, loads[0]), loads[0])
    step = solve_grid(response, height, start, DIFFERENCE_ACCURACY)
    start = loaded(step.pressure, TOUCH * load)
    touch = solve_grid(response, height, start, DIFFERENCE_ACCURACY)
    regions = periodic_regions(~touch.active)
    closed = regions.where(np.asarray(~regions.percolates.any(axis=1)))
    step = replace(step, gap=np.where(closed, touch.gap, step.gap))
    pools = Pools(np.zeros(height.size, dtype=np.intp), np.zeros(1), np.zeros(1, dtype=bool))
    touched = np.zeros(height.shape, dtype=bool)
    for under in loads:
        pools = _trapped(pools, step, height, level, touched)
        touched, start = step.active, loaded(step.pressure, under)
        accuracy = POOL_ACCURACY if under == loads[-1] else DIFFERENCE_ACCURACY
        step = solve_grid(response, height, start, accuracy, pools=pools, active=touched)
    return step, pools


def _trapped(
    pools: Pools, contact: GridContact, height: Array, level: float, touched: Mask
) -> Pools:
    """Return the pools of a contact with the water they had before, none where it `touched`."""
    active, gap = contact.active.reshape(-1), contact.gap.reshape(-1)
    opened = np.where(active, 0.0, np.maximum(gap, 0.0))
    depth = np.minimum(opened, np.maximum(level - height.reshape(-1), 0.0))
    capacity = pools.capacity(gap, active)
    share = np.divide(pools.volume, capacity, out=np.zeros_like(capacity), where=capacity > 0.0)
    inside = pools.label > 0
    depth[inside] = (opened * share[pools.label])[inside]
    depth[touched.reshape(-1)] = 0.0
    regions = periodic_regions(~contact.active)
    closed = ~regions.percolates.any(axis=1)
    number = np.append(0, np.cumsum(closed) * closed)
    label = number[regions.labels].reshape(-1)
    volume: Array = np.asarray(np.bincount(label, depth, int(closed.sum()) + 1), dtype=float)
    return Pools(label, volume, np.arange(volume.size) > 0)


def _water_level(height: Array, film: float) -> float:
    """Return the level of a film of the mean thickness `film` on the heights [m]."""
    if np.isinf(film):
        return np.inf
    below = np.sort(height.reshape(-1))
    mean_depth = (below * np.arange(1, below.size + 1) - np.cumsum(below)) / below.size
    if film >= mean_depth[-1]:
        return float(below[-1] + film - mean_depth[-1])
    return float(np.interp(film, mean_depth, below))


def _numbers(response: Response, height: Array, contact: GridContact) -> dict[str, float]:
    """Return contact fraction and frictions by their names in a result."""
    lost = lost_by_harmonic(response.compliance, response.grid, contact.pressure)
    return {
        "contact_fraction": grid_contact_fraction(contact.active, contact.gap),
        "friction": friction_from_traction(response.grid, contact.pressure, height),
        "friction_from_dissipation": float(lost.sum()),
    }
