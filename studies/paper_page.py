"""`python -m studies.paper_page`: the figures and statements of docs/paper.md, made anew.

What stands above the marks in the page is written by hand and kept.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path

import PIL.Image

from gripscale.core.errors import FileError
from reproduction.figures import TITLES
from reproduction.inputs import ROAD, TREAD
from reproduction.run import FIGURES, reproduce
from reproduction.statement import Statement, as_markdown, count

MADE = "<!-- made by python -m studies.paper_page -->"
SHOWN, SHADES = 0.6, 64
"""Size of a figure on the page, of that for print, and its number of colours."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Make all figures, and write them and the statements into the docs."""
    parser = argparse.ArgumentParser(description="Figures and statements of docs/paper.md.")
    parser.add_argument("--docs", type=Path, default=Path("docs"))
    parser.add_argument("--output", type=Path, default=Path("results/reproduction"))
    parser.add_argument("--workers", type=int)
    asked = parser.parse_args(arguments)
    statements = reproduce(output=asked.output, workers=asked.workers)
    for name in FIGURES:
        _pack(asked.output / f"{name}.png", asked.docs / "figures" / f"paper_{name}.png")
    write_page(asked.docs / "paper.md", statements)


def write_page(path: Path, statements: Sequence[Statement]) -> None:
    """Replace all below the mark of a page; `FileError` if it has none."""
    page = path.read_text(encoding="utf-8")
    if MADE not in page:
        raise FileError(f'{path} must have a line "{MADE}", below which it is written')
    text = "\n".join([MADE, "", *_summary(statements), *_figures(statements)])
    path.write_text(f"{page[: page.index(MADE)]}{text.rstrip()}\n", encoding="utf-8")


def _summary(statements: Sequence[Statement]) -> Iterator[str]:
    yield f"{count(statements)}:\n"
    yield "| figure | statement | holds | does not hold | not judged |\n|---|---|---|---|---|"
    for (figure, said), same in groupby(
        sorted(statements, key=lambda s: (FIGURES.index(s.figure), s.said)),
        lambda s: (s.figure, s.said),
    ):
        verdicts = [s.holds for s in same]
        counts = (str(verdicts.count(verdict) or "") for verdict in (True, False, None))
        yield f"| {_called(figure)} | {said} | {' | '.join(counts)} |"
    yield ""


def _figures(statements: Sequence[Statement]) -> Iterator[str]:
    for name in FIGURES:
        title = TITLES[name].format(rubber=TREAD, surface=ROAD)
        yield f"### {_called(name)}: {title}\n"
        yield f"![{title}](figures/paper_{name}.png)\n"
        yield as_markdown([s for s in statements if s.figure == name], lambda _: "").strip()
        yield ""


def _called(figure: str) -> str:
    """Return what a figure is called in the paper."""
    return f"Figure {figure.removeprefix('fig')}"


def _pack(source: Path, target: Path) -> None:
    """Save a figure smaller and with fewer colours, a fifth of the bytes."""
    picture = PIL.Image.open(source).convert("RGB")
    small = picture.resize(
        [round(SHOWN * side) for side in picture.size], PIL.Image.Resampling.LANCZOS
    )
    small.quantize(SHADES).save(target, "PNG", optimize=True)


if __name__ == "__main__":
    main()
