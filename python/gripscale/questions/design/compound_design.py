"""Design of a compound: more friction on a measured road for a given rolling resistance.

A point of the trade-off curve is the admissible compound with the most friction
(`compound_search`) whose rolling resistance (`rolling`) is at most `level` times today's. The
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
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.core import Array, InputError, checks, provenance
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.experiment.task import Task, canonical_json, load_stored
from gripscale.half_space.model import DirectContact
from gripscale.half_space.result import RoughContact
from gripscale.questions.design.compound_gain import gain, series_derivatives
from gripscale.questions.design.compound_limits import changed, require_shift
from gripscale.questions.design.compound_search import (
    LEAST_GAP,
    ROLLING_LEVEL,
    DesignProblem,
    best_change,
    nearest_design,
)
from gripscale.questions.design.design_dataset import of_change, of_compound, variable
from gripscale.questions.design.goal_friction import GoalFriction
from gripscale.questions.design.rolling import rolling_ratio
from gripscale.questions.vary.friction_ratio import series_error
from gripscale.questions.vary.inputs import at_temperature, identity, model_of
from gripscale.questions.vary.ranking import at_one_temperature
from gripscale.questions.words import believed
from gripscale.rubber import Rubber

DESIGN_FILE = "design.nc"
# Estimated relative error of the contacts whose friction is stated, as in comparisons.
DESIGN_TOLERANCE = 0.05
# Attribute of a design: levels that are left out because a lower one has as much friction.
FRUITLESS = "levels_without_more_friction"


@dataclass(frozen=True)
class Reference:
    """Today's compound, solved as each point is: on the grid of the search and on fine ones."""

    contacts: Sequence[RoughContact] = field(repr=False)
    log_friction: float
    series: Array = field(repr=False)

    @classmethod
    def of(cls, friction: GoalFriction) -> Reference:
        """Solve today's compound."""
        value, _ = friction.log_friction(np.ones(1 + friction.rubber.moduli.size))
        series = series_derivatives(friction, friction.contacts(friction.rubber), friction.rubber)
        fine = friction.contacts(friction.rubber, tolerance=DESIGN_TOLERANCE)
        return cls(fine, value, series)


