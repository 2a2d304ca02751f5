"""Options that several commands share."""

from __future__ import annotations

from typing import Annotated

import typer

Workers = Annotated[
    int | None, typer.Option(help="Cores to use; all by default.", show_default=False)
]

Cluster = Annotated[
    str | None,
    typer.Option(
        help='"local", or the address of a Dask scheduler: tcp://host:8786.', show_default=False
    ),
]
