"""Design of a compound: more friction on a measured road for a given rolling resistance.

A point of the trade-off curve is the admissible compound with the most friction
(`compound_search`) whose tan(delta) at the rolling condition is at most `level` times today's. The
levels rise, and each is sought from today's compound and from the point before, which it admits
too: ln mu need not be concave, and the better of the two ends counts. Friction and gain of a point
are those of contacts solved anew, to the tolerance of a comparison (`compound_gain`). A level
without more friction than the one below is no point: the compound below is admissible there, too.
The result is written after each point.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.core import checks, provenance
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.core.finding import doubt
from gripscale.experiment.design import variable_attributes
from gripscale.experiment.task import canonical_json, load_stored
from gripscale.half_space.result import RoughContact
from gripscale.io import netcdf
from gripscale.questions.design.compound_gain import gain, series_derivatives, series_error
from gripscale.questions.design.compound_limits import CompoundLimits, changed, require_shift
from gripscale.questions.design.compound_search import (
    DesignProblem,
    best_change,
    design_problem,
    nearest_design,
)
from gripscale.questions.design.design_dataset import of_change, of_compound, scalars, today
from gripscale.questions.design.goal_friction import CompoundGoal, GoalFriction
from gripscale.questions.inputs import record
from gripscale.questions.vary.inputs import identity, measured_rubber_of, reading_notes
from gripscale.questions.vary.rubber_comparison import at_one_temperature
from gripscale.rubber import Rubber

DESIGN_FILE = "design.nc"
DESIGN_TOLERANCE = 0.05
"""Estimated relative error of the contacts whose friction is stated, as in comparisons."""

FRUITLESS = "levels_without_more_friction"
"""Attribute of a design: levels that are left out because a lower one has as much friction."""

OnPoint = Callable[[xr.Dataset], object]


@dataclass(frozen=True)
class Reference:
    """Today's compound, solved as each point is."""

    contacts: Sequence[RoughContact] = field(repr=False)
    log_friction: float
    series: Array = field(repr=False)

    @classmethod
    def of(cls, friction: GoalFriction) -> Reference:
        """Solve today's compound on the grid of the search and on fine ones."""
        value, _ = friction.log_friction(np.ones(1 + friction.rubber.moduli.size))
        series = series_derivatives(friction, friction.contacts(friction.rubber))
        return cls(
            friction.contacts(friction.rubber, tolerance=DESIGN_TOLERANCE, warm=False),
            value,
            series,
        )


def solved_design(
    case: Case,
    folder: Path | None,
    *,
    goals: Sequence[CompoundGoal],
    limits: CompoundLimits | None,
    levels: Sequence[float],
    rubbers: Mapping[str, Any] | None,
    roads: Mapping[str, Any] | None,
    workers: int | None,
    on_point: OnPoint | None,
) -> tuple[xr.Dataset, xr.Dataset]:
    """Return numbers and inputs of `gripscale.design`, whose arguments these are.

    A folder gets `design.nc` after each point.
    """
    problem = design_problem(case, goals, limits, workers, roads)
    wanted = [checks.positive("level", level) for level in levels] or problem.default_levels()
    key = _key(case, problem, wanted, rubbers or {})
    stored, fruitless = _stored_points(folder, key)
    reference = Reference.of(problem.friction)
    base = today(problem, reference.contacts, DESIGN_TOLERANCE).assign_attrs(
        case.attributes,
        case_file=case.origin.name,
        kind="design",
        design_key=key,
        rubber_parameters=json.dumps(problem.rubber.to_dict()),
    )
    prepared = {name: measured_rubber_of(value, case) for name, value in (rubbers or {}).items()}
    read = {name: each.rubber for name, each in prepared.items()}
    compounds, notes = _compounds(problem, reference, read)
    notes = (*notes, *_left_out(case))
    base = base.merge(compounds).assign_attrs(base.attrs, notes="\n".join(notes))
    goal_loads = [
        replace(case.load, speed=goal.speed, pressure=goal.pressure)
        for goal in problem.friction.goals
    ]
    of_compounds = [doubt(text) for text in reading_notes((rubbers or {}).values())]
    of_compounds += [d.about(name) for name, each in prepared.items() for d in each.doubts]
    of_inputs = record.inputs(case, problem.roads.values(), goal_loads, of_compounds)
    points: list[xr.Dataset] = []
    rising = _order(wanted, problem)
    for level in rising:
        if level in fruitless:
            continue
        point = stored.get(level)
        if point is None:
            point = _solved_point(problem, reference, level, points[-1:])
        rises = not points or float(point.gain) > float(points[-1].gain)
        if rises:
            points.append(point)
        else:
            fruitless.add(level)
        if not bool(point.rolling_reached):
            fruitless |= {higher for higher in rising if higher > level}
        data = _joined(base, points).assign_attrs({FRUITLESS: json.dumps(sorted(fruitless))})
        if folder is not None:
            netcdf.save(data, folder / DESIGN_FILE, {"inputs": of_inputs})
        if rises and on_point is not None:
            on_point(point)
    return data, of_inputs


