"""`gripscale reproduce`: hands over to the paper's figures beside the package, in a clone."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import typer

import gripscale
from gripscale.cli.terminal import command
from gripscale.errors import FileError

PASS_ON = {"allow_extra_args": True, "ignore_unknown_options": True, "help_option_names": []}
"""Settings of the command: whatever follows its name is for the reproduction."""


@command
def reproduce(context: typer.Context) -> None:
    """Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements."""
    root = Path(gripscale.__file__).resolve().parents[2]
    if not (root / "reproduction" / "__main__.py").is_file():
        raise FileError(
            "the reproduction is in the source of gripscale, not in the package: "
            "run `python -m reproduction` in a clone of it"
        )
    sys.path.insert(0, str(root))
    raise typer.Exit(importlib.import_module("reproduction.__main__").main(context.args))
