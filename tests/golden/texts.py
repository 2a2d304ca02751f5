"""What commands print and pages show, as text that people compare while code is moved.

Masked is what changes from run to run: folders, times, sizes of files, versions, digests.
"""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

from gripscale.core.provenance import versions

from .experiments import Experiments

MASKS = (
    (r"[^\S\n]+$", ""),
    (r", \d+\.\d s(; about \d+ (s|min) left)?$", ", T s"),
    (r"\d+\.\d MB", "S MB"),
    (r"\b[0-9a-f]{16,64}\b", "DIGEST"),
    (r"\b\d{4}-\d\d-\d\d[T ]\d\d:\d\d[:\d]*(\S*)", "DATE"),
)
"""What is masked in each line, and by what."""

BLOCKS = {
    "address", "article", "aside", "blockquote", "br", "caption", "dd", "details", "div", "dl",
    "dt", "figcaption", "figure", "footer", "h1", "h2", "h3", "h4", "h5", "h6", "header", "li",
    "main", "nav", "ol", "p", "pre", "section", "summary", "table", "tr", "ul",
}  # fmt: skip
"""Tags that begin a line."""

SILENT = {"script", "style", "svg", "math", "head"}
"""Tags whose content is no text: scripts, and drawn formulas."""

KEPT = (
    *("run", "compare", "study", "uncertainty", "sensitivity", "fit_rubber", "keys"),
    "page_run",
)
"""What people compare: what these commands print, and one page."""

HEADINGS = {"h1": "#", "h2": "##", "h3": "###", "h4": "####"}


def texts(made: Experiments) -> dict[str, str]:
    """Return all texts by name: what was printed, and the pages, "page_" and their folder."""
    pages = sorted(made.folder.glob("*/report.html"))
    shown = {f"page_{path.parent.name}": page_text(path) for path in pages}
    return {name: masked(text, made.folder) for name, text in (made.printed | shown).items()}


def write_texts(made: Experiments, folder: Path) -> None:
    """Write the texts of `KEPT` anew into `folder`, one file each."""
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.txt"):
        old.unlink()
    now = texts(made)
    for name in KEPT:
        (folder / f"{name}.txt").write_text(now[name], encoding="utf-8")


def kept_texts(folder: Path) -> dict[str, str]:
    """Return the texts in `folder` by name."""
    return {path.stem: path.read_text(encoding="utf-8") for path in folder.glob("*.txt")}


def page_text(path: Path) -> str:
    """Return what a reader sees of a page, one line for each paragraph or row of a table."""
    reader = _Reader()
    reader.feed(path.read_text(encoding="utf-8"))
    lines = (" ".join(line.split()) for line in "".join(reader.parts).split("\n"))
    return "\n".join(line for line in lines if line) + "\n"


def masked(text: str, folder: Path) -> str:
    """Return `text` without what belongs to one run."""
    text = text.replace(str(folder), "FOLDER")
    for name, version in versions().items():
        text = re.sub(rf"\b{name}( \W*){re.escape(version)}", rf"{name}\1VERSION", text, flags=re.I)
    for pattern, mask in MASKS:
        text = re.sub(pattern, mask, text, flags=re.M)
    return text


class _Reader(HTMLParser):
    """The shown text of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.parts: list[str] = []
        self._silent: list[str] = []
        self._in_code = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag in SILENT:
            self._silent.append(tag)
        if tag in BLOCKS:
            self.parts.append("\n")
        if tag in HEADINGS:
            self.parts.append(f"{HEADINGS[tag]} ")
        self._in_code += tag == "pre"
        if tag in {"td", "th"}:
            self.parts.append(" | ")
        if tag == "img" and not self._silent:
            self.parts.append(f"[image: {dict(attrs).get('alt') or ''}]")

    def handle_endtag(self, tag: str) -> None:
        if self._silent and self._silent[-1] == tag:
            self._silent.pop()
        if tag in BLOCKS:
            self.parts.append("\n")
        self._in_code -= tag == "pre"

    def handle_data(self, data: str) -> None:
        if not self._silent:
            self.parts.append(data if self._in_code else data.replace("\n", " "))
