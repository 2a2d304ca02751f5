"""`gripscale fit-rubber FILE`: the rubber half of a run, from a master curve to a Prony series."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from gripscale.case import RubberSource, validate
from gripscale.cli import draw, folder
from gripscale.cli.inputs import study_rubber
from gripscale.cli.summary import prony_table, rubber_lines
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
    study = study_rubber(source, Path)
    console = screen()
    for line in (*rubber_lines(study), *prony_table(study)):
        say(console, line)
    if output is not None:
        folder.make(output)
        draw.rubber_figure(output, study, np.array([]))
        say(console, f"The figure is in {output}")
