"""`gripscale compare CASE.toml`: the models side by side over the same measurements."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.cli.terminal import NOT_CONVERGED, command, complain, say, screen

if TYPE_CHECKING:
    from gripscale.case.compare import Rung


@command
def compare(
    case: Annotated[
        Path, typer.Argument(help="The case file (TOML).", metavar="CASE.toml", readable=False)
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            help="Results folder, instead of `comparison` in the one of the case.",
            metavar="DIR",
            readable=False,
        ),
    ] = None,
    seeds: Annotated[int, typer.Option(help="Random phases drawn of each surface.")] = 3,
    tolerance: Annotated[
        float, typer.Option(help="Estimated relative error of each direct contact.")
    ] = 0.05,
) -> None:
    """Show what each assumption of the chain costs: table, figure and result file."""
    from gripscale import checks, netcdf
    from gripscale.case import folder, prepare_case, read_case
    from gripscale.case.compare import compare_case
    from gripscale.figures.comparison import comparison_figure
    from gripscale.figures.style import save_figure
    from gripscale.report import comparison_table, tables

    count = checks.whole("seeds", seeds, least=1, most=1000)
    error = checks.positive("tolerance", tolerance)
    file = read_case(case)
    target = output or file.resolve(file.case.output.folder) / "comparison"
    folder.require_writable(target)
    console = screen()
    say(console, f"Comparison of models for {file.path}")

    def tell(rung: Rung) -> None:
        say(console, f"  {rung.label}: {rung.status}, {rung.seconds:.1f} s")

    comparison = compare_case(prepare_case(file), seeds=count, tolerance=error, on_rung=tell)
    folder.make(target)
    data = comparison.to_dataset()
    netcdf.save(data, target / "comparison.nc")
    table = comparison_table.comparison_table(comparison)
    console.print()
    console.print(table)
    folder.write_text(target / "comparison.txt", tables.as_text(table))
    save_figure(comparison_figure(data), target, "comparison")
    say(console, f"Table, figure and result (comparison.nc) are in {target}")
    failed = [rung for rung in comparison.rungs if rung.status != "converged"]
    if failed:
        complain(f"{failed[0].label} did not converge: {failed[0].status}")
        raise typer.Exit(NOT_CONVERGED)
