"""`gripscale reproduce`: the paper's figures and its statements, judged by number."""

from __future__ import annotations

import textwrap
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console

from gripscale.cli import folder
from gripscale.cli.options import Cluster, Workers
from gripscale.cli.terminal import command, say, screen

if TYPE_CHECKING:
    from gripscale.reproduce import Statement
    from gripscale.study import Progress


@command
def reproduce(
    figures: Annotated[
        list[str] | None,
        typer.Argument(
            help="fig2 fig3b fig4 fig5a fig5b fig6a fig6b fig7a fig7b fig8a fig8b fig9a fig9b; "
            "all by default.",
            show_default=False,
        ),
    ] = None,
    output: Annotated[
        Path, typer.Option(help="Folder for the results.", metavar="DIR", readable=False)
    ] = Path("reproduction"),
    data: Annotated[
        Path | None,
        typer.Option(
            help="Folder examples/data of gripscale's source, where it is not found by itself.",
            metavar="DIR",
            readable=False,
            show_default=False,
        ),
    ] = None,
    workers: Workers = None,
    cluster: Cluster = None,
) -> None:
    """Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements."""
    from gripscale.reproduce import reproduce as make
    from gripscale.reproduce.run import chosen

    names = chosen(figures or ["all"])
    folder.require_writable(output)
    console = screen()
    say(console, f"Reproducing {', '.join(names)}")
    start = time.perf_counter()
    statements = make(
        names,
        output,
        data=data,
        workers=workers,
        client=cluster,
        on_case=_teller(console),
    )
    console.print()
    for statement in statements:
        _tell(console, statement)
    held = sum(statement.holds for statement in statements)
    console.print()
    seconds = time.perf_counter() - start
    say(console, f"{held} of {len(statements)} statements hold; {seconds:.0f} s")
    say(console, f"Figures, data and statements.md are in {output}")


def _teller(console: Console) -> Any:
    def tell(progress: Progress) -> None:
        attrs = progress.result.attrs
        how = "already solved" if progress.stored else f"{progress.seconds:.1f} s"
        status = attrs["case_status"]
        words = "" if status == "converged" else f" {status};"
        say(console, f"[{progress.done}/{progress.total}] {progress.label}:{words} {how}")

    return tell


def _tell(console: Console, statement: Statement) -> None:
    """Print one statement: verdict, what was said, what came out, why not."""
    say(console, f"{statement.figure}: {statement.verdict.upper()}: {statement.said}")
    for label, text in (
        ("at", statement.where),
        ("number", statement.number),
        ("why", statement.why_not),
    ):
        if text:
            lines = textwrap.wrap(text, console.width - 12)
            say(console, f"    {label:>6}: {lines[0]}")
            for line in lines[1:]:
                say(console, f"            {line}")
