"""`gripscale compare CASE.toml`: the models side by side."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.questions import terminal

if TYPE_CHECKING:
    from gripscale.questions.compare.comparison import SolvedLadder


_VARY = (
    "Compare over one input, as `gripscale study` varies it: speed=0.003:30:log9, "
    "pressure='1 bar,3 bar', temperature='20 C,40 C', smallest_wavelength, cut_off."
)
_MODELS = (
    "Models wanted, by name or group (waves, measured, theory, windows, map), such as "
    "'chain,measured'; windows and map take a minute or two. By default all."
)
_ACCURACY = (
    "Half width of the 90 % interval that is wanted: more windows are solved until finite strain "
    "adds no more than a third of it."
)


@terminal.case_command
def compare_command(
    case: terminal.CasePath,
    vary: Annotated[str | None, terminal.option(_VARY, metavar="NAME=VALUES")] = None,
    measured: terminal.MeasuredPath = None,
    models: Annotated[str | None, terminal.option(_MODELS)] = None,
    output: terminal.OwnFolder = None,
    seeds: Annotated[int, typer.Option(help="Random phases drawn of the sine waves.")] = 3,
    tolerance: Annotated[
        float, typer.Option(help="Estimated relative error of each direct contact.")
    ] = 0.05,
    accuracy: Annotated[float, typer.Option(help=_ACCURACY)] = 0.1,
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
    solving = work.solving(workers) | {"client": cluster}
    names = [] if models is None else [name.strip() for name in models.split(",")]
    pending = axes is None and len(ladder.chosen(names)) > 1

    def print_stage(solved: SolvedLadder) -> None:
        """Print the answer, once, while other models are solved."""
        nonlocal pending
        if pending and has_answer(solved.data):
            pending = False
            lead = next(answer_lines(solved.data))
            terminal.print_parts(work.console, ["", lead, "Solving the other models ..."])

    result = question.compare(
        work.case,
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
        del solving["folder"]
        residuals = comparison.at_measured(result.ladder, work.target / PREDICTIONS, **solving)
        if residuals is not None:
            netcdf.save(residuals, work.target / "at_measured.nc")
            result.at_measured = residuals
    page = partial(write_report, work.target)
    work.finish(result, "tables and figures", drawings="", page=page)
