"""`gripscale compare CASE.toml`: the models side by side over the same measurements."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale.cli.options import CasePath, Cluster, Measured, OwnFolder, Workers
from gripscale.cli.progress import teller
from gripscale.cli.terminal import (
    NOT_CONVERGED,
    command,
    complain,
    pointed,
    say,
    say_all,
    screen,
)

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console

    from gripscale.case import CaseResults
    from gripscale.comparison import Comparison, ComparisonOverAxis

    Made = Comparison | ComparisonOverAxis


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
    from gripscale.case import folder, prepare_case, read_case
    from gripscale.comparison import at_measured, compare_case, compare_over
    from gripscale.measured import read_measured_friction
    from gripscale.report.uncertainty_summary import uncertainty_lines
    from gripscale.study.axes import parse_vary
    from gripscale.study.store import PREDICTIONS
    from gripscale.uncertainty.stored import input_digests, stored_uncertainty

    axes = None if vary is None else dict([parse_vary(vary)])
    file = read_case(case)
    target = output or file.resolve(file.case.output.folder) / "comparison"
    folder.require_writable(target)
    console = screen()
    say(console, f"Comparison of models for {file.path}")
    folder.make(target)
    options: dict[str, Any] = {
        "seeds": seeds,
        "tolerance": tolerance,
        "rungs": [] if rungs is None else [name.strip() for name in rungs.split(",")],
        "measured": None if measured is None else read_measured_friction(measured),
        "folder": target,
        "workers": workers,
        "client": cluster,
        "on_task": teller(console),
    }
    made: Made
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
    failed = _conclude(console, made.to_dataset(), target, worth, beside, sampled)
    if failed:
        complain(f"{len(failed)} of the rungs have failed samples; the first: {pointed(failed[0])}")
        raise typer.Exit(NOT_CONVERGED)


def _effects(
    results: CaseResults, tolerance: float, target: Path, solving: dict[str, Any]
) -> list[xr.Dataset]:
    """Return what each effect is worth in the chain and in the direct contact of what was measured.

    Nothing without conditions.
    """
    from gripscale.effects import case_effects
    from gripscale.model import Model
    from gripscale.rough.model import DirectContact
    from gripscale.study.store import PREDICTIONS

    models: list[Model] = [results.chain] if results.conditions is not None else []
    if models and results.surface.measured is not None:
        models.append(DirectContact(tolerance=tolerance, conditions=results.conditions))
    store = target / PREDICTIONS
    found = (case_effects(results, model, target, store, **solving) for model in models)
    return [one for one in found if one is not None]


def _conclude(
    console: Console,
    data: xr.Dataset,
    target: Path,
    worth: list[xr.Dataset],
    beside: xr.Dataset | None,
    sampled: list[str],
) -> list[str]:
    """Print and keep tables, figures and the result; return what did not converge."""
    from gripscale import netcdf
    from gripscale.case import folder
    from gripscale.figures.at_measured import at_measured_figure
    from gripscale.figures.case_all import draw_effects
    from gripscale.figures.comparison_all import draw
    from gripscale.figures.rungs import varied
    from gripscale.figures.style import save_figure
    from gripscale.report import tables
    from gripscale.report.comparison_table import (
        axis_table,
        beyond_band,
        comparison_table,
        further_table,
        remarks,
        temperature_only,
    )
    from gripscale.report.effects_table import effects_table
    from gripscale.report.residual_table import residual_tables

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
    say_all(console, parts)
    folder.write_text(target / f"{name}.txt", tables.as_text(*parts))
    draw(data, target)
    console.print()
    say(console, f"Tables, figures and result ({name}.nc) are in {target}")
    return list(_failures(data, axis))


def _failures(data: xr.Dataset, axis: str) -> Iterable[str]:
    """Yield a sentence on each rung with a sample that did not converge."""
    from gripscale.study.display import axis_shown

    places = [(None, data)] if not axis else [(v, data.sel({axis: v})) for v in data[axis].values]
    for value, one in places:
        for label, status in zip(one.label.values, one.status.values, strict=True):
            if str(status) != "converged":
                at = "" if value is None else axis_shown(data, axis).text(value, 4)
                where = f"{axis.replace('_', ' ')} {at}, " if at else ""
                yield f"{where}{label} did not converge: {status}"