def _solved_point(
    problem: DesignProblem, reference: Reference, level: float, before: Sequence[xr.Dataset]
) -> xr.Dataset:
    """Return one point of the curve, sought from today's compound and from the point before it."""
    friction, admissible = problem.friction, problem.admissible(level)
    starts = [np.ones(1 + problem.rubber.moduli.size)]
    starts += [np.asarray(point.modulus_ratio.values, dtype=float) for point in before]
    optima = [best_change(friction, admissible, start) for start in starts]
    best = max(optima, key=lambda optimum: optimum.log_friction)
    optimum = nearest_design(friction, admissible, best)
    rubber = changed(problem.rubber, optimum.ratio)
    series = series_derivatives(friction, friction.contacts(rubber))
    contacts = friction.contacts(rubber, tolerance=DESIGN_TOLERANCE, warm=False)
    result = gain(friction, reference.contacts, contacts)
    rolling = problem.rolling_ratio(rubber)
    worth = problem.worth_of_limits(level, best.slope)
    low, high = result.interval
    numbers = {
        "rolling_level": (level, "largest loss factor at the rolling condition over today's"),
        "rolling_ratio": (rolling, "loss factor at the rolling condition over today's"),
        "rolling_reached": (rolling > level * (1.0 - 1e-3), "whether the level limits friction"),
        "gain": (math.expm1(result.log_ratio), "relative gain of friction"),
        "gain_low": (low, "lower end of its interval"),
        "gain_high": (high, "upper end of its interval"),
        "gain_searched": (
            math.expm1(optimum.log_friction - reference.log_friction),
            "gain on the grid of the search",
        ),
        "gain_optimum": (
            math.expm1(best.log_friction - reference.log_friction),
            "the same of the optimum, which the design stays near",
        ),
        "gain_twice_cut_off": (math.expm1(result.twice_cut_off), "gain with twice the cut-off"),
        "gain_sampling_error": (result.sampling, "standard error from the sampling of the road"),
        "gain_grid_error": (result.grid, "largest error from the grids"),
        "gain_rubber_error": (
            series_error(reference.series, series),
            "standard error from the measurement of the rubber",
        ),
        "gap": (optimum.gap, "what any admissible change could still gain, to first order"),
        "limited_share": (
            float(admissible.at_bound(optimum.ratio).mean()),
            "share of the moduli at a bound or as far from a neighbour as they may be",
        ),
    }
    text = "gain of ln mu by a tenth more room, to first order"
    return scalars(numbers).assign(
        of_compound(problem, rubber, contacts)
        | of_change(admissible, optimum.ratio)
        | {"limit_worth": ("widened", np.array(list(worth.values())), variable_attributes(text))}
    )


