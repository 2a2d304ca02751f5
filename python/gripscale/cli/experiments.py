"""Many predictions of one case: a study over its inputs, its uncertainty, a calibration."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Annotated

import typer

from gripscale import terminal
from gripscale.core.errors import InputError
from gripscale.terminal import CasePath, Cluster, MeasuredPath, OwnFolder, Workers, command, option


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
        failure=terminal.first_of(failed, total, "predictions"),
    )


@command
def calibrate_command(
    case: CasePath,
    model: Annotated[
        str | None,
        option(
            "What predicts hysteresis and contact area: direct, the default where the surface was "
            "measured, or chain, the default elsewhere.",
            metavar="direct|chain",
        ),
    ] = None,
    law: Annotated[
        str, typer.Option(help="Shear stress: constant, gaussian or le_gal_klueppel.")
    ] = "gaussian",
    hold_out: Annotated[
        str | None,
        option(
            "Predict each temperature, or each decade of speed, from the others.",
            metavar="temperature|speed",
        ),
    ] = None,
    fixed: Annotated[
        list[str] | None,
        option(
            "A parameter that is known, such as width=0.1 or activation_energy='0.97 eV'; "
            "may be repeated.",
            metavar="NAME=VALUE",
        ),
    ] = None,
    measured: MeasuredPath = None,
    output: OwnFolder = None,
    workers: Workers = None,
    cluster: Cluster = None,
) -> None:
    """Fit the area term, never the hysteresis, to measured friction; resumes where stopped."""
    from gripscale.case_file import read_case, read_case_file
    from gripscale.charts.figure_folder import FigureFolder
    from gripscale.charts.write import draw
    from gripscale.experiment.measured_friction import (
        friction_doubts,
        read_measured_friction,
        speed_doubts,
    )
    from gripscale.io import netcdf
    from gripscale.model import INPUT_DOUBTS
    from gripscale.questions.answer.findings import case_notices
    from gripscale.questions.calibration.calibration import calibrate_case, measured_of
    from gripscale.questions.calibration.calibration_text import (
        notes,
        parse_fixed,
        shear_stress_table,
    )
    from gripscale.questions.calibration.page import (
        calibration_failure,
        calibration_lines,
        calibration_parts,
    )
    from gripscale.questions.inputs import record
    from gripscale.questions.inputs.page_record import InputRecord
    from gripscale.questions.uncertainty.charts import calibration_pictures
    from gripscale.questions.vary.inputs import default_model

    values = parse_fixed(fixed or [])
    file = read_case_file(case)
    read = read_case(file)
    model = model or default_model(read)
    friction = measured_of(read) if measured is None else read_measured_friction(measured)
    opening = f"Area term of {file.path} from {friction.source}"
    console, target = terminal.open_folder(file, output, "calibration", opening)
    fitted = calibrate_case(
        read,
        model=model,
        law=law,
        fixed=values,
        hold_out=hold_out,
        measured=friction,
        folder=target,
        workers=workers,
        client=cluster,
        on_task=terminal.progress_printer(console),
    )
    data = fitted.to_dataset().assign_attrs(
        read.attributes, case_file=read.origin.name, model=model, notes="\n".join(notes(fitted))
    )
    speed = read.load.speed
    # its speeds have a doubt of their own
    loads = [replace(read.load, pressure=float(p)) for p in fitted.predicted.pressure]
    if far := speed_doubts(friction, speed):
        data.attrs[INPUT_DOUBTS] = "\n".join(far)
    of_friction = friction_doubts(friction, speed)
    inputs = record.inputs(read, loads=loads, friction_notes=of_friction)
    netcdf.save(data, target / "calibration.nc", {"inputs": inputs})
    figures = FigureFolder(target, file.case.output.figures)
    terminal.conclude(
        console,
        target,
        list(calibration_parts(data)),
        results=[data],
        lead=list(calibration_lines(data)),
        warnings=case_notices(data, InputRecord(inputs)),
        text="calibration.txt",
        closing="Tables, figures, result and [conditions.shear_stress] are in",
        files={"shear_stress.toml": shear_stress_table(fitted)},
        draw=lambda: draw(calibration_pictures(data), figures),
        failure=str(calibration_failure(data) or ""),
    )
