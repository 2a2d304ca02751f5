"""The direct contact: a whole measured surface in one contact problem.

A linear viscoelastic half-space in steady sliding is a convolution
(`gripscale.half_space.response`), so that the contact with all waves of a surface is solved
together: no random phases, no separation of scales. Grids are refined until the estimated errors
meet the tolerance.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from gripscale.conditions.conditions import Conditions, RubberByScale, water_film
from gripscale.core import ConvergenceError, InputError, Quantity, Status, checks, worker_count
from gripscale.half_space.active_set import (
    COARSE_ACCURACY,
    CONTACT_ACCURACY,
    START_ACCURACY,
    Accuracy,
)
from gripscale.half_space.conditions import (
    GridSequenceResult,
    accuracy_of_state,
    solve_coupled_contact,
)
from gripscale.half_space.grid import (
    PeriodicHeights,
    nearest,
    periodic_heights,
    points_in_memory,
)
from gripscale.half_space.grid_sequence import (
    ERROR_GRIDS,
    GridRecord,
    GridSequence,
    KnownLevels,
    Level,
    LevelContact,
    errors,
    finer,
    levels,
)
from gripscale.half_space.kept_grid import KeptGrid
from gripscale.half_space.response import HalfSpace, OutOfTime, check_magnitudes, half_space
from gripscale.half_space.result import RoughContact
from gripscale.half_space.water import with_water
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import CHOICES, require_measured
from gripscale.rubber.material import require_load_bearing
from gripscale.surface import HeightMap, Profile
from gripscale.surface.low_pass import STEEPEST
from gripscale.theory.half_plane import GridContact
from gripscale.theory.layers import Layers

OnGrid = Callable[[GridRecord], None]

FEWEST_IN_CONTACT = 8
LEAST_FRICTION = 0.01  # friction below which its error is relative to this value

LARGEST_MISMATCH = 0.5
"""Largest difference of the two frictions of a grid without a tolerance, relative to the larger.

