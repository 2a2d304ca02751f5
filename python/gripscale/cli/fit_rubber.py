"""`gripscale fit-rubber FILE`: the rubber half of a run, from a master curve to a Prony series."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from gripscale.cli.terminal import command, say, screen


def _option(text: str) -> Any:
    return typer.Option(help=text, show_default=False)


@command
def fit_rubber(
    file: Annotated[str, typer.Argument(help="The master curve.", show_default=False)],
    terms: Annotated[int | None, _option("Relaxation times; chosen if not given.")] = None,
    frequency_unit: Annotated[str | None, _option("Where the header does not state it.")] = None,
    modulus_unit: Annotated[str | None, _option("Where the header does not state it.")] = None,
    modulus: Annotated[str | None, _option("E (Young) or G (shear).")] = None,
    bulk_modulus: Annotated[str | None, _option('Such as "2 GPa".')] = None,
    output: Annotated[
        Path | None, typer.Option(help="Folder for figures.", metavar="DIR", readable=False)
    ] = None,
) -> None:
    """Fit a Prony series to a master curve of storage and loss modulus."""
    from gripscale.case import RubberSource, folder, prepare_rubber, validate
    from gripscale.report.inputs_text import band_table, prony_table, rubber_lines

    stated = {
        "file": file,
        "terms": terms,
        "frequency_unit": frequency_unit,
        "modulus_unit": modulus_unit,
        "modulus": modulus,
        "bulk_modulus": bulk_modulus,
    }
    values = {key: value for key, value in stated.items() if value is not None}
    source = validate(RubberSource, values, "options")
    if output is not None:
        folder.require_writable(output)
    prepared = prepare_rubber(source)
    console = screen()
    rubber = prepared.rubber
    for line in (*rubber_lines(prepared), *band_table(rubber), *prony_table(rubber)):
        say(console, line)
    if output is not None:
        from gripscale.figures.case_all import rubber_figure

        folder.make(output)
        rubber_figure(prepared, (), output)
        say(console, f"The figure is in {output}")
