"""Models, surfaces or rubbers side by side: `compare`, `compare-surfaces`, `compare-rubbers`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale import terminal
from gripscale.core.errors import InputError
from gripscale.report.failures import first_of
from gripscale.terminal import (
    CasePath,
    Cluster,
    MeasuredPath,
    OwnFolder,
    Workers,
    argument,
    command,
    option,
)

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import Model
    from gripscale.questions import Comparison


@command
def compare(
    case: CasePath,
    vary: Annotated[
        str | None,
        option(
            "Compare over one input, as `gripscale study` varies it: speed=0.003:30:log9, "
            "pressure='1 bar,3 bar', temperature='20 C,40 C', smallest_wavelength, cut_off, "
            "top_height_fraction, waves.",
            metavar="NAME=VALUES",
        ),
    ] = None,
    measured: MeasuredPath = None,
    rungs: Annotated[
        str | None,
        option(
            "Models wanted, by name or group (waves, measured, theory, windows, map), such "
            "as 'chain,measured'; windows and map take a minute or two. By default all."
        ),
    ] = None,
    output: OwnFolder = None,
    seeds: Annotated[int, typer.Option(help="Random phases drawn of each surface.")] = 3,
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
    workers: Workers = None,
    cluster: Cluster = None,
) -> None:
    """Show what each assumption of the chain costs; resumes where it was stopped."""
    from gripscale.case_file import read_case, read_case_file
    from gripscale.charts.figure_folder import FigureFolder
    from gripscale.charts.write import draw_comparison, draw_effects
    from gripscale.core.finding import ranked
    from gripscale.experiment.measured_friction import (
        FRICTION_DOUBTS,
        friction_doubts,
        read_measured_friction,
    )
    from gripscale.experiment.task import PREDICTIONS
    from gripscale.half_space.model import DirectContact
    from gripscale.io import netcdf
    from gripscale.questions.answer.findings import answer_notices
    from gripscale.questions.answer.page import answer_lines
    from gripscale.questions.answer.reliance import has_answer
    from gripscale.questions.calibration.page_of_measured import residual_table
    from gripscale.questions.chain.findings import friction_notices
    from gripscale.questions.compare.charts import at_measured_figure
    from gripscale.questions.compare.charts_of_ladder import varied
    from gripscale.questions.compare.comparison import (
        COMPARED_OVER,
        at_measured,
        compare_case,
        compare_over,
    )
    from gripscale.questions.compare.ladder import WINDOWS, chosen
    from gripscale.questions.compare.page import best_line, comparison_failures, comparison_parts
    from gripscale.questions.result import warning_lines
    from gripscale.questions.uncertainty.page import uncertainty_lines
    from gripscale.questions.uncertainty.propagation import stored_uncertainty
    from gripscale.questions.vary.axis import parse_vary
    from gripscale.questions.vary.effects import case_effects
    from gripscale.questions.vary.page_side_by_side import effects_table

    axes = None if vary is None else dict([parse_vary(vary, COMPARED_OVER)])
    file = read_case_file(case)
    read = read_case(file)
    friction = read.friction if measured is None else read_measured_friction(measured)
    of_friction = friction_doubts(friction, read.load.speed)
    opening = f"Comparison of models for {file.path}"
    console, target = terminal.open_folder(file, output, "comparison", opening)
    on_task = terminal.progress_printer(console)
    solving: dict[str, Any] = {"workers": workers, "client": cluster, "on_task": on_task}

    def print_stage(ladder: Comparison) -> None:
        """Print the answer as far as it goes, once, while windows are solved."""
        if axes is None and staged and has_answer(ladder.data) and not stages:
            stages.append(ladder)
            console.print()
            terminal.print_parts(console, ["So far:", *answer_lines(ladder.data), ""])

    names = [] if rungs is None else [name.strip() for name in rungs.split(",")]
    staged = any(rung.group == WINDOWS for rung in chosen(names))
    stages: list[Comparison] = []
    options: dict[str, Any] = solving | {
        "seeds": seeds,
        "tolerance": tolerance,
        "accuracy": accuracy,
        "on_stage": print_stage,
        "rungs": names,
        "measured": friction,
        "folder": target,
    }
    worth: list[xr.Dataset] = []
    residuals: xr.Dataset | None = None
    if axes is None:
        ladder = compare_case(read, **options)
        data, name = ladder.to_dataset(), "comparison"
        models: list[Model] = [read.chain] if read.conditions is not None else []
        if models and read.surface.measured is not None:
            models.append(DirectContact(tolerance=tolerance, conditions=read.conditions))
        store = target / PREDICTIONS
        effects = (case_effects(read, model, target, store, **solving) for model in models)
        worth = [result for result in effects if result is not None]
        residuals = at_measured(ladder, store, **solving)
    else:
        data = compare_over(read, axes, **options).to_dataset()
        name = f"over_{varied(data)}"
    if of_friction:
        data.attrs[FRICTION_DOUBTS] = "\n".join(of_friction)
    netcdf.save(data, target / f"{name}.nc")
    parts = list(comparison_parts(data))
    warnings = list(friction_notices(of_friction))
    above: list[str] = []
    if axes is None:
        warnings = ranked([*warnings, *answer_notices(data)])
        lead = list(answer_lines(data))
        console.print()
        terminal.print_parts(console, [*lead, *warning_lines(warnings, f"{name}.txt")])
        above = [*lead, *warning_lines(warnings)]
    if worth:
        parts.append(effects_table(*worth))
    if residuals is not None:
        netcdf.save(residuals, target / "at_measured.nc")
        parts.append(residual_table(residuals))
    sampled = stored_uncertainty(file.resolve(file.case.output.folder))
    parts += uncertainty_lines(sampled, file.text, read.origin.digests)
    if axes is None and has_answer(data):
        parts += ["", best_line(data)]

    def draw_figures() -> None:
        figures = FigureFolder(target, file.case.output.figures)
        draw_comparison(data, figures)
        if worth:
            draw_effects(worth, figures)
        if residuals is not None:
            labels = dict(zip(data.rung.values.tolist(), data.label.values.tolist(), strict=True))
            figures.save(at_measured_figure(residuals, labels), "at_measured")

    failed = [
        replace(failure, sentence=f"{where} did not converge: {failure}")
        for where, failure in comparison_failures(data)
    ]
    terminal.conclude(
        console,
        target,
        parts,
        results=[data],
        opening=above,
        warnings=() if above else warnings,
        text=f"{name}.txt",
        closing=f"Tables, figures and result ({name}.nc) are in",
        draw=draw_figures,
        # a failed sample is named in its row; the estimate stands without it
        failure=""
        if bool(data.best_contact_fraction.notnull().all())
        else first_of(failed, data.status.size, "models with all their samples"),
    )


def case_of(arguments: Sequence[str], case: Path | None, what: str) -> Path:
    """Return the case the rest is taken from: the one stated, or the first of those given.

    Raises `InputError` if there is none; `what` is taken from it.
    """
    chosen = case or next((Path(text) for text in arguments if text.endswith(".toml")), None)
    if chosen is None:
        raise InputError(f"--case must be given: {what} are taken from a case")
    return chosen


@command
def compare_surfaces_command(
    surfaces: Annotated[
        list[str],
        argument(
            "Two to six roads: files of profiles, cases (their surface), or surfaces known by "
            "name. The others are compared with the first.",
            "SURFACE...",
        ),
    ],
    case: Annotated[
        Path | None,
        option(
            "Case whose rubber, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
        ),
    ] = None,
    samples: Annotated[
        int,
        typer.Option(help="Stretches drawn of each road, for the range of its totals; 0: none."),
    ] = 20,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Compare roads under the same rubber: friction, area, and which scale makes the difference."""
    from gripscale.case_file import read_case, read_case_file
    from gripscale.case_file.named_inputs import names_of, read_surface
    from gripscale.charts.figure_folder import FigureFolder
    from gripscale.charts.write import draw
    from gripscale.questions.vary.charts_side_by_side import road_pictures
    from gripscale.questions.vary.page_side_by_side import (
        failed_totals,
        ratio_lines,
        roads_sentences,
        roads_tables,
    )
    from gripscale.questions.vary.surface_comparison import compare_surfaces as compare

    file = read_case_file(case_of(surfaces, case, "the rubber and the load"))
    console, target = terminal.open_folder(file, output, "surfaces")
    roads = compare(
        read_case(file),
        {
            name: read_surface(value, file)
            for name, value in zip(names_of(surfaces), surfaces, strict=True)
        },
        target,
        samples=samples or None,
        workers=workers,
        on_task=terminal.progress_printer(console),
    )
    data, figures = roads.data, FigureFolder(target, file.case.output.figures)
    terminal.conclude(
        console,
        target,
        [*roads_tables(data), *roads_sentences(data), *(f"note: {note}" for note in roads.notes)],
        results=[data],
        lead=list(ratio_lines(data, "surface")),
        text="surfaces.txt",
        closing="Result (surfaces.nc), tables and figures are in",
        draw=lambda: draw(road_pictures(data), figures),
        page="surfaces.nc",
        failure=first_of(failed_totals(data), data.prediction_status.size, "predictions"),
    )


