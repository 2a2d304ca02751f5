"""The paper's statements, judged: what was said, what came out, whether that is the same."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
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
    holds: bool
    why_not: str = ""
    """Where it does not hold: different inputs or another model, and what shows it."""

    @property
    def verdict(self) -> str:
        """`holds` or `does not hold`."""
        return "holds" if self.holds else "does not hold"


def write_statements(statements: Sequence[Statement], folder: Path) -> list[Path]:
    """Write `statements.json` and `statements.md` into `folder`; return their paths."""
    table = [{**asdict(s), "verdict": s.verdict} for s in statements]
    texts = {
        "statements.json": json.dumps(table, indent=1, ensure_ascii=False) + "\n",
        "statements.md": as_markdown(statements),
    }
    return [write_whole(folder / name, partial(_write, text)) for name, text in texts.items()]


def as_markdown(statements: Sequence[Statement]) -> str:
    """Return the statements as a table of a Markdown page."""
    held = sum(s.holds for s in statements)
    lines = [
        "# The paper's statements, and what came out",
        "",
        "Lind & Wangenheim 2014, IMECE2014-37998, Figs 2 to 9. Its own data are not published:",
        "a measured coarse road and a synthetic dense asphalt, a filled tread rubber and an",
        f"unfilled SBR stand in for them. {held} of {len(statements)} statements hold.",
        "",
        "| figure | statement | looked for at | holds if | number | verdict |",
        "|---|---|---|---|---|---|",
    ]
    for s in statements:
        verdict = f"**{s.verdict}**" + (f": {s.why_not}" if s.why_not else "")
        cells = (s.figure, s.said, s.where, s.criterion, s.number, verdict)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def _write(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8")
