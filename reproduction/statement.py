"""The paper's statements, judged: what was said, what came out, whether that is the same."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from itertools import groupby
from pathlib import Path

from gripscale.io.netcdf import write_whole


@dataclass(frozen=True)
class Statement:
    """One statement about one figure, judged by a number."""

    figure: str
    said: str
    """What Lind & Wangenheim 2014 state, in our words; for figures 2 and 3b what they assume."""
    where: str
    """Surface, compound and speed it was looked for at."""
    criterion: str
    """What has to come out for the statement to hold, and why that much."""
    number: str
    """What came out."""
    holds: bool | None
    """None where the inputs cannot judge it, such as waves that end before a maximum."""
    why_not: str = ""
    """What shows in the inputs or the predictions why it does not hold; empty where it holds."""

    def __post_init__(self) -> None:
        if self.holds:
            object.__setattr__(self, "why_not", "")

    @property
    def verdict(self) -> str:
        """`holds`, `does not hold` or `not judged`."""
        return {True: "holds", False: "does not hold", None: "not judged"}[self.holds]


def count(statements: Sequence[Statement]) -> str:
    """Return how many statements hold, as a sentence without its end."""
    held, open_ = (sum(s.holds is verdict for s in statements) for verdict in (True, None))
    words = f"{held} of {len(statements)} statements hold"
    return words + (f", {open_} cannot be judged with these inputs" if open_ else "")


def write_statements(statements: Sequence[Statement], folder: Path) -> list[Path]:
    """Write `statements.json` and `statements.md` into `folder`; return their paths."""
    table = [{**asdict(s), "verdict": s.verdict} for s in statements]
    page = "# The paper's statements, and what came out\n\n"
    page += f"Lind & Wangenheim 2014, IMECE2014-37998, Figs 2 to 9. {count(statements)}.\n"
    texts = {
        "statements.json": json.dumps(table, indent=1, ensure_ascii=False) + "\n",
        "statements.md": page + as_markdown(statements, lambda figure: f"\n## {figure}\n"),
    }
    return [write_whole(folder / name, partial(_write, text)) for name, text in texts.items()]


def as_markdown(statements: Sequence[Statement], heading: Callable[[str], str]) -> str:
    """Return a table for each statement of each figure, below the `heading` of the figure."""
    lines = []
    for figure, of_figure in groupby(statements, lambda s: s.figure):
        lines.append(heading(figure))
        in_order = sorted(of_figure, key=lambda s: (s.said, s.criterion))
        for (said, criterion), same in groupby(in_order, lambda s: (s.said, s.criterion)):
            lines += [f"**{said[0].upper()}{said[1:]}.** Holds if: {criterion}.", ""]
            lines += ["| at | number | verdict |", "|---|---|---|"]
            lines += [_row(s) for s in same]
            lines.append("")
    return "\n".join(lines)


def _row(statement: Statement) -> str:
    why = f": {statement.why_not}" if statement.why_not else ""
    cells = (statement.where, statement.number, f"**{statement.verdict}**{why}")
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _write(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8")
