"""Hooks of the site: links out of the docs become names, keys of a case tables, LaTeX MathML.

The pages are read in the source tree, too, where links to its files lead somewhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gripscale.case_file.keys import KeySection

DOCS = Path(__file__).parent.resolve()
KEYS = "<!-- every key of a case -->"
"""What the tables of keys are put in place of."""
EQUATION = re.compile(r"^\$\$\n(.+?)\n\$\$$", re.MULTILINE | re.DOTALL)
"""LaTeX between two lines of two dollars, as other readers of Markdown know it."""
LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(((?:\.\./)+[^)#\s]+)(?:#[^)]*)?\)")


def on_page_markdown(markdown: str, *, page: Any, **_: Any) -> str:
    """Return the page with links that leave the docs as text, its tables and its equations."""
    if page.file.abs_src_path is None:  # a notebook
        return markdown
    folder = Path(page.file.abs_src_path).parent

    def replaced(link: re.Match[str]) -> str:
        target = (folder / link[2]).resolve()
        outside = target.exists() and not target.is_relative_to(DOCS)
        return f"{link[1]} (`{target.relative_to(DOCS.parent)}`)" if outside else link[0]

    told = EQUATION.sub(lambda found: equation(found[1]), LINK.sub(replaced, markdown))
    return told.replace(KEYS, key_tables()) if KEYS in told else told


def equation(latex: str) -> str:
    """Return `latex` as MathML, which browsers draw without a script, on one line of HTML."""
    from latex2mathml.converter import convert

    # What LaTeX has within an equation, the converter knows outside of one.
    given = " ".join(latex.split()).replace("{aligned}", "{align*}")
    math = convert(given, display="block")
    if "\\" in math or "<mi>&</mi>" in math:
        raise ValueError(f"an equation has what cannot be made MathML: {latex}")
    return f'\n<div class="equation" tabindex="0">{math}</div>\n'


def key_tables() -> str:
    """Return a heading and a table for each table of a case, as Markdown."""
    from gripscale.case_file.keys import sections

    return "\n".join(line for section in sections() for line in _section(section))


def _section(section: KeySection) -> Iterator[str]:
    yield f"## {_plain(section.title)}\n\n{_plain(section.about)}\n"
    yield "| key | takes | default | meaning | chapter |\n|---|---|---|---|---|"
    for key in section.keys:
        chapter = f"[{key.chapter.removesuffix('.md')}](../{key.chapter})"
        cells = (f"`{key.name}`", _plain(key.takes), f"`{key.default}`", _plain(key.meaning))
        yield f"| {' | '.join(cells)} | {chapter} |"
    yield ""


def _plain(text: str) -> str:
    """Return `text` without what Markdown would take for markup."""
    return re.sub(r"([\\*_|<>\[\]])", r"\\\1", text)
