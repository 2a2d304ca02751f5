"""`gripscale init FOLDER`: an example to start from, with its data."""

from __future__ import annotations

import shlex
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from gripscale.cli.terminal import command, say, screen


class Choice(StrEnum):
    """Names of the examples."""

    road = "road"
    synthetic = "synthetic"
    map = "map"


@command
def init(
    folder: Annotated[
        Path,
        typer.Argument(help="Where to write; made if needed.", metavar="FOLDER", readable=False),
    ],
    example: Annotated[
        Choice,
        typer.Option(
            help="road: a measured road and a measured tread rubber; synthetic: a made-up road "
            "and a named rubber; map: a measured map, which needs gripscale[formats] to be read."
        ),
    ] = Choice.road,
) -> None:
    """Write a commented case and example data to start from; nothing is overwritten."""
    from gripscale.init import EXAMPLES, write_example

    written = write_example(folder, example)
    console = screen()
    say(console, f"{folder}: {EXAMPLES[example].about}")
    for path in written:
        say(console, f"  {path.relative_to(folder)}")
    console.print()
    say(console, "Next:")
    if EXAMPLES[example].needs:
        say(console, f'  pip install "gripscale[{EXAMPLES[example].needs}]"')
    for words in (("run", written[0]), ("report", folder / "results"), ("compare", written[0])):
        say(console, f"  {shlex.join(['gripscale', *map(str, words)])}")
