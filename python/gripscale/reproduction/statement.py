"""The paper's statements, judged: what was said, what came out, whether that is the same."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from gripscale.io.folders import write_text
from gripscale.io.table import Column, Table, whole_number


@dataclass(frozen=True)
class Statement:
    """A statement about a figure with what came out at one surface, compound and speed."""

    figure: str
    said: str  # what Lind & Wangenheim 2014 state, in our words; for figures 2 and 3b they assume
    criterion: str  # what has to come out for it to hold, and why that much
    where: str  # surface, compound and speed it was looked for at
    number: str
    holds: bool | None
    why_not: str  # empty where it holds

    @property
    def verdict(self) -> str:
        """`holds`, `does not hold` or `not judged`."""
        return {True: "holds", False: "does not hold", None: "not judged"}[self.holds]


def number_holding(statements: Sequence[Statement]) -> str:
    """Return how many statements hold, as a sentence without its end."""
    held, unjudged = (sum(s.holds is verdict for s in statements) for verdict in (True, None))
    words = f"{held} of {len(statements)} statements hold"
    return words + (f", {unjudged} cannot be judged with these inputs" if unjudged else "")


def verdict_table(statements: Sequence[Statement]) -> Table:
    """Return how often each claim holds, does not hold, or is not judged."""
    ordered = sorted(statements, key=lambda s: (s.figure, s.said))
    rows = [(key, list(same)) for key, same in groupby(ordered, lambda s: (s.figure, s.said))]
    figures = [figure.removeprefix("fig") for (figure, _), _ in rows]
    columns = [Column("figure", figures), Column("statement", [said for (_, said), _ in rows])]
    for verdict in ("holds", "does not hold", "not judged"):
        counts = [sum(s.verdict == verdict for s in same) or None for _, same in rows]
        columns.append(Column(verdict, counts, format=whole_number))
    return Table("statements", columns, notes=[f"{number_holding(statements)}."])


def write_statements(statements: Sequence[Statement], folder: Path) -> None:
    """Write `statements.json` and `statements.md` into `folder`."""
    table = [{**vars(s), "verdict": s.verdict} for s in statements]
    write_text(folder / "statements.json", json.dumps(table, indent=1, ensure_ascii=False) + "\n")
    page = "# The paper's statements, and what came out\n\n"
    page += f"Lind & Wangenheim 2014, IMECE2014-37998, Figs 2 to 9. {number_holding(statements)}.\n"
    page += as_markdown(statements, lambda figure: f"\n## {figure}\n")
    write_text(folder / "statements.md", page)


def as_markdown(statements: Sequence[Statement], heading: Callable[[str], str]) -> str:
    """Return a table for each claim of each figure, below the `heading` of the figure."""
    lines = []
    for figure, of_figure in groupby(statements, lambda s: s.figure):
        lines.append(heading(figure))
        in_order = sorted(of_figure, key=lambda s: (s.said, s.criterion))
        for (said, criterion), same in groupby(in_order, lambda s: (s.said, s.criterion)):
            lines += [f"**{said[0].upper()}{said[1:]}.** Holds if: {criterion}.", ""]
            lines += ["| at | number | verdict |", "|---|---|---|", *map(_row, same), ""]
    return "\n".join(lines)


def _row(statement: Statement) -> str:
    why = f": {statement.why_not}" if statement.why_not else ""
    cells = (statement.where, statement.number, f"**{statement.verdict}**{why}")
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
