"""Design of a compound: more friction on a measured road for a given rolling resistance.

A point of the trade-off curve is the admissible compound with the most friction
(`compound_search`) whose rolling resistance is at most `level` times today's. The levels rise; each
is sought from today's compound and from the point before, which it admits too, and the better end
counts. Friction and gain of a point are those of contacts solved anew (`goal_friction`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.core import ZERO_CELSIUS, Array, InputError, checks
from gripscale.experiment.design import variable_attributes
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.experiment.task import Task
from gripscale.half_space.model import DirectContact
from gripscale.half_space.result import RoughContact
from gripscale.questions.answer.variables import believed
from gripscale.questions.design import compound_limits, compound_search
from gripscale.questions.design.compound_search import ROLLING_LEVEL, DesignProblem, nearest_design
from gripscale.questions.design.goal_friction import DESIGN_TOLERANCE, Gain, SolvedCompound, gain
from gripscale.questions.vary.friction_ratio import series_error
from gripscale.questions.vary.inputs import at_temperature, model_of
from gripscale.questions.vary.ranking import at_one_temperature
from gripscale.rubber import Rubber

LIMITED = "share of the moduli at a bound or as far from a neighbour as they may be"
WORTH = "gain of ln mu by a tenth more room, to first order"
# Attribute of a design: levels that are left out because a lower one has as much friction.
FRUITLESS = "levels_without_more_friction"
# The loss factor that is the rule of thumb for wet grip.
WET = compound_limits.PointLimit("loss_factor", 0.0, 1.0, 10.0, ZERO_CELSIUS)
FREQUENCIES_PER_DECADE = 8  # frequencies of a stored master curve in a decade
EXCITED = 0.01  # share of the friction below and above the frequencies that count as excited


# A number or an array with its meaning, its unit if it has one, and its dimension.
Quantities = Mapping[str, tuple[Any, ...]]


def variables(quantities: Quantities, before: str = "") -> dict[str, xr.Variable]:
    """Return quantities as variables whose names begin with `before`."""

    def variable(values: Any, text: str, unit: str = "1", dim: str = "") -> xr.Variable:
        return xr.Variable((dim,) if dim else (), values, variable_attributes(text, unit))

    return {f"{before}{name}": variable(*quantity) for name, quantity in quantities.items()}


def todays_compound(
    problem: DesignProblem, contacts: Sequence[RoughContact], answers: Array
) -> xr.Dataset:
    """Return today's compound with its answers, goals and limits: what no point changes."""
    rubber, weights = problem.rubber, problem.friction.weights
    low, high = np.transpose([_excited(contact) for contact in contacts])
    times = np.concatenate([[math.inf], rubber.relaxation_times])
    limits = [str(point) for point in problem.admissible().points]
    factors = compound_search.LARGEST_FACTOR, compound_search.PER_DECADE
    names = {
        "goal": [str(goal) for goal in problem.friction.goals],
        "limit": limits,
        "widened": [*factors, *limits, ROLLING_LEVEL],
    }
    kelvin = rubber.reference_temperature
    numbers: Quantities = {
        "excited_low": (low.min(), "excited from", "Hz"),
        "excited_high": (high.max(), "up to", "Hz"),
        "goal_weight": (weights, "weight of the goal", "1", "goal"),
        "today_answer_friction": (answers, "friction of the answer", "1", "goal"),
    }
    axes: Quantities = {
        "relaxation_time": (times, "relaxation time", "s", "term"),
        "frequency": (_frequencies(rubber), "frequency", "Hz", "frequency"),
    }
    return xr.Dataset(
        variables(_of_compound(problem, rubber, contacts), "today_") | variables(numbers),
        {dim: (dim, np.array(texts, dtype=object)) for dim, texts in names.items()}
        | variables(axes),
        {
            "title": "Design of a compound: friction against rolling resistance",
            "rubber": f"{rubber.name}; {rubber.source}".strip("; "),
            "rolling_condition": problem.rolling[0].condition,
            "rolling_band": compound_limits.band_in_words(problem.rolling),
            "wet_condition": "" if rubber.shift is None else WET.within_shift(rubber).condition,
            "reference_temperature": math.nan if kelvin is None else kelvin,
            "largest_factor": problem.limits.largest_factor,
            "factor_per_decade": problem.limits.factor_per_decade,
            "tolerance": DESIGN_TOLERANCE,
        },
    )


