"""`gripscale compare CASE.toml`: the models side by side over the same measurements."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
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
    from rich.table import Table

    from gripscale.analysis.comparison_dataset import Comparison
    from gripscale.analysis.compounds import Compounds
    from gripscale.analysis.roads import Roads
    from gripscale.case import CaseResults


@command
def compare(
    case: CasePath,
    vary: Annotated[
        str | None,
        typer.Option(
            help="Compare over one input, as `gripscale study` varies it: speed=0.003:30:log9, "
            "pressure='1 bar,3 bar', temperature='20 C,40 C', smallest_wavelength, cut_off, "
            "upper_share, waves.",
            metavar="NAME=VALUES",
            show_default=False,
        ),
    ] = None,
    measured: Measured = None,
    rungs: Annotated[
        str | None,
        typer.Option(
            help="Models wanted, by name or group (waves, measured, theory, windows, map), such "
            "as 'chain,measured'; windows and map take a minute or two. By default all.",
            show_default=False,
        ),
    ] = None,
    output: OwnFolder = None,
    seeds: Annotated[int, typer.Option(help="Random phases drawn of each surface.")] = 3,
    tolerance: Annotated[
        float, typer.Option(help="Estimated relative error of each direct contact.")
    ] = 0.05,
    workers: Workers = None,
    cluster: Cluster = None,
) -> None:
    """Show what each assumption of the chain costs; resumes where it was stopped."""
    from gripscale.analysis.comparison import at_measured, compare_case, compare_over
    from gripscale.analysis.measured_friction import read_measured_friction
    from gripscale.analysis.propagation import input_digests, stored_uncertainty
    from gripscale.case import folder, prepare_case, read_case
    from gripscale.experiment.axis import parse_vary
    from gripscale.experiment.task import PREDICTIONS
    from gripscale.report.tables_uncertainty import uncertainty_lines

    axes = None if vary is None else dict([parse_vary(vary)])
    file = read_case(case)
    target = output or file.resolve(file.case.output.folder) / "comparison"
    folder.require_writable(target)
    console = screen()
    print_wrapped(console, f"Comparison of models for {file.path}")
    folder.make(target)
    options: dict[str, Any] = {
        "seeds": seeds,
        "tolerance": tolerance,
        "rungs": [] if rungs is None else [name.strip() for name in rungs.split(",")],
        "measured": None if measured is None else read_measured_friction(measured),
        "folder": target,
        "workers": workers,
        "client": cluster,
        "on_task": progress_printer(console),
    }
    made: Comparison
    worth: list[xr.Dataset] = []
    beside: xr.Dataset | None = None
    if axes is None:
        results = prepare_case(file)
        made = compare_case(results, **options)
        solving = {key: options[key] for key in ("workers", "client", "on_task")}
        worth = _effects(results, options["tolerance"], target, solving)
        beside = at_measured(made, target / PREDICTIONS, **solving)
    else:
        made = compare_over(file, axes, **options)
    results_folder = file.resolve(file.case.output.folder)
    sampled = uncertainty_lines(stored_uncertainty(results_folder), file.text, input_digests(file))
    failed = _conclude_comparison(console, made.to_dataset(), target, worth, beside, sampled)
    if failed:
        print_error(
            f"{len(failed)} of the rungs have failed samples; the first: {with_doc_link(failed[0])}"
        )
        raise typer.Exit(NOT_CONVERGED)


def _effects(
    results: CaseResults, tolerance: float, target: Path, solving: dict[str, Any]
) -> list[xr.Dataset]:
    """Return what each effect is worth in the chain and in the direct contact of what was measured.

    Nothing without conditions.
    """
    from gripscale.analysis.effects import case_effects
    from gripscale.experiment.task import PREDICTIONS
    from gripscale.half_space.model import DirectContact
    from gripscale.model import Model

    models: list[Model] = [results.chain] if results.conditions is not None else []
    if models and results.surface.measured is not None:
        models.append(DirectContact(tolerance=tolerance, conditions=results.conditions))
    store = target / PREDICTIONS
    found = (case_effects(results, model, target, store, **solving) for model in models)
    return [one for one in found if one is not None]


def _conclude_comparison(
    console: Console,
    data: xr.Dataset,
    target: Path,
    worth: list[xr.Dataset],
    beside: xr.Dataset | None,
    sampled: list[str],
) -> list[str]:
    """Print and keep tables, figures and the result; return what did not converge."""
    from gripscale.case import folder
    from gripscale.charts.comparison import at_measured_figure
    from gripscale.charts.ladder import varied
    from gripscale.charts.paper import save_figure
    from gripscale.charts.write import draw_comparison, draw_effects
    from gripscale.io import netcdf
    from gripscale.report import tables_run
    from gripscale.report.tables_comparison import (
        axis_table,
        beyond_band,
        comparison_table,
        effects_table,
        further_table,
        remarks,
        temperature_only,
    )
    from gripscale.report.tables_measured import residual_tables

    axis = varied(data)
    name = f"over_{axis}" if axis else "comparison"
    netcdf.save(data, target / f"{name}.nc")
    parts: list[Any]
    if axis:
        parts = [axis_table(data, axis, quantity) for quantity in ("contact_fraction", "friction")]
        parts += [*beyond_band(data), *temperature_only(data)]
    else:
        parts = [comparison_table(data), *remarks(data), further_table(data)]
    if worth:
        parts.append(effects_table(*worth))
        draw_effects(worth, target)
    if beside is not None:
        netcdf.save(beside, target / "at_measured.nc")
        parts += residual_tables(beside)
        labels = dict(zip(data.rung.values.tolist(), data.label.values.tolist(), strict=True))
        save_figure(at_measured_figure(beside, labels), target, "at_measured")
    parts += sampled
    print_parts(console, parts)
    folder.write_text(target / f"{name}.txt", tables_run.as_text(*parts))
    draw_comparison(data, target)
    console.print()
    print_wrapped(console, f"Tables, figures and result ({name}.nc) are in {target}")
    return list(_failures(data, axis))


def _failures(data: xr.Dataset, axis: str) -> Iterable[str]:
    """Yield a sentence on each rung with a sample that did not converge."""
    from gripscale.experiment.axis import axis_shown

    places = [(None, data)] if not axis else [(v, data.sel({axis: v})) for v in data[axis].values]
    for value, one in places:
        for label, status in zip(one.label.values, one.status.values, strict=True):
            if str(status) != "converged":
                at = "" if value is None else axis_shown(data, axis).text(value, 4)
                where = f"{axis.replace('_', ' ')} {at}, " if at else ""
                yield f"{where}{label} did not converge: {status}"


# What the commands that put things side by side share: names, the case of the rest, the end.


def case_of(given: Sequence[str], case: Path | None, what: str) -> Path:
    """Return the case the rest is taken from: the one stated, or the first of those given.

    Raises `InputError` if there is none; `what` is taken from it.
    """
    chosen = case or next((Path(one) for one in given if one.endswith(".toml")), None)
    if chosen is None:
        raise InputError(f"--case must be given: {what} are taken from a case")
    return chosen


def names_of(given: Sequence[str]) -> list[str]:
    """Return what is put on the table: files, cases by their folder, each name once."""
    names: list[str] = []
    for one in given:
        path = Path(one)
        name = path.resolve().parent.name if path.name == "case.toml" else path.stem
        count = sum(known == name or known.startswith(f"{name} ") for known in names)
        names.append(f"{name} {count + 1}" if count else name)
    return names


def save_tables(console: Console, path: Path, told: Sequence[Table], below: Sequence[str]) -> None:
    """Print tables with the sentences below them, and write both to `path`."""
    from gripscale.case import folder
    from gripscale.report import tables_run

    parts = [*told, *below]
    print_parts(console, parts)
    folder.write_text(path, tables_run.as_text(*parts))


def fail_if_any(failed: Sequence[str], what: str) -> None:
    """Complain of what has no totals, with the reason of the first, and end the command."""
    if failed:
        print_error(f"{len(failed)} of the {what} have no totals; the first: {failed[0]}")
        raise typer.Exit(NOT_CONVERGED)


# `gripscale compare-surfaces A B ... --case CASE.toml`: roads side by side under one rubber.


@command
def compare_surfaces(
    surfaces: Annotated[
        list[str],
        typer.Argument(
            help="Two to six roads: files of profiles, cases (their surface), or surfaces known by "
            "name. The others are compared with the first.",
            metavar="SURFACE...",
            show_default=False,
        ),
    ],
    case: Annotated[
        Path | None,
        typer.Option(
            help="Case whose rubber, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
            readable=False,
            show_default=False,
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
    from gripscale.analysis.roads import compare_surfaces as compare
    from gripscale.case import folder, read_case

    file = read_case(case_of(surfaces, case, "the rubber and the load"))
    target = output or file.resolve(file.case.output.folder) / "surfaces"
    folder.require_writable(target)
    console = screen()
    folder.make(target)
    made = compare(
        file,
        dict(zip(names_of(surfaces), surfaces, strict=True)),
        target,
        samples=samples or None,
        workers=workers,
        on_task=progress_printer(console),
    )
    _conclude_surfaces(console, made, target)


def _conclude_surfaces(console: Console, made: Roads, target: Path) -> None:
    """Print and keep the table, draw figures and page, and say which predictions failed."""
    from gripscale.charts.paper import save_figure
    from gripscale.charts.side_by_side import roads_friction_figure, roads_statistics_figure
    from gripscale.report import write_report
    from gripscale.report.tables_comparison import roads_failures, roads_sentences, roads_tables

    below = [*roads_sentences(made.data), *(f"note: {note}" for note in made.notes)]
    save_tables(console, target / "surfaces.txt", roads_tables(made.data), below)
    save_figure(roads_statistics_figure(made.data), target, "roads_statistics")
    save_figure(roads_friction_figure(made.data), target, "roads_friction")
    console.print()
    print_wrapped(console, f"Result (surfaces.nc), table and figures are in {target}")
    try:
        print_wrapped(console, f"Page: {write_report(target / 'surfaces.nc')}")
    except InputError as error:  # the extra is not installed
        print_wrapped(console, f"note: no page; {error}")
    fail_if_any(roads_failures(made.data), "predictions")


# `gripscale compare-rubbers A B ... --case CASE.toml`: compounds side by side on one road.


@command
def compare_rubbers(
    rubbers: Annotated[
        list[str],
        typer.Argument(
            help="Two to six compounds: files of moduli, cases (their rubber), or rubbers known by "
            "name. The others are compared with the first.",
            metavar="RUBBER...",
            show_default=False,
        ),
    ],
    case: Annotated[
        Path | None,
        typer.Option(
            help="Case whose road, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
            readable=False,
            show_default=False,
        ),
    ] = None,
    temperature: Annotated[
        str | None,
        typer.Option(
            help='Such as "20 C"; by default one that all have or can be shifted to.',
            show_default=False,
        ),
    ] = None,
    uncertainty: Annotated[
        bool, typer.Option(help="Predict what each measurement leaves open, too.")
    ] = True,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Compare compounds on the same road: friction, area, and what makes the difference."""
    from gripscale.analysis.compounds import compare_compounds
    from gripscale.case import folder, read_case
    from gripscale.core.units import parse_quantity

    chosen = case_of(rubbers, case, "the road and the load")
    try:
        kelvin = None if temperature is None else parse_quantity(temperature, "temperature")
    except ValueError as error:
        raise InputError(f"--temperature = {temperature!r}: {error}") from error
    file = read_case(chosen)
    target = output or file.resolve(file.case.output.folder) / "rubbers"
    folder.require_writable(target)
    console = screen()
    folder.make(target)
    if uncertainty:
        print_wrapped(
            console, "The compounds; then, for what their measurements leave open, half-planes."
        )
    made = compare_compounds(
        file,
        dict(zip(names_of(rubbers), rubbers, strict=True)),
        target,
        temperature=kelvin,
        uncertainty=uncertainty,
        workers=workers,
        on_task=progress_printer(console),
    )
    _conclude_rubbers(console, made, target)


def _conclude_rubbers(console: Console, made: Compounds, target: Path) -> None:
    """Print and keep the table, draw the figures, and say which predictions failed."""
    from gripscale.charts.paper import save_figure
    from gripscale.charts.rubber import compound_moduli_figure
    from gripscale.charts.side_by_side import compound_friction_figure
    from gripscale.report.tables_comparison import compounds_sentences, compounds_table

    table = compounds_table(made.data)
    below = [*compounds_sentences(made.data), *(f"note: {note}" for note in made.notes)]
    save_tables(console, target / "compounds.txt", [table], below)
    save_figure(compound_moduli_figure(made.rubbers), target, "compound_moduli")
    if "friction_running" in made.data:
        save_figure(compound_friction_figure(made.data), target, "compound_friction")
    console.print()
    print_wrapped(console, f"Result (compounds.nc), table and figures are in {target}")
    statuses = made.data.prediction_status.values.tolist()
    fail_if_any([one for one in statuses if one != "converged"], "compounds")
