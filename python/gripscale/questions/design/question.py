"""What compound is better: more friction on a measured road for a given rolling resistance.

result = gs.design(case, levels=[0.9, 1.0, 1.1])
result.data.gain
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, YELLOW
from gripscale.core import InputError, checks, doubt, parse_quantity
from gripscale.core.units import MEGA
from gripscale.experiment.design import variable_attributes
from gripscale.experiment.solve import OnTask
from gripscale.io.folders import make_folder, write_text
from gripscale.io.table import Column, Table, change, fixed, percent, significant
from gripscale.questions.design import compound_design, compound_limits
from gripscale.questions.design.compound_limits import CompoundLimits, PointLimit
from gripscale.questions.design.compound_search import PRECISION, design_problem
from gripscale.questions.design.goal_friction import CompoundGoal, SolvedCompound
from gripscale.questions.inputs import record
from gripscale.questions.result import Result
from gripscale.questions.vary.axis import values_by_name
from gripscale.questions.vary.inputs import measured_rubber_of, reading_notes
from gripscale.rubber import MasterCurve, Rubber, write_master_curve

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OnPoint = Callable[[xr.Dataset], object]
PERCENT = 100.0
SAME = 5e-3  # relative difference of rolling resistances that is none
_FREQUENCY = PlotAxis("frequency [Hz]", log=True, numbers=5)
# Difference of rolling resistances over today's from which both curves can be told apart.
_APART = 0.05
COMPOUND_COLOURS = (PURPLE, YELLOW, SKY, GREY)


def answering_point(data: xr.Dataset) -> int:
    """Return the last point whose rolling resistance is at most today's; without one the last."""
    allowed = np.flatnonzero(data.rolling_ratio.values <= 1.0 + 1e-6)
    return int(allowed[-1]) if allowed.size else data.sizes["point"] - 1


def design_figure(data: xr.Dataset) -> Figure:
    """Draw the trade-off curve of a design, and moduli, loss factor and change of some points."""
    ratio, answer = data.rolling_ratio.values, answering_point(data)
    colours = {0: BLUE, data.sizes["point"] - 1: ORANGE, answer: GREEN}
    drawn = {  # the answer, and ends apart from it
        at: colours[at]
        for at in sorted(colours)
        if at == answer or abs(ratio[at] - ratio[answer]) > _APART
    }
    panels = [_trade_off_panel(data, drawn), *_master_curve_panels(data, drawn)]
    return Sheet(panels, 2, height=5.6, legend_columns=4).on_paper()


def _trade_off_panel(data: xr.Dataset, drawn: dict[int, str]) -> Panel:
    rolling = PERCENT * (data.rolling_ratio.values - 1.0)
    low, gain, high = (PERCENT * data[name].values for name in ("gain_low", "gain", "gain_high"))
    marks: list[Mark] = [
        CrossLine(0.0, width=0.7),
        CrossLine(0.0, width=0.7, upright=True),
        Series(rolling, gain, INK, marker="o", size=3.0, low=low, high=high),
        Series([0.0], [0.0], INK, "today", "", marker="s", size=6.0),
    ]
    for at, colour in drawn.items():
        label = f"rolling resistance {rolling[at]:+.0f} %"
        if abs(rolling[at]) < PERCENT * SAME:
            label = "same rolling resistance"
        marks.append(
            Series([rolling[at]], [gain[at]], colour, label, "", marker="o", size=6.0, order=3.0)
        )
    names = data.compound.values.tolist() if "compound" in data.dims else ()
    numbers = [f"compound_{key}" for key in ("rolling_ratio", "gain", "gain_low", "gain_high")]
    for at, (name, colour) in enumerate(zip(names, cycle(COMPOUND_COLOURS), strict=False)):
        x, y, low, high = (PERCENT * data[number].values[[at]] for number in numbers)
        marks.append(
            Series(x - PERCENT, y, colour, name, "", marker="D", size=5.0, low=low, high=high)
        )
    ordinate = PlotAxis("friction gained [%]", margin=0.1)
    return Panel(PlotAxis("change of rolling resistance [%]"), ordinate, marks)