def _excited(contact: RoughContact) -> Array:
    """Return the frequencies between which a contact loses 98 % of its energy [Hz]."""
    lost = np.maximum(contact.lost_by_harmonic(), 0.0)
    omega = np.broadcast_to(np.abs(contact.grid.along) * contact.speed, lost.shape)
    order = np.argsort(omega, axis=None)
    share = np.cumsum(lost.reshape(-1)[order]) / lost.sum()
    ends = np.searchsorted(share, [EXCITED, 1.0 - EXCITED])
    return np.asarray(omega.reshape(-1)[order][ends] / (2.0 * math.pi))


def _frequencies(rubber: Rubber) -> Array:
    """Return the frequencies of a stored master curve [Hz]: its measured band, or its times."""
    times = rubber.relaxation_times
    low, high = rubber.valid_band or (0.1 / times.max(initial=1.0), 10.0 / times.min(initial=1.0))
    count = max(2, math.ceil(FREQUENCIES_PER_DECADE * math.log10(high / low)) + 1)
    return np.asarray(np.geomspace(low, high, count) / (2.0 * math.pi))


def _of_compound(
    problem: DesignProblem, rubber: Rubber, contacts: Sequence[RoughContact]
) -> Quantities:
    """Return friction and contact at the goals, moduli and master curve of a compound."""
    omega = 2.0 * math.pi * _frequencies(problem.rubber)
    storage, loss = (parts.sum(axis=-1) for parts in compound_limits.modulus_parts(rubber, omega))
    lost, traction, area = (
        problem.friction.averaged([getattr(contact, name) for contact in contacts])
        for name in ("friction_from_dissipation", "friction", "contact_fraction")
    )
    rolling = problem.rolling[0].value(rubber)
    wet = math.nan if rubber.shift is None else WET.within_shift(rubber).value(rubber)
    text = "E_inf, and moduli of the Prony series"
    return {
        "friction": (lost, "friction coefficient from the energy lost", "1", "goal"),
        "friction_from_traction": (traction, "the same from the traction", "1", "goal"),
        "contact_fraction": (area, "real over nominal contact area", "1", "goal"),
        "modulus": (compound_limits.all_moduli(rubber), text, "Pa", "term"),
        "storage": (storage, "storage modulus", "Pa", "frequency"),
        "loss": (loss, "loss modulus", "Pa", "frequency"),
        "rolling_loss_factor": (rolling, "tan(delta) at the first rolling condition"),
        "wet_loss_factor": (wet, "tan(delta) of the rule for wet grip"),
    }


def _of_gain(result: Gain) -> Quantities:
    low, high = result.interval
    return {
        "gain": (math.expm1(result.log_ratio), "relative gain of friction"),
        "gain_low": (low, "lower end of its interval"),
        "gain_high": (high, "upper end of its interval"),
    }


