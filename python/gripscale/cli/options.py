"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

CasePath = Annotated[
    Path, typer.Argument(help="The case file (TOML).", metavar="CASE.toml", readable=False)
]

OwnFolder = Annotated[
    Path | None,
    typer.Option(
        "--output",
        help="Results folder, instead of this command's own in that of the case.",
        metavar="DIR",
        readable=False,
    ),
]

Measured = Annotated[
    Path | None,
    typer.Option(
        "--measured",
        help="Measured friction, instead of what the case names: a table with columns speed and "
        "friction, and if known spread, temperature and pressure.",
        metavar="FILE.csv",
        readable=False,
    ),
]

Workers = Annotated[
    int | None, typer.Option(help="Cores to use; all by default.", show_default=False)
]

Cluster = Annotated[
    str | None,
    typer.Option(
        help='"local", or the address of a Dask scheduler: tcp://host:8786.', show_default=False
    ),
]
