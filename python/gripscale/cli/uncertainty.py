"""`gripscale uncertainty CASE.toml`: what is not known of a case, and what it does to friction."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.cli.options import CasePath, Cluster, OwnFolder, Workers
from gripscale.cli.progress import teller
from gripscale.cli.terminal import NOT_CONVERGED, command, complain, say, screen
from gripscale.errors import InputError

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console


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
    from gripscale import checks
    from gripscale.case import folder, read_case
    from gripscale.study.axes import parse_vary
    from gripscale.uncertainty import Uncertainty, propagate
    from gripscale.uncertainty.propagate import BOTH
    from gripscale.uncertainty.quantities import length

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
    say(console, f"Uncertainty of {file.path}")
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
        on_task=teller(console),
    )
    _conclude(console, data, target)


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


def _conclude(console: Console, data: xr.Dataset, target: Path) -> None:
    """Print and keep tables and sentences, draw the figures, and say what failed."""
    from gripscale.case import folder
    from gripscale.figures.uncertainty import draw
    from gripscale.report import tables
    from gripscale.report.uncertainty_table import failures, parts

    told = parts(data)
    console.print()
    for part in told:
        if isinstance(part, str):
            say(console, part)
        else:
            console.print(part)
    folder.write_text(target / "uncertainty.txt", tables.as_text(*told))
    draw(data, target / "figures")
    console.print()
    say(console, f"Result (uncertainty.nc), table and figures are in {target}")
    sentence = failures(data)
    if sentence:
        complain(sentence)
        raise typer.Exit(NOT_CONVERGED)
