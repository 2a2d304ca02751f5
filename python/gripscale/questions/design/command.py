"""`gripscale design`: which change of a compound gives more friction for its rolling resistance."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.questions import terminal
from gripscale.questions.terminal import CasePath, Modulus, OwnFolder, Workers, case_command, option

if TYPE_CHECKING:
    import xarray as xr


_GOAL = (
    "Where friction is wanted, in place of the load of the case: 'speed=3 m/s, temperature=0 C, "
    "pressure=2 bar, weight=1, road=wet.toml'; what is missing is as in the case. May be given "
    "several times."
)
_LIMIT = (
    "Range of E', tan(delta) or J'' over today's, in place of E' at 10 Hz and 20 C within 10 %: "
    "'storage_modulus, 10 Hz, 20 C, 0.9:1.1', 'loss_factor, 10 Hz, 0 C, 1:2' or "
    "'loss_compliance, 10 Hz, 60 C, 0:1'. May be given several times."
)
_LEVELS = (
    "Largest rolling resistance over today's of each point, such as 0.8,0.9,1,1.1; by default from "
    "the least that is admissible to 1.3."
)
_RUBBER = (
    "Another compound to be drawn on the same plane: a file of moduli, a case, or a rubber known "
    "by name. May be given several times."
)


@case_command
def design_command(
    case: CasePath,
    goal: Annotated[list[str] | None, option(_GOAL, metavar="KEY=VALUE,...")] = None,
    limit: Annotated[list[str] | None, option(_LIMIT, metavar="LIMIT")] = None,
    largest_factor: Annotated[
        float, typer.Option(help="Largest factor, up or down, on each modulus of the series.")
    ] = 2.0,
    factor_per_decade: Annotated[
        float, typer.Option(help="Largest ratio of the factors of relaxation times a decade apart.")
    ] = 2.0,
    levels: Annotated[str | None, option(_LEVELS)] = None,
    rubber: Annotated[list[str] | None, option(_RUBBER, metavar="FILE")] = None,
    modulus: Modulus = None,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Design a compound: most friction on the surface of a case for each rolling resistance."""
    from gripscale.case_file import folder
    from gripscale.case_file.named_inputs import names_of, read_rubber, read_surface
    from gripscale.questions.design import question
    from gripscale.questions.design.compound_limits import CompoundLimits
    from gripscale.questions.design.compound_search import default_goal

    work = terminal.CaseCommand(case)
    points = None if not limit else tuple(question.parse_limit(text) for text in limit)
    goals = [question.parse_goal(text, default_goal(work.case)) for text in goal or ()]
    wanted = [] if levels is None else question.parse_levels(levels)
    others = list(rubber or ())
    work.open_results(output, "design", f"Design of a compound for {work.file.path}")
    folder.save_case(work.file, work.target)

    def print_point(point: xr.Dataset) -> None:
        rolling, gain = float(point.rolling_ratio) - 1.0, float(point.gain)
        friction = ", ".join(f"{mu:.3f}" for mu in point.answer_friction.values)
        line = f"rolling resistance {rolling:+z.1%}: friction {friction} ({gain:+.1%})"
        terminal.print_wrapped(work.console, line)

    result = question.design(
        work.case,
        goals=goals,
        limits=CompoundLimits(largest_factor, factor_per_decade, points),
        levels=wanted,
        rubbers={
            name: read_rubber(value, work.file, modulus)
            for name, value in zip(names_of(others), others, strict=True)
        },
        roads={name: read_surface(name, work.file) for name in sorted({g.road for g in goals})},
        on_point=print_point,
        **work.solving(workers),
    )
    question.write_targets(result.data, work.target)
    contents = "figure, and master curve and rubber of each point (target_*)"
    work.finish(result, contents, drawings="")
