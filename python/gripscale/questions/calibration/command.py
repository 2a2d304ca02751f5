"""`gripscale calibrate CASE.toml`: the area term that agrees with measured friction."""

from __future__ import annotations

from typing import Annotated

import typer

from gripscale.questions import terminal


@terminal.case_command
def calibrate_command(
    case: terminal.CasePath,
    model: Annotated[
        str | None,
        terminal.option(
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
        terminal.option(
            "Predict each temperature, or each decade of speed, from the others.",
            metavar="temperature|speed",
        ),
    ] = None,
    fixed: Annotated[
        list[str] | None,
        terminal.option(
            "A parameter that is known, such as width=0.1 or activation_energy='0.97 eV'; "
            "may be repeated.",
            metavar="NAME=VALUE",
        ),
    ] = None,
    measured: terminal.MeasuredPath = None,
    output: terminal.OwnFolder = None,
    workers: terminal.Workers = None,
    cluster: terminal.Cluster = None,
) -> None:
    """Fit the area term, never the hysteresis, to measured friction; resumes where stopped."""
    from gripscale.io.folders import write_text
    from gripscale.questions.calibration.calibration_law import parse_fixed
    from gripscale.questions.calibration.question import calibrate, measured_of, shear_stress_table

    values = parse_fixed(fixed or [])
    work = terminal.CaseCommand(case)
    friction = measured_of(work.case, measured)
    opening = f"Area term of {work.file.path} from {friction.source}"
    work.open_results(output, "calibration", opening)
    result = calibrate(
        work.case,
        friction,
        model=model,
        law=law,
        fixed=values,
        hold_out=hold_out,
        client=cluster,
        **work.solving(workers),
    )
    write_text(work.target / "shear_stress.toml", shear_stress_table(result))
    work.finish(result, "tables, figures and [conditions.shear_stress]", drawings="")