docs/derivations.md says how contacts beyond it do.
"""
NEGLIGIBLE_FRICTION = 1e-3  # friction below which their difference is relative to this value


def solve_rough_contact(
    rubber: Rubber | Layers,
    surface: Profile | HeightMap,
    *,
    pressure: Quantity,
    speed: Quantity,
    smallest_wavelength: Quantity | None = None,
    periodic: bool = False,
    thickness: Quantity | None = None,
    steepest: float = STEEPEST,
    water: bool | float | str = False,
    tolerance: float | None = 0.02,
    workers: int | None = None,
    most_points: int | None = None,
    time_limit: float | None = None,
    conditions: Conditions | None = None,
    footprint: Quantity | None = None,
    extrapolate: str = "warn",
    by_scale: RubberByScale | None = None,
    start: RoughContact | None = None,
    coarse: bool = False,
    folder: str | Path | None = None,
    on_grid: OnGrid | None = None,
) -> RoughContact:
    """Return contact and friction of a whole surface: small strain, frictionless contact.

    A `status` other than "converged" says why not to trust the numbers. Raises `ExtrapolationError`
    if the rubber would be extrapolated and `extrapolate` is "refuse", `ConvergenceError` if the
    time limit ends before any grid is solved, and `InputError` if an argument is out of its range,
    the first full grid has more than `most_points`, a size is beyond single precision, or the
    pressure is more than ten times the equilibrium modulus of rubber at rest, a melt.

        >>> contact = gs.solve_rough_contact(rubber, road, pressure="3 bar", speed="1 km/h")
        >>> f"{contact.contact_fraction:.2f}"
        '0.14'

    Parameters
    ----------
    rubber : Rubber or Layers
        The half-space, or layers of rubber on a rigid base; only shear relaxes.
    surface : Profile or HeightMap
        A line (plane strain) or a map (sliding along its x). Missing heights are filled, linearly
        along a line, as a membrane over the gaps of a map.
    pressure : float
        Nominal pressure [Pa], above zero.
    speed : float
        Sliding speed [m/s]; zero is static contact of the relaxed rubber.
    smallest_wavelength : float, optional
        Cut-off of the surface [m], at least two steps of it: a Gaussian (ISO 16610) transmits half
        of this wave. By default four steps; a `periodic` surface keeps all its waves then.
    periodic : bool
        Take the surface as one period. Otherwise the smooth part that carries the jump between its
        ends is subtracted; for a line, the straight line through them.
    steepest : float
        Largest slope that rubber follows [-]: the `upper_envelope` fills steeper flanks before the
        cut-off. Infinity keeps all.
    thickness : float, optional
        Thickness [m] of the rubber, bonded to a rigid base; None: a half-space. `Layers` state
        their own.
    water : bool, float or str
        True: the surface is flooded, and open regions that the contact closes keep their water. A
        thickness [m], or a text such as "0.5 mm": a film of so much. Only of maps, for slow
        sliding: water that finds a way out has no pressure.
    tolerance : float, optional
        Estimated relative error to reach in contact fraction and friction, below 1 (friction below
        0.01 is held to the tolerance times 0.01). None: four points in the smallest wave, whatever
        the errors; the status is "frictions disagree" if the two frictions differ by more than half
        of the larger, or of 0.001.
    workers : int, optional
        Threads of the Fourier transforms of a map; one per core by default.
    most_points : int
        Points a grid may have; by default 2^22 of a line, and of a map as many as half of the
        memory of this machine holds. From 2^22 points on a map is solved in single precision and
        takes 60 bytes a point, smaller ones 150; and each 4 bytes for each point in contact and
        product of the linear solver, of which it keeps 10 to 60, in very lossy rubber 240.
    time_limit : float, optional
        Time [s] after which the status is "time limit" and the numbers are those of the last grid
        that was solved. Lines of very lossy rubber take minutes on grids above 131,072 points.
    conditions : Conditions, optional
        Temperature, softening, heat and area term. Softening and heat are iterated with the
        contact.
    footprint : float, optional
        Length of the nominal contact [m]; needed with heat.
    extrapolate : "warn" or "refuse"
        "refuse": raise an error if the smallest wave excites the rubber, at the temperature before
        the contact, beyond its `valid_band`. The share of the friction from beyond the band is in
        `extrapolation` of the result.
    by_scale : RubberByScale, optional
        The rubber at each scale, such as that of another contact: conditions are not iterated then.
    start : RoughContact, optional
        Contact of a surface of the same size that starts the solution, with any cut-off, rubber,
        pressure and speed. Only the last grids are solved: without a tolerance those with all waves
        that are not coarser than its own, and the result may have no cut-off exponents. Conditions
        that are iterated start anew.
    coarse : bool
        Solve the first grid with all waves only, two points in the smallest: the ratio to that grid
        of `start` is what another rubber or thickness changes.
    folder : str or Path, optional
        Folder for the file `grid.npz`, which holds the last solved grid while a solution runs: the
        same call takes up there what was stopped. Not with softening or heat.
    on_grid : callable, optional
        Called after each grid with its `GridRecord`.
    """
    load = checks.positive("pressure", pressure, unit="Pa")
    effects = Conditions() if conditions is None else conditions
    body = _rubber_before(half_space(rubber, speed, thickness), effects)
    iterated = effects.iterated and by_scale is None
    goal = relative_tolerance("tolerance", tolerance) or math.inf
    if body.speed == 0.0:
        for solid in body.rubbers:
            require_load_bearing(solid, load, math.inf)
    heights = periodic_heights(
        surface,
        smallest_wavelength=smallest_wavelength,
        periodic=checks.flag("periodic", periodic),
        steepest=steepest,
    )
    if checks.one_of("extrapolate", extrapolate, CHOICES) == "refuse":
        for solid in body.rubbers:
            require_measured(solid, heights.smallest_wavelength, body.speed)
    check_magnitudes(body, heights, load)
    points = levels(heights)[-1].grid.points
    most = points_in_memory(heights.grid)
    if most_points is not None:
        most = checks.whole("most_points", most_points, least=1, most=2**40)
    if points > most:
        raise InputError(
            f"most_points must be at least {points}, four points in each wave of "
            f"{heights.smallest_wavelength:.4g} m; got {most}: raise it, take a larger "
            "smallest_wavelength (of a case: cut_off) or a part of the surface"
        )
    film = _checked_water(effects.water or water, heights, effects, start)
    threads = worker_count(workers) if len(heights.grid.shape) > 1 else 1
    other = None if start is None else _known_contact(start, heights)
    deadline = math.inf
    if time_limit is not None:
        deadline = time.monotonic() + checks.positive("time_limit", time_limit, unit="s")

    def solve(
        scales: RubberByScale | None,
        earlier: KnownLevels,
        reach: float,
        rough: Accuracy | None = None,
    ) -> GridSequenceResult:
        sequence = GridSequence(
            body.with_scales(scales),
            heights,
            load,
            threads,
            earlier,
            for_next=iterated,
            other=None if iterated else other,
            deadline=deadline,
        )
        kept = None if folder is None else KeptGrid.of(folder, sequence)
        return _solve_sequence(
            sequence, most, reach, coarse=coarse, rough=rough, kept=kept, on_grid=on_grid
        )

    if not iterated:
        contact = solve(by_scale, {}, goal).contact
        if film > 0.0 and contact.status in (Status.CONVERGED, Status.TOLERANCE_NOT_MET):
            contact = with_water(contact, film, workers=threads)
        return replace(contact, conditions=conditions, status=_judged(contact, goal))
    heated = 0.0
    if effects.heat is not None and body.speed > 0.0:
        if footprint is None:
            raise InputError(
                "footprint must be the length of the nominal contact [m] with heat; got none"
            )
        heated = checks.positive("footprint", footprint, unit="m") / body.speed
    quick = partial(solve, reach=math.inf, rough=accuracy_of_state(goal))
    whole = partial(solve, reach=goal)
    assert isinstance(rubber, Rubber)  # iterated conditions refuse layers
    contact = solve_coupled_contact(whole, quick, heights, rubber, effects, heated, goal)
    return replace(contact, conditions=conditions, status=_judged(contact, goal))


def _checked_water(
    water: object, heights: PeriodicHeights, effects: Conditions, start: RoughContact | None
) -> float:
    """Return the film of water [m], zero if dry; raise `InputError` where it cannot be followed."""
    film, where = water_film(water), ""
    if film > 0.0 and len(heights.grid.shape) == 1:
        where = "on a profile: what closes a pool lies beside the line, and needs a map"
    elif film > 0.0 and (effects.iterated or start is not None):
        where = "with softening, heat or a contact to start from"
    if where:
        raise InputError(f"water must be False {where}; got {water!r}")
    return film


def _rubber_before(body: HalfSpace, conditions: Conditions) -> HalfSpace:
    """Return the rubber before the contact; `InputError` for conditions that layers do not have."""
    if body.layers is None:
        return replace(body, rubber=conditions.before(body.rubber))
    if conditions.iterated:
        raise InputError(
            "conditions with softening or heat must have one rubber, a half-space or one layer; "
            f"got {len(body.layers)} layers: leave softening and heat out"
        )
    layers = Layers([(conditions.before(rubber), height) for rubber, height in body.layers])
    return replace(body, rubber=layers.rubbers[0], layers=layers)


LEAST_TOLERANCE = 1e-5  # relative error that is still above the rounding of single precision


def relative_tolerance(name: str, value: float | None) -> float | None:
    """Return a relative tolerance, or None; raise `InputError` unless it can be reached."""
    if value is None:
        return None
    tolerance = checks.positive(name, value)
    if not LEAST_TOLERANCE <= tolerance < 1.0:
        raise InputError(
            f"{name} must be from {LEAST_TOLERANCE:g} to below 1, being a relative error; "
            f"got {tolerance:g}"
        )
    return tolerance


def _known_contact(start: RoughContact, heights: PeriodicHeights) -> LevelContact:
    """Return the contact to start from; `InputError` if its surface has another size."""
    checks.instance("start", start, RoughContact)
    start.require_dry("a solution starts without pools")
    lengths = start.grid.lengths
    if len(lengths) != len(heights.grid.lengths) or not np.allclose(lengths, heights.grid.lengths):
        sizes = [
            " x ".join(f"{length:.6g}" for length in grid.lengths)
            for grid in (heights.grid, start.grid)
        ]
        raise InputError(
            f"start must be a contact of a surface of the same size, {sizes[0]} m; got {sizes[1]} m"
        )
    level = Level(start.grid, start.smallest_wavelength)
    contact = GridContact(start.pressure, start.gap, start.active, 0, settled=True)
    return LevelContact(level, start.height, contact, start.grids[-1])


def _planned(sequence: GridSequence, goal: float, *, coarse: bool) -> list[Level]:
    """Return the levels to solve: from a known contact those a goal is judged by, or fewest."""
    heights, other = sequence.heights, sequence.other

    def with_all_waves(every: Iterable[Level]) -> list[Level]:
        return [level for level in every if level.cut_off == heights.smallest_wavelength]

    if resolved := with_all_waves(sequence.start):
        return resolved[-(1 if math.isinf(goal) else ERROR_GRIDS) :]
    every = levels(heights)
    if coarse:
        return with_all_waves(every)[:1]
    if other is None or not math.isinf(goal):
        return every if other is None else every[-ERROR_GRIDS:]
    fine = [level for level in with_all_waves(every) if level.grid.points >= other.height.size]
    return fine or every[-1:]


def _solve_sequence(
    sequence: GridSequence,
    most: int,
    goal: float,
    *,
    coarse: bool,
    rough: Accuracy | None,
    kept: KeptGrid | None = None,
    on_grid: OnGrid | None = None,
) -> GridSequenceResult:
    """Return the contact with one rubber, on grids refined until the errors meet `goal`."""
    body, heights, load = sequence.body, sequence.heights, sequence.pressure
    plan, in_time = _planned(sequence, goal, coarse=coarse), True
    grids = [] if kept is None else kept.load(sequence, plan)
    solved = sequence.last
    while plan or (solved is not None and not _met(_same_surface(grids), goal)):
        level = plan.pop(0) if plan or solved is None else finer(solved.level)
        if solved is not None and level.grid.points > most:
            break
        try:
            if coarse:
                accuracy = COARSE_ACCURACY
            elif rough is not None:  # exponents of the cut-off are of the first passes
                accuracy = rough if sequence.start else START_ACCURACY
            else:
                accuracy = _accuracy(level, plan, goal)
            solved = sequence.solve(level, accuracy)
        except OutOfTime:
            in_time = False
            break
        grids.append(solved.record)
        if kept is not None:
            kept.save(solved, grids)
        if on_grid is not None:
            on_grid(solved.record)
    if solved is None:
        raise ConvergenceError(
            "the time limit ended the direct contact before its first grid was solved"
        )
    if kept is not None and in_time:
        kept.path.unlink(missing_ok=True)
    contact, record, height = solved.contact, solved.record, solved.height
    status = Status.CONVERGED if _met(_same_surface(grids), goal) else Status.TOLERANCE_NOT_MET
    if not in_time:
        status = Status.TIME_LIMIT
    elif not np.isfinite(contact.pressure).all():
        status = Status.NOT_FINITE
    elif not record.settled:
        status = Status.ACTIVE_SET_NOT_SETTLED
    elif record.in_contact < FEWEST_IN_CONTACT:
        status = Status.CONTACT_TOO_NARROW
    area_error, friction_error = errors(_same_surface(grids))
    violation = max(
        -float(contact.gap.min()), float(np.abs(contact.gap[contact.active]).max(initial=0.0))
    )
    rms = float(np.sqrt(np.mean(height**2)))
    result = RoughContact(
        rubber=body.rubber,
        nominal_pressure=load,
        speed=body.speed,
        smallest_wavelength=heights.smallest_wavelength,
        contact_fraction=record.contact_fraction,
        friction=record.friction,
        friction_from_dissipation=record.friction_from_dissipation,
        contact_fraction_error=area_error,
        friction_error=friction_error,
        status=status,
        residuals={
            "pressure": contact.missing,
            "gap": violation / rms if rms > 0.0 else 0.0,
            "load": abs(float(contact.pressure.mean(dtype=np.float64)) / load - 1.0),
        },
        full_contact=record.full,
        grid=solved.level.grid,
        origin=heights.origin,
        height=height,
        pressure=np.maximum(contact.pressure, 0.0),
        gap=np.where(contact.active, 0.0, np.maximum(contact.gap, 0.0)),
        measured=nearest(heights.measured, solved.level.grid.shape),
        grids=grids,
        by_scale=body.by_scale,
        thickness=body.thickness,
        layers=body.layers,
    )
    return GridSequenceResult(result, {**sequence.start, **sequence.solved})


def _accuracy(level: Level, following: list[Level], goal: float) -> Accuracy:
    """Return the accuracy of the contact on a level, so that it adds little to errors of `goal`.

    The cut-off exponents compare the last grid without the last octave with one that has it.
    """
    if not following:
        if math.isinf(goal):
            return CONTACT_ACCURACY
        return Accuracy(max(CONTACT_ACCURACY.missing, 1e-3 * goal), 0.01 * goal)
    compared = len(following) == 2 and following[0].cut_off < level.cut_off
    if compared or math.isinf(goal):
        return START_ACCURACY
    missing = min(max(START_ACCURACY.missing, 0.006 * goal), COARSE_ACCURACY.missing)
    return Accuracy(missing, min(0.05 * goal, COARSE_ACCURACY.wrong))


def _judged(contact: RoughContact, goal: float) -> Status:
    """Return the status of a contact; without a tolerance its two frictions must roughly agree."""
    if not contact.converged or math.isfinite(goal) or contact.speed == 0.0:
        return contact.status
    traction, lost = contact.friction, contact.friction_from_dissipation
    scale = max(abs(traction), abs(lost), NEGLIGIBLE_FRICTION)
    agree = abs(traction - lost) <= LARGEST_MISMATCH * scale
    return Status.CONVERGED if agree else Status.FRICTIONS_DISAGREE


def _same_surface(grids: list[GridRecord]) -> list[GridRecord]:
    """Return the settled grids with the same waves as the last one, and the last one."""
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