def _left_out(case: Case) -> list[str]:
    """Return what the case asks for and a design does not know."""
    effects = {
        "softening": "softening by strain",
        "heat": "heat",
        "shear_stress": "the area term",
    }
    conditions = case.conditions
    asked = [text for name, text in effects.items() if getattr(conditions, name, None) is not None]
    if not asked:
        return []
    return [f"The design leaves out {checks.enumerated(asked)} of the case."]


def _compounds(
    problem: DesignProblem, reference: Reference, rubbers: Mapping[str, Rubber]
) -> tuple[xr.Dataset, tuple[str, ...]]:
    """Return gain and rolling resistance of other compounds, over `compound`, and remarks."""
    if not rubbers:
        return xr.Dataset(), ()
    together, notes = at_one_temperature({"today": problem.rubber, **rubbers})
    parts = []
    for name in rubbers:
        rubber, friction = together[name], problem.friction
        contacts = friction.contacts(rubber, tolerance=DESIGN_TOLERANCE, warm=False)
        result = gain(friction, reference.contacts, contacts)
        low, high = result.interval
        rolling = math.nan
        try:
            require_shift(rubber, problem.rolling.temperature, f"the rolling resistance of {name}")
            rolling = problem.rolling_ratio(rubber)
        except InputError as why:
            notes = (*notes, f"not known: {why}")
        values = {
            "compound_gain": (math.expm1(result.log_ratio), "gain of friction over today's"),
            "compound_gain_low": (low, "lower end of its interval"),
            "compound_gain_high": (high, "upper end of its interval"),
            "compound_rolling_ratio": (rolling, "loss factor when rolling over today's"),
        }
        parts.append(scalars(values))
    names = np.array(list(rubbers), dtype=object)
    data = xr.concat(parts, "compound").assign_coords(compound=("compound", names))
    return data, notes


def _joined(base: xr.Dataset, points: Sequence[xr.Dataset]) -> xr.Dataset:
    """Return the Dataset of a design: today's, compounds, and points by rising level."""
    data = xr.concat(points, "point", combine_attrs="override").sortby("rolling_level")
    return base.merge(data).assign_attrs(base.attrs)


def _key(
    case: Case, problem: DesignProblem, levels: Sequence[float], rubbers: Mapping[str, Any]
) -> str:
    """Return what a design depends on, but for the number of threads, as one word."""
    roads = {goal.road for goal in problem.friction.goals}
    inputs = [
        provenance.software(),
        [case.key, case.origin.text],
        canonical_json(list(problem.friction.goals)),
        canonical_json(problem.limits),
        canonical_json([float(level) for level in levels]),
        {road: identity(problem.roads[road]) for road in sorted(roads)},
        {name: identity(value) for name, value in rubbers.items()},
    ]
    return hashlib.sha256(json.dumps(inputs, sort_keys=True).encode()).hexdigest()[:32]


def _stored_points(folder: Path | None, key: str) -> tuple[dict[float, xr.Dataset], set[float]]:
    """Return the points of an earlier run of the same design by level, and levels without one."""
    stored = None if folder is None else load_stored(folder / DESIGN_FILE)
    if stored is None or stored.attrs.get("design_key") != key:
        return {}, set()
    names = [name for name, variable in stored.data_vars.items() if "point" in variable.dims]
    points = stored[names].drop_vars(list(stored.coords))
    by_level = {
        float(level): points.isel(point=at)
        for at, level in enumerate(stored.rolling_level.values.tolist())
    }
    return by_level, set(json.loads(stored.attrs.get(FRUITLESS, "[]")))


def _order(levels: Sequence[float], problem: DesignProblem) -> list[float]:
    """Return the levels that the limits admit, rising: each admits the optimum of the last."""
    least = problem.admissible().least_loss_factor(problem.rolling)
    reachable = sorted({float(level) for level in levels if level > least})
    if not reachable:
        raise InputError(
            f"levels must include one above {least:.3g}, the least rolling loss factor over "
            f"today's that the limits admit; got {', '.join(f'{level:g}' for level in levels)}"
        )
    return reachable
