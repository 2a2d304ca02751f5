"""The look of tables in the terminal: a rule below the heads, columns close to each other."""

from __future__ import annotations

from rich import box
from rich.table import Table


def printed_table(title: str | None = None, *, padding: int = 1) -> Table:
    """Return a table without columns or rows; `padding` spaces follow each column."""
    return Table(
        title=title,
        title_justify="left",
        title_style="",
        box=box.SIMPLE_HEAD,
        padding=(0, padding, 0, 0),
        pad_edge=False,
    )
