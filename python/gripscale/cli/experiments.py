"""`gripscale study CASE.toml --vary ...`: one case with one or two of its inputs varied."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale.cli.terminal import (
    NOT_CONVERGED,
    CasePath,
    Cluster,
    Measured,
    OwnFolder,
    Workers,
    command,
    print_error,
    print_parts,
    print_wrapped,
    progress_printer,
    screen,
    with_doc_link,
)
from gripscale.core.errors import InputError

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console

    from gripscale.analysis.calibration import Calibration
    from gripscale.case import CaseFile


@command
def study(
    case: CasePath,
    vary: Annotated[
        list[str],
        typer.Option(
            help="What to vary, once or twice: speed=0.003:30:log9, pressure='1 bar,3 bar', "
            "temperature='0 C:60 C:lin7', effects=all,no_heat,none, smallest_wavelength, cut_off, "
            "upper_share, waves, pressure_classes, "
            "factors=3.5/2.4,3/2.2, rubber=case,dma.txt, surface.",
            metavar="NAME=VALUES",
        ),
    ],
    output: OwnFolder = None,
    model: Annotated[
        str, typer.Option(help="What predicts: chain, or direct (the whole surface at once).")
    ] = "chain",
    workers: Workers = None,
    cluster: Cluster = None,
    static: Annotated[
        bool | None,
        typer.Option(
            "--static/--no-static",
            help="Also the rubber at rest; as the case says by default.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Vary one or two inputs of a case: table, figures, one result file; resumes where stopped."""
    from gripscale.case import folder
    from gripscale.experiment.axis import parse_vary
    from gripscale.experiment.study import Study

    pairs = [parse_vary(text) for text in vary]
    axes = dict(pairs)
    if len(axes) < len(pairs):
        raise InputError(f"vary must name different inputs; got {', '.join(n for n, _ in pairs)}")
    made = Study(case, axes, static=static, model=model)
    target = output or made.file.resolve(made.file.case.output.folder) / "study"
    folder.require_writable(target)
    console = screen()
    known = made.stored(target)
    opening = [
        *(json.loads(known.attrs["description"]) if known is not None else made.description()),
        "",
    ]
    for line in opening:
        print_wrapped(console, line)
    folder.make(target / "figures")
    folder.save_case(made.file, target)
    result = made.run(target, workers=workers, client=cluster, on_task=progress_printer(console))
    _conclude_study(console, opening, result, target, drawn=known is not None)


def _conclude_study(
    console: Console, opening: list[str], result: xr.Dataset, target: Path, *, drawn: bool
) -> None:
    """Print and keep the table, draw the figures, and say which predictions failed."""
    from gripscale.case import folder
    from gripscale.report import tables_run
    from gripscale.report.tables_study import study_table

    parts = [study_table(result), *_below(result)]
    print_parts(console, parts)
    folder.write_text(target / "study.txt", tables_run.as_text(*opening, *parts))
    figures = target / "figures"
    if not (drawn and any(figures.iterdir())):
        from gripscale.charts.write import draw_study

        draw_study(result, figures)
    console.print()
    print_wrapped(console, f"Result (study.nc), table and figures are in {target}")
    statuses = result.prediction_status.values.ravel().tolist()
    if "static_prediction_status" in result:
        statuses += result.static_prediction_status.values.ravel().tolist()
    failed = [status for status in statuses if status != "converged"]
    if failed:
        print_error(
            f"{len(failed)} of {len(statuses)} predictions have no totals; the first: "
            f"{with_doc_link(failed[0])}"
        )
        raise typer.Exit(NOT_CONVERGED)


def _below(result: xr.Dataset) -> list[str]:
    """Return the sentences below the table: what is extrapolated, and temperatures over a_T v."""
    from gripscale.report.notices import study_sentence
    from gripscale.report.tables_study import collapse_sentences, shift_sentence

    beyond, shifted = study_sentence(result), shift_sentence(result)
    return [
        *([beyond] if beyond else []),
        *([f"* {shifted}"] if shifted else []),
        *(f"Over a_T v, {words}: {text}." for words, text in collapse_sentences(result)),
    ]


# `gripscale uncertainty CASE.toml`: what is not known of a case, and what it does to friction.


