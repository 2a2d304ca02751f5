"""What compound is better: more friction on a measured road for a given rolling resistance.

result = gs.design(case, levels=[0.9, 1.0, 1.1])
result.data.gain
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import xarray as xr

from gripscale.case import Case
from gripscale.core import checks, doubt
from gripscale.experiment.solve import OnTask
from gripscale.io import netcdf
from gripscale.io.folders import make_folder
from gripscale.io.table import Table
from gripscale.questions.design import page
from gripscale.questions.design.compound_design import (
    DESIGN_FILE,
    DESIGN_TOLERANCE,
    FRUITLESS,
    Reference,
    design_key,
    left_out,
    other_compounds,
    rising_levels,
    solved_point,
    stored_points,
    todays_answers,
)
from gripscale.questions.design.compound_limits import CompoundLimits
from gripscale.questions.design.compound_search import PRECISION, design_problem
from gripscale.questions.design.design_dataset import today, variable
from gripscale.questions.design.goal_friction import CompoundGoal
from gripscale.questions.inputs import record
from gripscale.questions.result import Result
from gripscale.questions.vary.inputs import measured_rubber_of, reading_notes
from gripscale.report.elements import Page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OnPoint = Callable[[xr.Dataset], object]


class CompoundDesign(Result):
    """The trade-off curve of a case: friction of new compounds against rolling resistance."""

    kind = "design"

    @property
    def lines(self) -> Sequence[str]:
        return tuple(page.design_lines(self.data))

    def parts(self) -> Iterator[str | Table]:
        yield from page.design_tables(self.data)

    def table(self) -> Table:
        return page.design_table(self.data)

    def figures(self) -> Iterator[tuple[str, Figure]]:
        from gripscale.questions.design.charts import design_pictures

        for picture in design_pictures(self.data):
            yield picture.name, picture.figure

    def page_content(self) -> Page:
        return page.design_page(self.data, self.findings)


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
    either. Raises `InputError`, `FileError` or `ConvergenceError` if the case, a goal or a limit
    cannot be used, a temperature needs a shift that the rubber does not have, or today's compound
    has no friction.

        >>> gs.design(case, levels=[1.0]).lines[0]
        'Answer: friction 0.038 now → 0.059 with the design at the same rolling resistance: +57 %.'

    Parameters
    ----------
    case : Case
        Road, today's compound, load and temperature.
    goals : sequence of CompoundGoal, optional
        Where friction is wanted; by default at the load of the case.
    limits : CompoundLimits, optional
        How far the compound may be changed.
    levels : sequence of float, optional
        Largest rolling resistances over today's [-]: tan(delta) and loss compliance at 10 and 50 Hz
        and 40 to 70 C, the worst of them. By default today's, four down to the least that the
        limits admit, and 1.15 and 1.3. A level below the least is left out, and one that gives no
        more friction than a lower one.
    rubbers : mapping, optional
        Other compounds by name, to be compared with the curve.
    roads : mapping, optional
        Surfaces of the goals by the names that the goals use.
    folder : path, optional
        Keeps `design.nc` after each point: what was interrupted resumes.
    workers : int, optional
        Threads; one per core by default.
    on_point : callable, optional
        Called with the Dataset of each point as it is solved or read.
    on_task : callable, optional
        Called with today's answer at each goal, as for `gripscale.experiment.Bench`.
    """
    target = None if folder is None else Path(folder)
    if target is not None:
        make_folder(target)
    problem = design_problem(case, goals, limits, workers, roads)
    wanted = [checks.positive("level", level) for level in levels] or problem.default_levels()
    named = rubbers or {}
    key = design_key(case, problem, wanted, named)
    stored, fruitless = stored_points(target, key)
    now = todays_answers(case, problem, target, on_task)
    reference = Reference.of(problem.friction)
    compounds = {name: measured_rubber_of(value, case) for name, value in named.items()}
    others, notes = other_compounds(
        problem, reference, {name: each.rubber for name, each in compounds.items()}
    )
    base = today(problem, reference.contacts, DESIGN_TOLERANCE)
    base["today_answer_friction"] = variable(now, "friction of the answer", dim="goal")
    base = base.merge(others).assign_attrs(
        {**base.attrs, **case.attributes},
        case_file=case.origin.name,
        kind=CompoundDesign.kind,
        design_key=key,
        rubber_parameters=json.dumps(problem.rubber.to_dict()),
        notes="\n".join([*notes, *left_out(case)]),
    )
    loads = [
        replace(case.load, speed=goal.speed, pressure=goal.pressure)
        for goal in problem.friction.goals
    ]
    of_compounds = [doubt(text) for text in reading_notes(named.values())]
    of_compounds += [d.about(name) for name, each in compounds.items() for d in each.doubts]
    inputs = record.inputs(case, problem.roads.values(), loads, of_compounds)
    points: list[xr.Dataset] = []
    rising = rising_levels(wanted, problem)
    for level in rising:
        if level in fruitless:
            continue
        point = stored.get(level)
        if point is None:
            point = solved_point(problem, reference, level, points[-1:])
            designed = now * (point.friction / base.today_friction).values
            text = "friction of the answer with the design"
            point["answer_friction"] = variable(designed, text, dim="goal")
        rises = not points or float(point.gain - points[-1].gain) > PRECISION
        if rises:
            points.append(point)
        else:
            fruitless.add(level)
        if not bool(point.rolling_reached):
            fruitless |= {higher for higher in rising if higher > level}
        curve = xr.concat(points, "point", combine_attrs="override").sortby("rolling_level")
        attributes = {**base.attrs, FRUITLESS: json.dumps(sorted(fruitless))}
        data = base.merge(curve).assign_attrs(attributes)
        if target is not None:
            netcdf.save(data, target / DESIGN_FILE, {"inputs": inputs})
        if rises and on_point is not None:
            on_point(point)
    return CompoundDesign(data, inputs)