def _master_curve_panels(data: xr.Dataset, drawn: dict[int, str]) -> list[Panel]:
    """Return moduli, loss factor, and moduli over today's; dotted lines enclose those excited."""
    ends = ((data.excited_low, "98 % of the friction between"), (data.excited_high, ""))
    excited: list[Mark] = [
        CrossLine(float(end), GREY, label, "dotted", upright=True) for end, label in ends
    ]
    frequency, (moduli, factor, change) = data.frequency.values, ([*excited] for _ in range(3))
    today = data.today_storage, data.today_loss
    for storage, loss, colour, width in (
        (*today, INK, 1.6),
        *((data.storage[at], data.loss[at], colour, 1.0) for at, colour in drawn.items()),
    ):
        for modulus, old, name, dash in (
            (storage, today[0], "$E'$", "dashdot"),
            (loss, today[1], "$E''$", "solid"),
        ):
            label = name if colour == INK else ""
            moduli.append(Series(frequency, modulus / MEGA, colour, label, dash, width=width))
            change.append(Series(frequency, modulus / old, colour, "", dash, width=width))
        factor.append(Series(frequency, loss / storage, colour, width=width))
    return [
        Panel(_FREQUENCY, PlotAxis("modulus [MPa]", log=True), moduli),
        Panel(_FREQUENCY, PlotAxis("loss factor tan δ [-]", low=0.0), factor),
        Panel(_FREQUENCY, PlotAxis("modulus over today's [-]"), change),
    ]


class CompoundDesign(Result):
    """The trade-off curve of a case: friction of new compounds against rolling resistance."""

    kind = "design"

    @property
    def lines(self) -> Sequence[str]:
        data, attrs = self.data, self.data.attrs
        chosen = data.isel(point=answering_point(data))
        now, then = data.today_answer_friction.values, chosen.answer_friction.values
        goals = [f" at {goal}" for goal in data.goal.values] if now.size > 1 else [""]
        rows = zip(now, then, goals, strict=True)
        pairs = ", ".join(f"{old:.3f} now → {new:.3f}{at}" for old, new, at in rows)
        without = f"; without {attrs['left_out']} of the case" if attrs.get("left_out") else ""
        lines = [f"Answer: friction {pairs} with the design {_trade(chosen)}{without}."]
        least = rolling_at_todays_friction(data)
        if math.isfinite(least):
            lines.append(f"  Or the same friction with rolling resistance {change(least - 1.0)}.")
        fruitless = json.loads(attrs.get(compound_design.FRUITLESS, "[]"))
        if fruitless and fruitless[-1] > data.rolling_level[-1]:
            last = change(float(data.rolling_ratio[-1]) - 1.0)
            lines.append(f"  More rolling resistance than {last} gives no more friction.")
        worth = zip(chosen.widened.values, np.expm1(chosen.limit_worth.values), strict=True)
        relaxed = "; ".join(f"{name}, {change(float(gain))}" for name, gain in worth)
        sources = {
            "pieces of the surface": float(chosen.gain_sampling_error),
            "grids": float(chosen.gain_grid_error) / math.sqrt(3.0),
            "measurement of the rubber": float(chosen.gain_rubber_error),
        }
        errors = ", ".join(
            f"{words} {percent(error) if math.isfinite(error) else 'not known'}"
            for words, error in sources.items()
        )
        return (
            *lines,
            f"  Rolling resistance is tan δ and loss compliance at {attrs['rolling_band']}, the "
            f"worst of them; today tan δ is {significant(float(data.today_rolling_loss_factor))} "
            f"at {attrs['rolling_condition']}.",
            f"  A limit relaxed by a tenth gives, to first order: {relaxed}.",
            f"  The interval holds (standard errors): {errors}; with twice the cut-off of the "
            f"surface {change(float(chosen.gain_twice_cut_off))}.",
            *(f"note: {note}" for note in attrs.get("notes", "").splitlines()),
        )

    def parts(self) -> Iterator[str | Table]:
        yield self.table()
        if "compound" in self.data.dims:
            columns = _gain_columns(self.data, "compound_", "rolling resistance, change")
            names = Column("compound", self.data.compound.values)
            yield Table("compounds", [names, *columns], "Other compounds beside today's")

    def table(self) -> Table:
        """Return the points of the curve."""
        data, notes = self.data, []
        columns = [
            Column("rolling_loss_factor", data.rolling_loss_factor.values, "tan δ rolling"),
            *_gain_columns(data, "", "rolling resistance"),
        ]
        for at, goal in enumerate(data.goal.values.tolist()):
            friction = data.answer_friction.values[:, at]
            columns.append(Column(f"friction_{at + 1}", friction, f"μ {at + 1}"))
            notes.append(f"μ {at + 1}: {goal}")
        for at, limit in enumerate(data.limit.values.tolist()):
            name = limit.split(" at ")[0]
            values = data.limited_ratio.values[:, at]
            columns.append(Column(f"limit_{at + 1}", values, f"{name} / today", format=fixed(2)))
        if bool(np.isfinite(data.wet_loss_factor.values).all()):
            columns.append(Column("wet_loss_factor", data.wet_loss_factor.values, "tan δ wet"))
            wet = data.attrs.get("wet_condition", "10 Hz and 0 °C")
            notes.append(f"tan δ wet: at {wet}, the rule of thumb for wet grip")
        columns += [
            Column("limited_share", data.limited_share.values, "at a limit", format=percent),
            Column("gap", data.gap.values, "left to gain", format=change),
        ]
        title = "Trade-off: each row is the admissible compound of most friction"
        return Table("design", columns, title, notes)

    def pictures(self) -> Iterator[Picture]:
        caption = (
            "Friction gained against rolling resistance, and the master curves of some points "
            "beside today's."
        )
        alt = "A curve of friction over rolling resistance, and three panels over the frequency."
        yield Picture("design", design_figure(self.data), caption, alt)


