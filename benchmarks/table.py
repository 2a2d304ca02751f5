"""One look for all tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich import box
from rich.console import Console
from rich.table import Table


def show(
    console: Console, title: str, headings: Sequence[str], rows: Iterable[Sequence[str]], note: str
) -> None:
    """Print a table with a sentence under it; the first column is text, the rest are numbers."""
    table = Table(box=box.SIMPLE_HEAD)
    for place, heading in enumerate(headings):
        table.add_column(heading, justify="left" if place == 0 else "right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    console.print(title, style="bold")
    console.print(table)
    console.print(note)
    console.print()
