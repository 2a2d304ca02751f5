"""`gripscale study CASE.toml --vary ...`: one case with one or two of its inputs varied."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.cli.options import CasePath, Cluster, OwnFolder, Workers
from gripscale.cli.progress import teller
from gripscale.cli.terminal import NOT_CONVERGED, command, complain, pointed, say, say_all, screen
from gripscale.errors import InputError

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console


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
    from gripscale.study import Study
    from gripscale.study.axes import parse_vary

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
        say(console, line)
    folder.make(target / "figures")
    folder.save_case(made.file, target)
    result = made.run(target, workers=workers, client=cluster, on_task=teller(console))
    _conclude(console, opening, result, target, drawn=known is not None)


def _conclude(
    console: Console, opening: list[str], result: xr.Dataset, target: Path, *, drawn: bool
) -> None:
    """Print and keep the table, draw the figures, and say which predictions failed."""
    from gripscale.case import folder
    from gripscale.report import tables
    from gripscale.report.study_table import study_table

    parts = [study_table(result), *_below(result)]
    say_all(console, parts)
    folder.write_text(target / "study.txt", tables.as_text(*opening, *parts))
    figures = target / "figures"
    if not (drawn and any(figures.iterdir())):
        from gripscale.figures.study_all import draw

        draw(result, figures)
    console.print()
    say(console, f"Result (study.nc), table and figures are in {target}")
    statuses = result.prediction_status.values.ravel().tolist()
    if "static_prediction_status" in result:
        statuses += result.static_prediction_status.values.ravel().tolist()
    failed = [status for status in statuses if status != "converged"]
    if failed:
        complain(
            f"{len(failed)} of {len(statuses)} predictions have no totals; the first: "
            f"{pointed(failed[0])}"
        )
        raise typer.Exit(NOT_CONVERGED)


def _below(result: xr.Dataset) -> list[str]:
    """Return the sentences below the table: what is extrapolated, and temperatures over a_T v."""
    from gripscale.report.outside_band import study_sentence
    from gripscale.report.temperature_text import collapse_sentences, shift_sentence

    beyond, shifted = study_sentence(result), shift_sentence(result)
    return [
        *([beyond] if beyond else []),
        *([f"* {shifted}"] if shifted else []),
        *(f"Over a_T v, {words}: {text}." for words, text in collapse_sentences(result)),
    ]
