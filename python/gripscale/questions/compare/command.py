"""`gripscale compare CASE.toml`: the models side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.questions import terminal

if TYPE_CHECKING:
    from gripscale.questions.compare.comparison import SolvedLadder


@terminal.case_command
def compare_command(
    case: terminal.CasePath,
    vary: Annotated[
        str | None,
        terminal.option(
            "Compare over one input, as `gripscale study` varies it: speed=0.003:30:log9, "
            "pressure='1 bar,3 bar', temperature='20 C,40 C', smallest_wavelength, cut_off.",
            metavar="NAME=VALUES",
        ),
    ] = None,
    measured: terminal.MeasuredPath = None,
    models: Annotated[
        str | None,
        terminal.option(
            "Models wanted, by name or group (waves, measured, theory, windows, map), such "
            "as 'chain,measured'; windows and map take a minute or two. By default all."
        ),
    ] = None,
    output: terminal.OwnFolder = None,
    seeds: Annotated[int, typer.Option(help="Random phases drawn of the sine waves.")] = 3,
    tolerance: Annotated[
        float, typer.Option(help="Estimated relative error of each direct contact.")
    ] = 0.05,
    accuracy: Annotated[
        float,
        typer.Option(
            help="Half width of the 90 % interval that is wanted: more windows are solved until "
            "finite strain adds no more than a third of it."
        ),
    ] = 0.1,
    workers: terminal.Workers = None,
    cluster: terminal.Cluster = None,
) -> None:
    """Show what each assumption of the chain costs; resumes where it was stopped."""
    from gripscale.experiment.measured_friction import read_measured_friction
    from gripscale.experiment.task import PREDICTIONS
    from gripscale.io import netcdf
    from gripscale.questions.answer.page import answer_lines
    from gripscale.questions.answer.variables import has_answer
    from gripscale.questions.compare import comparison, ladder, question
    from gripscale.questions.page_of_folder import write_report
    from gripscale.questions.vary import axis

    axes = None if vary is None else axis.parse_axes([vary], comparison.COMPARED_OVER)
    work = terminal.CaseCommand(case)
    work.open_results(output, "comparison", f"Comparison of models for {work.file.path}")
    console, target, read = work.console, work.target, work.case
    solving = work.solving(workers) | {"client": cluster}
    bench = {name: value for name, value in solving.items() if name != "folder"}
    stages: list[SolvedLadder] = []

    def print_stage(solved: SolvedLadder) -> None:
        """Print the answer, once, while other models are solved."""
        if axes is None and staged and has_answer(solved.data) and not stages:
            stages.append(solved)
            lead, *_ = answer_lines(solved.data)
            terminal.print_parts(console, ["", lead, "Solving the other models ..."])

    names = [] if models is None else [name.strip() for name in models.split(",")]
    staged = len(ladder.chosen(names)) > 1
    result = question.compare(
        read,
        vary=axes,
        seeds=seeds,
        tolerance=tolerance,
        accuracy=accuracy,
        models=names,
        measured=None if measured is None else read_measured_friction(measured),
        on_stage=print_stage,
        **solving,
    )
    if axes is None:
        assert result.ladder is not None
        residuals = comparison.at_measured(result.ladder, target / PREDICTIONS, **bench)
        if residuals is not None:
            netcdf.save(residuals, target / "at_measured.nc")
            result.at_measured = residuals
    work.finish(
        result,
        "tables and figures",
        drawings="",
        page=lambda page: write_report(target, page),
    )
