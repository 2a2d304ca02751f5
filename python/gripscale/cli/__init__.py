"""The `gripscale` command; each of its commands has a file of its own.

The files import what computes inside their functions, so that help and a misspelt option answer at
once.
"""

from __future__ import annotations

import gc
import os
import shlex
import sys
from collections.abc import Callable
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from gripscale.cli.docs import docs
from gripscale.cli.export import export
from gripscale.cli.inputs import fit_rubber, fit_surface, init, keys
from gripscale.cli.new import KindCommand, look_at, new
from gripscale.cli.reproduce import reproduce
from gripscale.cli.run import open_app as app_command
from gripscale.cli.run import report_command, run
from gripscale.core.provenance import COMMAND, version_of
from gripscale.questions.registry import commands

WIDEST_HELP = 140  # characters of the longest lines of help, in a terminal that is as wide
EPILOGUE = (
    "To start: `gripscale new ROAD RUBBER` writes a case for your files, `gripscale init FOLDER` "
    "an example; `gripscale keys` lists what a case may say, `gripscale docs` opens the "
    "documentation."
)


class Commands(TyperGroup):
    """The commands, which results are to name as they were typed."""

    def main(self, args: Any = None, *rest: Any, **options: Any) -> Any:
        """Note the words of the command and run it."""
        COMMAND.set(shlex.join(["gripscale", *(sys.argv[1:] if args is None else args)]))
        return super().main(args, *rest, **options)


app = typer.Typer(
    name="gripscale",
    cls=Commands,
    epilog=EPILOGUE,
    context_settings={"max_content_width": WIDEST_HELP},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    no_args_is_help=True,
)


def _enter(name: str, function: Callable[..., None], **settings: Any) -> None:
    """Enter a command; the list of commands has its first sentence, however long it is."""
    summary = (function.__doc__ or "").partition("\n\n")[0]
    app.command(name, short_help=summary, **settings)(function)


_enter("init", init)
_enter("new", new, cls=KindCommand)
_enter("look", look_at, cls=KindCommand)
_enter("run", run)
for name, question in commands():
    _enter(name, question)
_enter("report", report_command)
_enter("reproduce", reproduce)
_enter("fit-surface", fit_surface)
_enter("fit-rubber", fit_rubber)
_enter("keys", keys)
_enter("docs", docs)
_enter("app", app_command)
app.add_typer(export, name="export")


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"gripscale {version_of('gripscale')}")
        raise typer.Exit


@app.callback()
def gripscale(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Real contact area and friction of rubber on rough surfaces."""


def main() -> None:
    """Run the command line.

    Systems of equations in Python are small: the threads of BLAS would wait more than they compute,
    a sixth of the processor time of a run. To look for circles of garbage each 700 objects takes
    another twentieth. xarray imports Dask, where it is installed, to ask whether an array is one of
    its own: 0.2 s, which only a cluster needs.
    """
    sys.modules.setdefault("dask", None)  # type: ignore[arg-type]
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read as numpy is imported
    gc.set_threshold(50_000, *gc.get_threshold()[1:])
    try:
        app(prog_name="gripscale")
    finally:
        gc.freeze()  # the process ends: its memory need not be looked through once more