@command
def compare_rubbers(
    rubbers: Annotated[
        list[str],
        argument(
            "Two to six compounds: files of moduli, cases (their rubber), or rubbers known by "
            "name. The others are compared with the first.",
            "RUBBER...",
        ),
    ],
    case: Annotated[
        Path | None,
        option(
            "Case whose road, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
        ),
    ] = None,
    temperature: Annotated[
        str | None, option('Such as "20 C"; by default one that all have or can be shifted to.')
    ] = None,
    uncertainty: Annotated[
        bool, typer.Option(help="Predict what each measurement leaves open, too.")
    ] = True,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Compare compounds on the same road: friction, area, and what makes the difference."""
    from gripscale.case_file import read_case, read_case_file
    from gripscale.case_file.named_inputs import names_of, read_rubber
    from gripscale.charts.figure_folder import FigureFolder
    from gripscale.charts.write import draw
    from gripscale.core.units import temperature_in_kelvin
    from gripscale.questions.vary.charts_side_by_side import compound_pictures
    from gripscale.questions.vary.page_side_by_side import (
        believed_table,
        compounds_sentences,
        compounds_table,
        failed_totals,
        ratio_lines,
    )
    from gripscale.questions.vary.rubber_comparison import compare_compounds

    chosen = case_of(rubbers, case, "the road and the load")
    kelvin = None if temperature is None else temperature_in_kelvin(temperature)
    file = read_case_file(chosen)
    opening = (
        "Each compound is predicted first; then the range that the error of its measured moduli "
        "leaves, on half-planes."
    )
    console, target = terminal.open_folder(file, output, "rubbers", *[opening] * uncertainty)
    compounds = compare_compounds(
        read_case(file),
        {
            name: read_rubber(value, file)
            for name, value in zip(names_of(rubbers), rubbers, strict=True)
        },
        target,
        temperature=kelvin,
        uncertainty=uncertainty,
        workers=workers,
        on_task=terminal.progress_printer(console),
    )
    data, figures = compounds.data, FigureFolder(target, file.case.output.figures)
    terminal.conclude(
        console,
        target,
        [
            *filter(None, [believed_table(data, "rubber", "compound")]),
            compounds_table(data),
            *compounds_sentences(data),
            *(f"note: {note}" for note in compounds.notes),
        ],
        results=[data],
        lead=list(ratio_lines(data, "rubber")),
        text="compounds.txt",
        closing="Result (compounds.nc), table and figures are in",
        draw=lambda: draw(compound_pictures(data, compounds.rubbers), figures),
        page="compounds.nc",
        failure=first_of(failed_totals(data), data.prediction_status.size, "compounds"),
    )
