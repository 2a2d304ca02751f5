"""Many predictions of one case: a study over its inputs, its uncertainty, a calibration."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from gripscale import terminal
from gripscale.core.errors import InputError
from gripscale.report.failures import first_of
from gripscale.terminal import CasePath, Cluster, OwnFolder, Workers, command, option


@command
def study(
    case: CasePath,
    vary: Annotated[
        list[str],
        typer.Option(
            help="What to vary, once or twice: speed=0.003:30:log9, pressure='1 bar,3 bar', "
            "temperature='0 C:60 C:lin7', effects=all,no_heat,none, smallest_wavelength, cut_off, "
            "top_height_fraction, waves, pressure_classes, "
            "factors=3.5/2.4,3/2.2, rubber=case,dma.txt, surface.",
            metavar="NAME=VALUES",
        ),
    ],
    output: OwnFolder = None,
    model: Annotated[
        str | None,
        option(
            "What predicts: direct (the whole measured surface at once), the default where the "
            "surface was measured, or chain (of sine waves), the default elsewhere."
        ),
    ] = None,
    tolerance: Annotated[
        float, typer.Option(help="Estimated relative error of each direct contact.")
    ] = 0.05,
    workers: Workers = None,
    cluster: Cluster = None,
    static: Annotated[
        bool | None,
        option("Also the rubber at rest; as the case says by default.", "--static/--no-static"),
    ] = None,
) -> None:
    """Vary one or two inputs of a case: table, figures, one result file; resumes where stopped."""
    from gripscale.case_file import folder, read_case, read_case_file
    from gripscale.case_file.named_inputs import read_named_inputs
    from gripscale.charts.figure_folder import FigureFolder
    from gripscale.io import netcdf
    from gripscale.io.folders import make_folder
    from gripscale.questions.answer.best_estimate import with_best_estimate
    from gripscale.questions.vary.axis import parse_vary
    from gripscale.questions.vary.page import failed_predictions, study_parts
    from gripscale.questions.vary.page_of_answer import study_lines
    from gripscale.questions.vary.study import STUDY_FILE, Study

    pairs = [parse_vary(text) for text in vary]
    axes = dict(pairs)
    if len(axes) < len(pairs):
        raise InputError(f"vary must name different inputs; got {', '.join(n for n, _ in pairs)}")
    file = read_case_file(case)
    axes = read_named_inputs(axes, file)
    planned = Study(read_case(file), axes, static=static, model=model, tolerance=tolerance)
    console, target = terminal.open_folder(file, output, "study")
    stored = planned.stored(target)
    opening = planned.description()
    if stored is not None:
        opening = json.loads(stored.attrs["description"])
    for line in [*opening, ""]:
        terminal.print_wrapped(console, line)
    figures = FigureFolder(target / "figures", file.case.output.figures)
    make_folder(figures.path)
    folder.save_case(file, target)
    result = planned.run(
        target, workers=workers, client=cluster, on_task=terminal.progress_printer(console)
    )
    result = with_best_estimate(result)
    netcdf.save(result, target / STUDY_FILE)
    drawn = stored is not None and any(figures.path.iterdir())

    def draw_figures() -> None:
        from gripscale.charts.write import draw_study

        draw_study(result, figures)

    failed, total = failed_predictions(result)
    terminal.conclude(
        console,
        target,
        list(study_parts(result)),
        results=[result],
        lead=list(study_lines(result)),
        text="study.txt",
        closing="Result (study.nc), table and figures are in",
        opening=opening,
        draw=None if drawn else draw_figures,
        failure=first_of(failed, total, "predictions"),
    )