def solved_point(
    problem: DesignProblem, today: SolvedCompound, level: float, before: Sequence[xr.Dataset]
) -> xr.Dataset:
    """Return one point of the curve, sought from today's compound and from the point before it."""
    friction, admissible = problem.friction, problem.admissible(level)
    starts = [problem.unchanged]
    starts += [np.asarray(point.modulus_ratio.values, dtype=float) for point in before]
    optima = [compound_search.best_change(friction, admissible, start) for start in starts]
    best = max(optima, key=lambda optimum: optimum.log_friction)
    optimum = nearest_design(friction, admissible, best)
    rubber = compound_limits.changed(problem.rubber, optimum.ratio)
    compound = SolvedCompound.of(friction, rubber, problem.rubber)
    error = series_error(compound.series - today.series)
    result = gain(friction, today.contacts, compound.contacts, error)
    worth = problem.worth_of_limits(level, best.slope)
    least, _ = friction.log_friction(problem.unchanged)
    searched, sought = (math.expm1(end.log_friction - least) for end in (optimum, best))
    rolling = compound_limits.rolling_ratio(problem.rolling, rubber, problem.rubber)
    limited_ratio = [point.ratio(rubber, problem.rubber) for point in admissible.points]
    reached = worth[ROLLING_LEVEL] > compound_search.LEAST_GAP
    numbers = {
        "rolling_level": (level, "largest rolling resistance over today's"),
        "rolling_ratio": (rolling, "rolling resistance over today's, the worst of its band"),
        "rolling_reached": (reached, "whether the level limits friction"),
        **_of_gain(result),
        "gain_searched": (searched, "gain on the grid of the search"),
        "gain_optimum": (sought, "the same of the optimum, which the design stays near"),
        "gain_twice_cut_off": (math.expm1(result.twice_cut_off), "gain with twice the cut-off"),
        "gain_sampling_error": (result.sampling, "standard error from the sampling of the surface"),
        "gain_grid_error": (result.grid, "largest error from the grids"),
        "gain_rubber_error": (result.rubber, "standard error from the measurement of the rubber"),
        "gap": (optimum.gap, "what any admissible change could still gain, to first order"),
        "limited_share": (float(admissible.at_bound(optimum.ratio).mean()), LIMITED),
        **_of_compound(problem, rubber, compound.contacts),
        "modulus_ratio": (optimum.ratio, "modulus over today's, E_inf first", "1", "term"),
        "limited_ratio": (np.array(limited_ratio), "limited modulus over today's", "1", "limit"),
        "limit_worth": (np.array([*worth.values()]), WORTH, "1", "widened"),
    }
    return xr.Dataset(variables(numbers))


def todays_answers(
    case: Case, problem: DesignProblem, folder: str | Path | None, on_task: OnTask | None
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


def left_out(case: Case) -> str:
    """Return what the case asks for and a design does not know; empty if it knows all of it."""
    effects = {"softening": "softening by strain", "heat": "heat", "shear_stress": "the area term"}
    conditions = case.conditions
    texts = [text for name, text in effects.items() if getattr(conditions, name, None) is not None]
    return checks.enumerated(texts) if texts else ""


def other_compounds(
    problem: DesignProblem, today: SolvedCompound, rubbers: Mapping[str, Rubber]
) -> tuple[xr.Dataset, tuple[str, ...]]:
    """Return gain and rolling resistance of other compounds, over `compound`, and remarks."""
    if not rubbers:
        return xr.Dataset(), ()
    together, notes = at_one_temperature({"today": problem.rubber, **rubbers})
    parts = []
    for name in rubbers:
        rubber = together[name]
        compound = SolvedCompound.of(problem.friction, rubber, rubber)
        errors = [series_error(each) for each in (today.series, compound.series) if each.size]
        error = math.hypot(*errors) if errors else math.nan
        result = gain(problem.friction, today.contacts, compound.contacts, error)
        rolling = math.nan
        try:
            for point in problem.rolling:
                compound_limits.require_shift(
                    rubber, point.temperature, f"the rolling resistance of {name}"
                )
            rolling = compound_limits.rolling_ratio(problem.rolling, rubber, problem.rubber)
        except InputError as why:
            notes = (*notes, f"not known: {why}")
        numbers = {
            **_of_gain(result),
            "rolling_ratio": (rolling, "rolling resistance over today's"),
        }
        parts.append(xr.Dataset(variables(numbers, "compound_")))
    names = np.array(list(rubbers), dtype=object)
    return xr.concat(parts, "compound").assign_coords(compound=("compound", names)), notes