def solved_point(
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
    series = series_derivatives(friction, friction.contacts(rubber), problem.rubber)
    contacts = friction.contacts(rubber, tolerance=DESIGN_TOLERANCE)
    error = series_error(series - reference.series)
    result = gain(friction, reference.contacts, contacts, error)
    rolling = rolling_ratio(problem.rolling, rubber, problem.rubber)
    worth = problem.worth_of_limits(level, best.slope)
    low, high = result.interval
    searched, sought = (
        math.expm1(end.log_friction - reference.log_friction) for end in (optimum, best)
    )
    limited = float(admissible.at_bound(optimum.ratio).mean())
    numbers = {
        "rolling_level": (level, "largest rolling resistance over today's"),
        "rolling_ratio": (rolling, "rolling resistance over today's, the worst of its band"),
        "rolling_reached": (worth[ROLLING_LEVEL] > LEAST_GAP, "whether the level limits friction"),
        "gain": (math.expm1(result.log_ratio), "relative gain of friction"),
        "gain_low": (low, "lower end of its interval"),
        "gain_high": (high, "upper end of its interval"),
        "gain_searched": (searched, "gain on the grid of the search"),
        "gain_optimum": (sought, "the same of the optimum, which the design stays near"),
        "gain_twice_cut_off": (math.expm1(result.twice_cut_off), "gain with twice the cut-off"),
        "gain_sampling_error": (result.sampling, "standard error from the sampling of the surface"),
        "gain_grid_error": (result.grid, "largest error from the grids"),
        "gain_rubber_error": (result.rubber, "standard error from the measurement of the rubber"),
        "gap": (optimum.gap, "what any admissible change could still gain, to first order"),
        "limited_share": (
            limited,
            "share of the moduli at a bound or as far from a neighbour as they may be",
        ),
    }
    text = "gain of ln mu by a tenth more room, to first order"
    return xr.Dataset(
        {name: variable(*pair) for name, pair in numbers.items()}
        | of_compound(problem, rubber, contacts)
        | of_change(admissible, optimum.ratio)
        | {"limit_worth": variable(np.array(list(worth.values())), text, dim="widened")}
    )


def todays_answers(
    case: Case, problem: DesignProblem, folder: Path | None, on_task: OnTask | None
) -> Array:
    """Return the friction of today's compound at each goal, as `gripscale.answer` states it [-]."""
    model, tasks = model_of(DirectContact.name, case), {}
    for goal in problem.friction.goals:
        of_goal = model if goal.temperature is None else at_temperature(model, goal.temperature)
        load = replace(case.load, speed=goal.speed, pressure=goal.pressure)
        road = problem.roads[goal.road]
        tasks[f"today, {goal}"] = Task(problem.rubber, road, load, of_goal)
    with bench_in(folder, problem.friction.workers, None, on_task) as bench:
        solved = bench.solve(tasks)
    answers = [solved[task.key] for task in tasks.values()]
    return np.array([float(answer[believed(answer, "friction")]) for answer in answers])


def left_out(case: Case) -> list[str]:
    """Return what the case asks for and a design does not know."""
    effects = {"softening": "softening by strain", "heat": "heat", "shear_stress": "the area term"}
    conditions = case.conditions
    asked = [text for name, text in effects.items() if getattr(conditions, name, None) is not None]
    return [f"The design leaves out {checks.enumerated(asked)} of the case."] if asked else []


def other_compounds(
    problem: DesignProblem, reference: Reference, rubbers: Mapping[str, Rubber]
) -> tuple[xr.Dataset, tuple[str, ...]]:
    """Return gain and rolling resistance of other compounds, over `compound`, and remarks."""
    if not rubbers:
        return xr.Dataset(), ()
    together, notes = at_one_temperature({"today": problem.rubber, **rubbers})
    parts = []
    for name in rubbers:
        rubber, friction = together[name], problem.friction
        contacts = friction.contacts(rubber, tolerance=DESIGN_TOLERANCE)
        series = series_derivatives(friction, friction.contacts(rubber), rubber)
        errors = [series_error(each) for each in (reference.series, series) if each.size]
        error = math.hypot(*errors) if errors else math.nan
        result = gain(friction, reference.contacts, contacts, error)
        low, high = result.interval
        rolling = math.nan
        try:
            for point in problem.rolling:
                require_shift(rubber, point.temperature, f"the rolling resistance of {name}")
            rolling = rolling_ratio(problem.rolling, rubber, problem.rubber)
        except InputError as why:
            notes = (*notes, f"not known: {why}")
        values = {
            "compound_gain": (math.expm1(result.log_ratio), "gain of friction over today's"),
            "compound_gain_low": (low, "lower end of its interval"),
            "compound_gain_high": (high, "upper end of its interval"),
            "compound_rolling_ratio": (rolling, "rolling resistance over today's"),
        }
        parts.append(xr.Dataset({name: variable(*pair) for name, pair in values.items()}))
    names = np.array(list(rubbers), dtype=object)
    data = xr.concat(parts, "compound").assign_coords(compound=("compound", names))
    return data, notes


def design_key(
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


def stored_points(folder: Path | None, key: str) -> tuple[dict[float, xr.Dataset], set[float]]:
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


def rising_levels(levels: Sequence[float], problem: DesignProblem) -> list[float]:
    """Return the levels that the limits admit, rising: each admits the optimum of the last."""
    least = problem.least_level()
    reachable = sorted({float(level) for level in levels if level > least})
    if not reachable:
        raise InputError(
            f"levels must include one above {least:.3g}, the least rolling resistance over "
            f"today's that the limits admit; got {', '.join(f'{level:g}' for level in levels)}"
        )
    return reachable
