"""`gripscale docs [PAGE]`: the documentation, which comes with the package."""

from __future__ import annotations

import re
import sys
import unicodedata
from contextlib import nullcontext
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Annotated

from gripscale.questions.terminal import argument, command, print_parts, print_wrapped, screen

_COMMENT = re.compile(r"<!--.*?-->\s*", flags=re.DOTALL)
CODE = re.compile(r"^(`{3,}|~{3,}).*?^\1", flags=re.MULTILINE | re.DOTALL)
_PICTURE = re.compile(r"^!\[([^\]]*)\]\([^)]*\)\s*$", flags=re.MULTILINE)


def pages() -> dict[str, Traversable]:
    """Return the pages by name, in the order of the names."""
    home = files("gripscale").joinpath("pages")
    names = sorted(path.name for path in home.iterdir() if path.name.endswith(".md"))
    return {name.removesuffix(".md"): home.joinpath(name) for name in names}


@command
def docs(
    page: Annotated[
        str | None, argument("A page, such as reading-results; without one their titles.", "PAGE")
    ] = None,
) -> None:
    """Show a page of the documentation in the terminal, or list all pages."""
    from rich.markdown import Markdown

    from gripscale.core import checks

    console, texts = screen(), pages()
    if page is None:
        for name, path in texts.items():
            heading = path.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")
            print_wrapped(console, f"{name:26}{heading}")
        print_parts(console, ["", "`gripscale docs PAGE` shows one of them."])
        return
    name, _, heading = page.partition("#")
    name = name.removesuffix(".md")
    checks.allowed_names("page", [name], list(texts))
    text = _COMMENT.sub("", texts[name].read_text(encoding="utf-8"))
    text = _PICTURE.sub(r"*Figure: \1.*", text)
    if heading:
        text = text[anchors(text).get(anchor_of(heading), 0) :]
    with console.pager(styles=True) if sys.stdout.isatty() else nullcontext():
        console.print(Markdown(text))


def anchors(text: str) -> dict[str, int]:
    """Return where each heading of a page begins, by its anchor on the site of the pages."""
    starts: dict[str, int] = {}
    code = [match.span() for match in CODE.finditer(text)]
    for match in re.finditer(r"^#+ (.*)$", text, flags=re.MULTILINE):
        if any(first <= match.start() < last for first, last in code):
            continue
        name, number = anchor_of(match[1]), 0
        while (anchor := f"{name}_{number}" if number else name) in starts:
            number += 1
        starts[anchor] = match.start()
    return starts


def anchor_of(heading: str) -> str:
    """Return how a link names a heading, without accents, as Python-Markdown does."""
    plain = unicodedata.normalize("NFKD", heading).encode("ascii", "ignore").decode("ascii")
    return re.sub(r"[\s-]+", "-", re.sub(r"[^\w\s-]", "", plain).strip().lower())
