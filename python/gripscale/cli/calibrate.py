"""`gripscale calibrate CASE.toml`: the area term fitted to measured friction."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale.cli.options import CasePath, Cluster, Measured, OwnFolder, Workers
from gripscale.cli.progress import teller
from gripscale.cli.terminal import NOT_CONVERGED, command, complain, say, say_all, screen

if TYPE_CHECKING:
    from gripscale.calibration import Calibration
    from gripscale.case import CaseFile


@command
def calibrate(
    case: CasePath,
    model: Annotated[
        str, typer.Option(help="What predicts hysteresis and contact area: direct or chain.")
    ] = "direct",
    law: Annotated[
        str, typer.Option(help="Shear stress: constant, gaussian or le_gal_klueppel.")
    ] = "gaussian",
    hold_out: Annotated[
        str | None,
        typer.Option(
            help="Predict each temperature, or each decade of speed, from the others.",
            metavar="temperature|speed",
            show_default=False,
        ),
    ] = None,
    fixed: Annotated[
        list[str] | None,
        typer.Option(
            help="A parameter that is known, such as width=0.1 or activation_energy='0.97 eV'; "
            "may be repeated.",
            metavar="NAME=VALUE",
            show_default=False,
        ),
    ] = None,
    measured: Measured = None,
    output: OwnFolder = None,
    workers: Workers = None,
    cluster: Cluster = None,
) -> None:
    """Fit the area term, never the hysteresis, to measured friction; resumes where stopped."""
    from gripscale.calibration import calibrate_case
    from gripscale.calibration.of_case import measured_of, parse_fixed
    from gripscale.case import folder, read_case
    from gripscale.measured import read_measured_friction

    known = parse_fixed(fixed or [])
    file = read_case(case)
    friction = measured_of(file) if measured is None else read_measured_friction(measured)
    target = output or file.resolve(file.case.output.folder) / "calibration"
    folder.require_writable(target)
    console = screen()
    say(console, f"Area term of {file.path} from {friction.source}")
    folder.make(target)
    made = calibrate_case(
        file,
        model=model,
        law=law,
        fixed=known,
        hold_out=hold_out,
        measured=friction,
        folder=target,
        workers=workers,
        client=cluster,
        on_task=teller(console),
    )
    parts = list(_parts(made, model, file.text))
    say_all(console, parts)
    _keep(made, file, parts, target)
    console.print()
    say(console, f"Table, figures, result and [conditions.shear_stress] are in {target}")
    failed = [status for status in made.predicted.status if status != "converged"]
    if failed:
        complain(
            f"{len(failed)} of {len(made.predicted.status)} measured points have no prediction; "
            f"the first: {failed[0]}"
        )
        raise typer.Exit(NOT_CONVERGED)


def _parts(made: Calibration, model: str, case: str) -> list[Any]:
    """Return the tables and sentences of a calibration."""
    from gripscale.calibration.notes import notes
    from gripscale.measured import residuals
    from gripscale.report.calibration_table import correlations, held_out_table, parameter_table
    from gripscale.report.residual_table import residual_table

    beside = residuals(made.measured, {model: made.predicted}, made.law).assign_attrs(case=case)
    parts = [residual_table(beside), parameter_table(made), *filter(None, [correlations(made)])]
    if made.held_out:
        parts.append(held_out_table(made))
    return [*parts, *notes(made)]


def _keep(made: Calibration, file: CaseFile, parts: list[Any], target: Path) -> None:
    """Write result, tables, figures and the table of the law into the folder."""
    from gripscale import netcdf
    from gripscale.calibration.snippet import shear_stress_table
    from gripscale.case import folder
    from gripscale.figures.calibration import draw
    from gripscale.report import tables

    data = made.to_dataset().assign_attrs(case=file.text, case_file=str(file.path))
    netcdf.save(data, target / "calibration.nc")
    folder.write_text(target / "calibration.txt", tables.as_text(*parts))
    folder.write_text(target / "shear_stress.toml", shear_stress_table(made))
    draw(data, target)
