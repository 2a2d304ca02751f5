"""What the commands share: where they print, and how an error becomes one sentence and a code."""

from __future__ import annotations

import os
import sys
import textwrap
from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ParamSpec

import typer

from gripscale.core.errors import ConvergenceError, GripscaleError

if TYPE_CHECKING:
    from rich.console import Console

    from gripscale.experiment.solve import Progress


BAD_INPUT, NOT_CONVERGED, STOPPED = 2, 3, 130
"""Exit codes: an input that cannot be used, a wave without solution, stopped from outside."""

PLAIN_WIDTH = 100
"""Characters per line where there is no terminal to ask."""

P = ParamSpec("P")


def screen(stderr: bool = False) -> Console:
    """Return a console for a terminal, or for a plain file or pipe of sensible width."""
    from rich.console import Console

    stream = sys.stderr if stderr else sys.stdout
    wide = None if stream.isatty() or "COLUMNS" in os.environ else PLAIN_WIDTH
    return Console(stderr=stderr, width=wide, highlight=False, markup=False)


def print_error(message: str) -> None:
    """Print one sentence to stderr, unwrapped."""
    from rich.text import Text

    text = Text("error: ", style="bold red").append(message, style="not bold default")
    screen(stderr=True).print(text, soft_wrap=True)


def with_doc_link(failure: object) -> str:
    """Return a failure in words, with the chapter of the documentation that says more."""
    from gripscale.report.notices import pointer

    return f"{failure}{pointer(failure)}"


def failure_of(error: GripscaleError | KeyboardInterrupt) -> tuple[str, int]:
    """Return the sentence and the exit code a command ends with after `error`."""
    if isinstance(error, KeyboardInterrupt):
        stopped = (
            "stopped; what is finished is kept in the output folder, "
            "and the same command goes on from it"
        )
        return stopped, STOPPED
    exit_code = NOT_CONVERGED if isinstance(error, ConvergenceError) else BAD_INPUT
    return with_doc_link(error), exit_code


def print_wrapped(console: Console, message: str) -> None:
    """Print a line, continued with its own indent where too long; words and paths stay whole."""
    from rich.text import Text

    indent = " " * (len(message) - len(message.lstrip()))
    lines = textwrap.wrap(
        message,
        console.width,
        subsequent_indent=f"{indent}  ",
        break_long_words=False,
        break_on_hyphens=False,
        replace_whitespace=False,
    )
    console.print(Text("\n".join(lines)), soft_wrap=True)


def print_parts(console: Console, parts: Iterable[Any]) -> None:
    """Print sentences as lines, and each table after an empty one."""
    for part in parts:
        if isinstance(part, str):
            print_wrapped(console, part)
        else:
            console.print()
            console.print(part)


def command(body: Callable[P, None]) -> Callable[P, None]:
    """Return `body` with gripscale's own errors turned into a sentence and an exit code."""

    @wraps(body)
    def inside(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            body(*args, **kwargs)
        except (GripscaleError, KeyboardInterrupt) as error:
            message, exit_code = failure_of(error)
            print_error(message)
            raise typer.Exit(exit_code) from None

    return inside


# A line of the terminal for each prediction of many as it is done.


def progress_printer(console: Console) -> Callable[[Progress], None]:
    """Return what prints a line for each prediction."""

    def tell(progress: Progress) -> None:
        found = progress.result
        width = len(str(progress.total))
        text = f"[{progress.done:>{width}}/{progress.total}] {progress.label}: "
        if found.prediction_status != "converged":
            text += str(found.prediction_status.item())
        else:
            text += f"area {float(found.total_contact_fraction):.4g}"
            if found.nominal_speed > 0.0:
                text += f", friction {float(found.total_friction):.3f}"
        how = "already solved" if progress.stored else f"{progress.seconds:.1f} s"
        print_wrapped(console, f"{text}, {how}")

    return tell


# Options that several commands share.

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
