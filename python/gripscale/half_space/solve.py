"""The direct contact: a whole measured surface in one contact problem.

A linear viscoelastic half-space in steady sliding is one convolution (`half_space`), so that the
contact with all waves of a surface at once can be solved: no random phases, no separate scales.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from gripscale.conditions.conditions import Conditions, RubberByScale
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.core.parallel import worker_count
from gripscale.half_space.active_set import START_TOLERANCE, TOLERANCE
from gripscale.half_space.conditions import GridSequenceResult, solve_coupled_contact
from gripscale.half_space.grid import PeriodicHeights, periodic_heights
from gripscale.half_space.grid_sequence import (
    JUDGED_BY,
    GridRecord,
    GridSequence,
    KnownLevels,
    Level,
    LevelContact,
    errors,
    finer,
    levels,
)
from gripscale.half_space.response import HalfSpace, check_magnitudes, half_space
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import CHOICES, require_measured
from gripscale.rubber.material import require_load_bearing
from gripscale.surface import HeightMap, Profile
from gripscale.wave.problem import Status

FEWEST_IN_CONTACT = 8
LEAST_FRICTION = 0.01
"""Friction below which its error is compared with the tolerance times this."""


def solve_rough_contact(
    rubber: Rubber,
    surface: Profile | HeightMap,
    *,
    pressure: float,
    speed: float,
    smallest_wavelength: float | None = None,
    periodic: bool = False,
    tolerance: float | None = 0.02,
    workers: int | None = None,
    most_points: int = 2**22,
    most_iterations: int = 60,
    on_grid: Callable[[GridRecord], None] | None = None,
    conditions: Conditions | None = None,
    footprint: float | None = None,
    extrapolate: str = "warn",
) -> RoughContact:
    """Return contact and friction of a whole surface: small strain, frictionless contact.

    Parameters
    ----------
    rubber : Rubber
        The half-space; only shear relaxes.
    surface : Profile or HeightMap
        A line (plane strain) or a map (sliding along its x). Missing heights are filled, linearly
        along a line, as a membrane over the gaps of a map.
    pressure : float
        Nominal pressure [Pa], above zero.
    speed : float
        Sliding speed [m/s]; zero is static contact of the relaxed rubber.
    smallest_wavelength : float, optional
        Shorter waves of the surface are left out [m]: at least two steps of it; four by default.
    periodic : bool
        Take the surface as one period as it stands. Otherwise its ends are joined by subtracting
        the smooth part that carries the jump between them; for a line, the straight line through
        its ends.
    tolerance : float, optional
        Estimated relative error to reach in contact fraction and friction, below 1 (friction below
        0.01 is held to the tolerance times 0.01). None: four points in the smallest wave, whatever
        the errors.
    workers : int, optional
        Threads of the Fourier transforms of a map; one per core by default.
    most_points : int
        Points a grid may have. A solution takes about 150 bytes a point (150 MB for 1024 x 1024),
        and 4 bytes for each point in contact and product of the linear solver, of which it keeps
        10 to 60, in very lossy rubber 240.
    most_iterations : int
        Active-set iterations allowed on each grid.
    on_grid : callable, optional
        Called with the `GridRecord` of each grid as it is solved. A `KeyboardInterrupt` is raised
        at the next return from compiled code; of a stopped solution these records are what is left.
    conditions : Conditions, optional
        Temperature, softening, heat and area term; the contact is solved until they agree with it.
    footprint : float, optional
        Length of the nominal contact [m]; needed with heat.
    extrapolate : "warn" or "refuse"
        "refuse": nothing is solved if the smallest wave excites the rubber, at the temperature
        before the contact, beyond its `valid_band`. What of the friction comes from beyond it is in
        `extrapolation` of the result.

    Returns
    -------
    RoughContact
        A `status` other than "converged" says why not to trust the numbers.

    Raises
    ------
    ExtrapolationError
        An `InputError`: extrapolation is to be refused.
    InputError
        If an argument is out of its range, the first full grid has more than `most_points`, a size
        is beyond what single precision can hold, or the rubber at rest is a melt: the pressure is
        more than ten times the equilibrium modulus.
    """
    load = checks.positive("pressure", pressure, unit="Pa")
    under = Conditions() if conditions is None else conditions
    own = under.before(rubber)
    body = half_space(own, speed)
    goal = math.inf if tolerance is None else _tolerance(tolerance)
    if body.speed == 0.0:
        require_load_bearing(rubber, load, math.inf)
    heights = periodic_heights(
        surface,
        smallest_wavelength=smallest_wavelength,
        periodic=checks.flag("periodic", periodic),
    )
    if checks.one_of("extrapolate", extrapolate, CHOICES) == "refuse":
        require_measured(own, heights.smallest_wavelength, body.speed)
    check_magnitudes(body, heights, load)
    plan = levels(heights)
    most = checks.whole("most_points", most_points, least=1, most=2**40)
    _check_size(plan[-1].grid.points, most, heights.smallest_wavelength)
    threads = worker_count(workers) if len(heights.grid.shape) > 1 else 1
    iterations = checks.whole("most_iterations", most_iterations, least=1, most=10**6)
    if on_grid is not None and not callable(on_grid):
        raise InputError(f"on_grid must be a function or None; got {checks.short_repr(on_grid)}")

    def solve(
        by_scale: RubberByScale | None, known: KnownLevels, reach: float
    ) -> GridSequenceResult:
        climb = GridSequence(
            replace(body, by_scale=by_scale), heights, load, threads, iterations, known
        )
        return _climbed(climb, most, reach, on_grid)

    if not under.iterated:
        return replace(solve(None, {}, goal).contact, conditions=conditions)
    time = _passage(under, speed, footprint)
    quick, whole = partial(solve, reach=math.inf), partial(solve, reach=goal)
    return replace(solve_coupled_contact(whole, quick, rubber, under, time), conditions=conditions)


def _climbed(
    climb: GridSequence, most: int, goal: float, on_grid: Callable[[GridRecord], None] | None
) -> GridSequenceResult:
    """Return the contact with one rubber, on finer and finer grids."""
    plan, grids = _planned(climb, goal), list[GridRecord]()
    while plan:
        level = plan.pop(0)
        solved = climb.solve(level, START_TOLERANCE if plan else TOLERANCE)
        grids.append(solved.record)
        if on_grid is not None:
            on_grid(solved.record)
        following = finer(solved.level)
        if not plan and not _met(_same_surface(grids), goal):
            plan += [following] if following.grid.points <= most else []
    contact = _result(climb.body, climb.heights, climb.pressure, solved, grids, goal)
    return GridSequenceResult(contact, {**climb.known, **climb.solved})


def _planned(climb: GridSequence, goal: float) -> list[Level]:
    """Return the levels to the first that may do.

    Of those known the last, with those before it that tell its errors if they are asked for.
    """
    known = [one.level for one in climb.known.values()]
    whole = [level for level in known if level.cut_off == climb.heights.smallest_wavelength]
    needed = 1 if math.isinf(goal) else JUDGED_BY
    return whole[-needed:] or levels(climb.heights)


def _passage(conditions: Conditions, speed: float, footprint: float | None) -> float:
    """Return for how long the nominal contact lasts [s], where heat needs to know."""
    if conditions.heat is None or speed == 0.0:
        return 0.0
    if footprint is None:
        raise InputError(
            "footprint must be the length of the nominal contact [m] with heat; got none"
        )
    return checks.positive("footprint", footprint, unit="m") / speed


def _result(
    body: HalfSpace,
    heights: PeriodicHeights,
    load: float,
    solved: LevelContact,
    grids: list[GridRecord],
    goal: float,
) -> RoughContact:
    contact, found = solved.contact, solved.record
    area_error, friction_error = errors(_same_surface(grids))
    return RoughContact(
        rubber=body.rubber,
        nominal_pressure=load,
        speed=body.speed,
        smallest_wavelength=heights.smallest_wavelength,
        contact_fraction=found.contact_fraction,
        friction=found.friction,
        friction_from_dissipation=found.friction_from_dissipation,
        contact_fraction_error=area_error,
        friction_error=friction_error,
        status=_status(solved, grids, goal),
        residuals=_residuals(solved, load),
        full_contact=found.full,
        grid=solved.level.grid,
        origin=heights.origin,
        height=solved.height,
        pressure=np.maximum(contact.pressure, 0.0),
        gap=np.where(contact.active, 0.0, np.maximum(contact.gap, 0.0)),
        measured=heights.measured_on(solved.level.grid.shape),
        grids=grids,
        by_scale=body.by_scale,
    )


def _same_surface(grids: list[GridRecord]) -> list[GridRecord]:
    """Return the last grid, and those before it that settled with all waves on them."""
    whole = [grid for grid in grids if grid.cut_off == grids[-1].cut_off]
    return [grid for grid in whole[:-1] if grid.settled] + whole[-1:]


def _met(same_surface: list[GridRecord], goal: float) -> bool:
    """Return whether the last grid is fine enough, or too bad for a finer one to help."""
    last = same_surface[-1]
    if not last.settled or (math.isinf(goal) and last.in_contact >= FEWEST_IN_CONTACT):
        return True
    area, friction = errors(same_surface)
    return (
        area <= goal * last.contact_fraction
        and friction <= goal * max(abs(last.friction_from_dissipation), LEAST_FRICTION)
        and last.in_contact >= FEWEST_IN_CONTACT
    )


def _status(solved: LevelContact, grids: list[GridRecord], goal: float) -> Status:
    pressure, last = solved.contact.pressure, grids[-1]
    if not np.isfinite(pressure).all():
        return Status.NOT_FINITE
    if not last.settled:
        return Status.ACTIVE_SET_NOT_SETTLED
    if last.in_contact < FEWEST_IN_CONTACT:
        return Status.CONTACT_TOO_NARROW
    return Status.CONVERGED if _met(_same_surface(grids), goal) else Status.TOLERANCE_NOT_MET


def _residuals(solved: LevelContact, load: float) -> dict[str, float]:
    contact, size = solved.contact, float(np.sqrt(np.mean(solved.height**2)))
    left = np.where(contact.active, np.abs(contact.gap), np.maximum(-contact.gap, 0.0))
    return {
        "pressure": contact.missing,
        "gap": float(left.max() / size) if size > 0.0 else 0.0,
        "load": abs(float(contact.pressure.mean()) / load - 1.0),
    }


def _check_size(points: int, most: int, smallest: float) -> None:
    if points > most:
        raise InputError(
            f"most_points must be at least {points}, four points in each wave of {smallest:.4g} m; "
            f"got {most}: raise it, take a larger smallest_wavelength or a part of the surface"
        )


def _tolerance(value: float) -> float:
    goal = checks.positive("tolerance", value)
    if goal >= 1.0:
        raise InputError(f"tolerance must be below 1, being a relative error; got {goal:g}")
    return goal