def _gain_columns(data: xr.Dataset, of: str, heading: str) -> list[Column]:
    rolling = data[f"{of}rolling_ratio"].values - 1.0
    ends = np.column_stack([data[f"{of}gain_{end}"].values for end in ("low", "high")])
    return [
        Column("rolling_change", rolling, heading, format=change),
        Column("gain", data[f"{of}gain"].values, "friction gained", format=change),
        Column("gain_interval", ends, "90 % interval", format=change),
    ]


def rolling_at_todays_friction(data: xr.Dataset) -> float:
    """Return the least rolling resistance over today's with today's friction [-].

    Linear between the points; NaN if the lowest point still has more friction than today's.
    """
    ratio, gain = data.rolling_ratio.values, data.gain.values
    above = np.flatnonzero(gain >= 0.0)
    if not above.size or above[0] == 0:
        return math.nan
    low, high = above[0] - 1, above[0]
    share = -gain[low] / (gain[high] - gain[low])
    return float(ratio[low] + share * (ratio[high] - ratio[low]))


def _trade(point: xr.Dataset) -> str:
    """Return the rolling resistance of a point and the friction gained with it."""
    rolling, low, high = (float(point[n]) for n in ("rolling_ratio", "gain_low", "gain_high"))
    at = f"with rolling resistance {change(rolling - 1.0)}"
    if abs(rolling - 1.0) < SAME:
        at = "at the same rolling resistance"
    interval = f" ({change(low)} to {change(high)})" if math.isfinite(low) else ""
    return f"{at}: {change(float(point.gain))}{interval}"


