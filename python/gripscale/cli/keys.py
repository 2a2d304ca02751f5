"""`gripscale keys [SECTION]`: what a case file may say."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.cli.terminal import command, say, screen

if TYPE_CHECKING:
    from rich.table import Table

    from gripscale.case.keys import Section


@command
def keys(
    section: Annotated[
        str | None,
        typer.Argument(
            help="A table of the case, such as rubber or conditions.heat; all by default.",
            metavar="SECTION",
            show_default=False,
        ),
    ] = None,
) -> None:
    """List every key of a case file: what it takes, its default, its meaning."""
    from gripscale import checks
    from gripscale.case.keys import sections

    known = sections()
    if section is not None:
        checks.one_of("section", section, dict.fromkeys(one.name for one in known))
    console = screen()
    for one in known:
        if section in (None, one.name, one.name.partition(".")[0]):
            console.print()
            console.print(_table(one))
            pages = dict.fromkeys(f"docs/{key.chapter}" for key in one.keys)
            say(console, f"More in {', '.join(pages)}.")


def _table(section: Section) -> Table:
    from rich import box
    from rich.table import Table

    table = Table(
        title=f"{section.title}: {section.about}",
        title_justify="left",
        box=box.SIMPLE_HEAD,
        expand=True,
    )
    table.add_column("key", no_wrap=True)
    for heading, ratio in (("takes", 3), ("default", 1), ("meaning", 4)):
        table.add_column(heading, ratio=ratio, overflow="fold")
    for key in section.keys:
        table.add_row(key.name, key.takes, key.default, key.meaning)
    return table
