"""What the commands share: where they print, and how an error becomes one sentence and a code."""

from __future__ import annotations

import os
import sys
import textwrap
from collections.abc import Callable, Iterable
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec

import typer

from gripscale.errors import ConvergenceError, GripscaleError

if TYPE_CHECKING:
    from rich.console import Console

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


def complain(message: str) -> None:
    """Print one sentence to stderr, unwrapped."""
    from rich.text import Text

    text = Text("error: ", style="bold red").append(message, style="not bold default")
    screen(stderr=True).print(text, soft_wrap=True)


def pointed(failure: object) -> str:
    """Return a failure in words, with the chapter of the documentation that says more."""
    from gripscale.report.chapters import pointer

    return f"{failure}{pointer(failure)}"


def say(console: Console, message: str) -> None:
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


def say_all(console: Console, parts: Iterable[Any]) -> None:
    """Print sentences as lines, and each table after an empty one."""
    for part in parts:
        if isinstance(part, str):
            say(console, part)
        else:
            console.print()
            console.print(part)


def command(body: Callable[P, None]) -> Callable[P, None]:
    """Return `body` with gripscale's own errors turned into a sentence and an exit code."""

    @wraps(body)
    def inside(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            body(*args, **kwargs)
        except ConvergenceError as error:
            complain(pointed(error))
            raise typer.Exit(NOT_CONVERGED) from None
        except GripscaleError as error:
            complain(pointed(error))
            raise typer.Exit(BAD_INPUT) from None
        except KeyboardInterrupt:
            complain(
                "stopped; what is finished is kept in the output folder, "
                "and the same command goes on from it"
            )
            raise typer.Exit(STOPPED) from None

    return inside