def design(
    case: Case,
    *,
    goals: Sequence[CompoundGoal] = (),
    limits: CompoundLimits | None = None,
    levels: Sequence[float] = (),
    rubbers: Mapping[str, Any] | None = None,
    roads: Mapping[str, Any] | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    on_point: OnPoint | None = None,
    on_task: OnTask | None = None,
) -> CompoundDesign:
    """Return the trade-off curve of a case: friction of new compounds by rolling resistance.

    Small strain, direct contact, hysteresis alone: of the conditions of the case only the
    temperature counts.

    The result is over `point`, by rising level: `gain` with `gain_low` and `gain_high` (90 %),
    friction, moduli and master curve; over `compound` the other compounds; today's values without
    either. Raises `InputError`, `FileError` or `ConvergenceError` if the case, a goal, a limit or a
    temperature cannot be used, or today's compound has no friction.

        >>> print(gs.design(case, levels=[1.0]).lines[0])
        Answer: friction 0.036 now → 0.056 with the design at the same rolling resistance: +57.4 %.

    Parameters
    ----------
    case : Case
        Road, today's compound, load and temperature.
    goals : sequence of CompoundGoal, optional
        Where friction is wanted; by default at the load of the case.
    limits : CompoundLimits, optional
        How far the compound may be changed.
    levels : sequence of float, optional
        Largest rolling resistances over today's [-]. By default today's, four down to the least
        that the limits admit, and 1.15 and 1.3. A level below the least is left out, and one that
        gives no more friction than a lower one.
    rubbers : mapping, optional
        Other compounds by name, to be compared with the curve.
    roads : mapping, optional
        Surfaces of the goals by the names that the goals use.
    folder : path, optional
        Keeps the answers of today's compound, which are not solved again.
    workers : int, optional
        Threads; one per core by default.
    on_point : callable, optional
        Called with the Dataset of each point as it is solved.
    on_task : callable, optional
        Called with today's answer at each goal, as for `gripscale.experiment.Bench`.
    """
    problem = design_problem(case, goals, limits, workers, roads)
    wanted = [checks.positive("level", level) for level in levels] or problem.default_levels()
    least = problem.least_level()
    rising = sorted({float(level) for level in wanted if level > least})
    if not rising:
        raise InputError(
            f"levels must include one above {least:.3g}, the least rolling resistance over "
            f"today's that the limits admit; got {', '.join(f'{level:g}' for level in wanted)}"
        )
    now = compound_design.todays_answers(case, problem, folder, on_task)
    problem.friction.log_friction(problem.unchanged)  # all contacts start from these
    reference = SolvedCompound.of(problem.friction, problem.rubber, problem.rubber)
    named = {name: measured_rubber_of(value, case) for name, value in (rubbers or {}).items()}
    compounds = {name: each.rubber for name, each in named.items()}
    others, notes = compound_design.other_compounds(problem, reference, compounds)
    base = compound_design.todays_compound(problem, reference.contacts, now).merge(others)
    base = base.assign_attrs(
        case.attributes,
        rubber_parameters=json.dumps(problem.rubber.to_dict()),
        notes="\n".join(notes),
        left_out=compound_design.left_out(case),
    )
    loads = [
        replace(case.load, speed=goal.speed, pressure=goal.pressure)
        for goal in problem.friction.goals
    ]
    of_compounds = [doubt(text) for text in reading_notes((rubbers or {}).values())]
    of_compounds += [d.about(name) for name, each in named.items() for d in each.doubts]
    points, fruitless = list[xr.Dataset](), set[float]()
    for level in rising:  # each admits the optimum of the last
        point = compound_design.solved_point(problem, reference, level, points[-1:])
        answers = base.today_answer_friction * (point.friction / base.today_friction)
        text = "friction of the answer with the design"
        point["answer_friction"] = answers.assign_attrs(variable_attributes(text))
        if not points or float(point.gain - points[-1].gain) > PRECISION:
            points.append(point)
            if on_point is not None:
                on_point(point)
        else:
            fruitless.add(level)
        if not bool(point.rolling_reached):
            fruitless |= {higher for higher in rising if higher > level}
            break
    data = base.merge(xr.concat(points, "point", combine_attrs="override"))
    data.attrs[compound_design.FRUITLESS] = json.dumps(sorted(fruitless))
    return CompoundDesign(data, record.inputs(case, problem.roads.values(), loads, of_compounds))