@command
def uncertainty(
    case: CasePath,
    samples: Annotated[
        int | None,
        typer.Option(help="Samples, of all inputs at once; 200 by default.", show_default=False),
    ] = None,
    model: Annotated[
        str | None,
        typer.Option(
            help="chain (the default), direct (contact of the whole profile) or both.",
            show_default=False,
        ),
    ] = None,
    without: Annotated[
        list[str] | None,
        typer.Option(
            help="A source to be left out: profile, modulus, bulk_modulus, equilibrium_modulus, "
            "load_time, cut_off, waves. May be given several times.",
            metavar="NAME",
            show_default=False,
        ),
    ] = None,
    given: Annotated[
        list[str] | None,
        typer.Option(
            help="What is known of a source, in place of its default: two ends as "
            "bulk_modulus='1.5 GPa:3 GPa', cut_off='50 um:200 um', load_time=0.5:2 (factors), or "
            "equally likely values as waves=6,8. May be given several times.",
            metavar="NAME=VALUES",
            show_default=False,
        ),
    ] = None,
    vary: Annotated[
        str | None,
        typer.Option(
            help="Speeds or pressures, the same samples at each: speed=0.003:30:log9.",
            metavar="NAME=VALUES",
            show_default=False,
        ),
    ] = None,
    block_length: Annotated[
        str | None,
        typer.Option(
            help="Length of the blocks of profiles that are drawn, such as '120 mm'; four of the "
            "largest waves by default.",
            show_default=False,
        ),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(
            help="Estimated relative error of each direct contact; by default that of its first "
            "full grid, about a tenth.",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(help="Seed of the random numbers; 0 by default.", show_default=False),
    ] = None,
    output: OwnFolder = None,
    workers: Workers = None,
    cluster: Cluster = None,
) -> None:
    """Sample what is not known of a case: quantiles, what matters most; resumes where stopped.

    Options go before what the case states in its table [uncertainty].
    """
    from gripscale.analysis.propagation import BOTH, propagate
    from gripscale.analysis.sampled_inputs import length
    from gripscale.analysis.sampling import Uncertainty
    from gripscale.case import folder, read_case
    from gripscale.core import checks
    from gripscale.experiment.axis import parse_vary

    models = None if model is None else BOTH[checks.one_of("model", model, BOTH)]
    axes = None if vary is None else dict([parse_vary(vary)])
    blocks = None if block_length is None else length(block_length)
    known = _given(given or ())
    file = read_case(case)
    choice = Uncertainty.of_case(
        file.case.uncertainty, without=without or None, given=known, block_length=blocks
    )
    target = output or file.resolve(file.case.output.folder) / "uncertainty"
    folder.require_writable(target)
    console = screen()
    print_wrapped(console, f"Uncertainty of {file.path}")
    folder.make(target / "figures")
    data = propagate(
        file,
        choice,
        samples=samples,
        seed=seed,
        models=models,
        vary=axes,
        tolerance=tolerance,
        folder=target,
        workers=workers,
        client=cluster,
        on_task=progress_printer(console),
    )
    _conclude_uncertainty(console, data, target)


def _given(texts: Sequence[str]) -> dict[str, str]:
    """Return name and values of texts such as `cut_off=50 um:200 um`."""
    found = {}
    for text in texts:
        name, separator, values = text.partition("=")
        if not separator or not values.strip():
            raise InputError(f'given must be such as "cut_off=50 um:200 um"; got {text!r}')
        if name.strip() in found:
            raise InputError(f"given must name different sources; got {name.strip()} twice")
        found[name.strip()] = values.strip()
    return found


def _conclude_uncertainty(console: Console, data: xr.Dataset, target: Path) -> None:
    """Print and keep tables and sentences, draw the figures, and say what failed."""
    from gripscale.case import folder
    from gripscale.charts.write import draw_uncertainty
    from gripscale.report import tables_run
    from gripscale.report.tables_uncertainty import failures, parts

    told = parts(data)
    console.print()
    for part in told:
        if isinstance(part, str):
            print_wrapped(console, part)
        else:
            console.print(part)
    folder.write_text(target / "uncertainty.txt", tables_run.as_text(*told))
    draw_uncertainty(data, target / "figures")
    console.print()
    print_wrapped(console, f"Result (uncertainty.nc), table and figures are in {target}")
    sentence = failures(data)
    if sentence:
        print_error(sentence)
        raise typer.Exit(NOT_CONVERGED)


# `gripscale calibrate CASE.toml`: the area term fitted to measured friction.


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
    from gripscale.analysis.calibration import calibrate_case, measured_of
    from gripscale.analysis.calibration_text import parse_fixed
    from gripscale.analysis.measured_friction import read_measured_friction
    from gripscale.case import folder, read_case

    known = parse_fixed(fixed or [])
    file = read_case(case)
    friction = measured_of(file) if measured is None else read_measured_friction(measured)
    target = output or file.resolve(file.case.output.folder) / "calibration"
    folder.require_writable(target)
    console = screen()
    print_wrapped(console, f"Area term of {file.path} from {friction.source}")
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
        on_task=progress_printer(console),
    )
    parts = list(_parts(made, model, file.text))
    print_parts(console, parts)
    _keep(made, file, parts, target)
    console.print()
    print_wrapped(console, f"Table, figures, result and [conditions.shear_stress] are in {target}")
    failed = [status for status in made.predicted.status if status != "converged"]
    if failed:
        print_error(
            f"{len(failed)} of {len(made.predicted.status)} measured points have no prediction; "
            f"the first: {failed[0]}"
        )
        raise typer.Exit(NOT_CONVERGED)


def _parts(made: Calibration, model: str, case: str) -> list[Any]:
    """Return the tables and sentences of a calibration."""
    from gripscale.analysis.calibration_text import notes
    from gripscale.analysis.measured_comparison import residuals
    from gripscale.report.tables_measured import residual_table
    from gripscale.report.tables_uncertainty import correlations, held_out_table, parameter_table

    beside = residuals(made.measured, {model: made.predicted}, made.law).assign_attrs(case=case)
    parts = [residual_table(beside), parameter_table(made), *filter(None, [correlations(made)])]
    if made.held_out:
        parts.append(held_out_table(made))
    return [*parts, *notes(made)]


def _keep(made: Calibration, file: CaseFile, parts: list[Any], target: Path) -> None:
    """Write result, tables, figures and the table of the law into the folder."""
    from gripscale.analysis.calibration_text import shear_stress_table
    from gripscale.case import folder
    from gripscale.charts.write import draw_calibration
    from gripscale.io import netcdf
    from gripscale.report import tables_run

    data = made.to_dataset().assign_attrs(case=file.text, case_file=str(file.path))
    netcdf.save(data, target / "calibration.nc")
    folder.write_text(target / "calibration.txt", tables_run.as_text(*parts))
    folder.write_text(target / "shear_stress.toml", shear_stress_table(made))
    draw_calibration(data, target)