# What a goal may state beside `weight` and `road`.
GOAL_QUANTITIES = ("speed", "pressure", "temperature")


def parse_goal(text: str, default: CompoundGoal) -> CompoundGoal:
    """Return a goal stated as "speed=3 m/s, temperature=20 C, weight=2, road=wet.toml".

    What it does not state is that of `default`. Raises `InputError` if it cannot be understood.
    """
    values: dict[str, Any] = {name: getattr(default, name) for name in GOAL_QUANTITIES}
    readers: dict[str, Callable[[str], Any]] = {"weight": float, "road": str}
    example = "speed=3 m/s, temperature=20 C, pressure=2 bar, weight=1, road=case"
    for name, value in values_by_name(text.split(","), "goal", example).items():
        checks.one_of("goal", name, (*GOAL_QUANTITIES, *readers))
        try:
            values[name] = readers.get(name, partial(parse_quantity, kind=name))(value)
        except ValueError as error:
            raise InputError(f"goal {name} = {value!r}: {error}") from error
    return CompoundGoal(**values)


def parse_limit(text: str) -> PointLimit:
    """Return a limit stated as "loss_factor, 10 Hz, 0 C, 0.9:1.2" (the range over today's value).

    The temperature may be left out. Raises `InputError` if it cannot be understood.
    """
    parts = [part.strip() for part in text.split(",")]
    low, sign, high = parts[-1].partition(":")
    quantities = compound_limits.LIMITED_QUANTITIES
    if len(parts) not in (3, 4) or not sign or parts[0] not in quantities:
        example = f'"{quantities[0]}, 10 Hz, 20 C, 0.9:1.1"'
        raise InputError(f"limit must be such as {example}; got {checks.short_repr(text)}")
    try:
        hertz = float(parts[1].removesuffix("Hz"))
        kelvin = parse_quantity(parts[2], "temperature") if len(parts) == 4 else None
        ends = float(low), float(high)
    except ValueError as error:
        raise InputError(f"limit {text!r}: {error}") from error
    return PointLimit(parts[0], *ends, hertz, kelvin)


def parse_levels(text: str) -> list[float]:
    """Return levels stated as "0.8,1,1.2"; raise `InputError` if one is no number above zero."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError as error:
        raise InputError(f'levels must be such as "0.8,1,1.2"; got {text!r}') from error
    return [float(number) for number in checks.positive_vector("levels", numbers)]


def designed_rubber(data: xr.Dataset, point: int) -> Rubber:
    """Return the rubber that a point of a design asks for."""
    today = Rubber.from_dict(json.loads(data.attrs["rubber_parameters"]))
    chosen = data.isel(point=point)
    name = f"target_{round(100.0 * float(chosen.rolling_ratio)):03d}"
    return compound_limits.changed(today, np.asarray(chosen.modulus_ratio.values), name=name)


def write_targets(data: xr.Dataset, folder: str | Path) -> list[Path]:
    """Write master curve (CSV) and rubber (JSON) of each point.

    The number in the name is tan(delta) at the rolling condition in per cent of today's. The JSON
    file is what `gripscale export rubber` takes. Returns the paths.
    """
    target = Path(folder)
    make_folder(target)
    paths = []
    for at in range(data.sizes["point"]):
        rubber, point = designed_rubber(data, at), data.isel(point=at)
        frequency, storage, loss = point.frequency.values, point.storage.values, point.loss.values
        source = f"design of gripscale, not measured; from {data.attrs['rubber']}"
        kelvin = rubber.reference_temperature
        curve = MasterCurve(frequency, storage, loss, kelvin, rubber.name, source)
        text = json.dumps(rubber.to_dict(), indent=1)
        paths.append(write_master_curve(target / f"{rubber.name}.csv", curve))
        paths.append(write_text(target / f"{rubber.name}.json", text))
    return paths
