"""`python -m studies.paper_page`: the figures and statements of docs/paper.md, made anew.

What stands above the marks in the page is written by hand and kept.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path

import PIL.Image

from gripscale.core.errors import FileError
from gripscale.reproduction.figures import TITLES, title_of
from gripscale.reproduction.inputs import PaperInputs, read_inputs
from gripscale.reproduction.run import reproduce_paper
from gripscale.reproduction.statement import Statement, as_markdown, number_holding, verdict_table

MADE = "<!-- made by python -m studies.paper_page -->"
SHOWN, SHADES = 0.6, 96
"""Size of a figure on the page, of that for print, and its number of colours."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Make all figures, and write them and the statements into the docs."""
    parser = argparse.ArgumentParser(description="Figures and statements of docs/paper.md.")
    parser.add_argument("--docs", type=Path, default=Path("docs"))
    parser.add_argument("--output", type=Path, default=Path("results/reproduction"))
    parser.add_argument("--workers", type=int)
    asked = parser.parse_args(arguments)
    inputs = read_inputs()
    statements = reproduce_paper(inputs, asked.output, workers=asked.workers)
    for name in TITLES:
        _pack(asked.output / f"{name}.png", asked.docs / "figures" / f"paper_{name}.png")
    write_page(asked.docs / "paper.md", statements, inputs)


def write_page(path: Path, statements: Sequence[Statement], inputs: PaperInputs) -> None:
    """Replace all below the mark of a page; `FileError` if it has none."""
    page = path.read_text(encoding="utf-8")
    if MADE not in page:
        raise FileError(f'{path} must have a line "{MADE}", below which it is written')
    text = "\n".join([MADE, "", *_summary(statements), *_figures(statements, inputs)])
    path.write_text(f"{page[: page.index(MADE)]}{text.rstrip()}\n", encoding="utf-8")


def _summary(statements: Sequence[Statement]) -> Iterator[str]:
    yield f"{number_holding(statements)}:\n"
    table = verdict_table(statements)
    yield f"| {' | '.join(column.name for column in table.columns)} |\n|---|---|---|---|---|"
    for figure, said, *counts in zip(*(column.values for column in table.columns), strict=True):
        yield f"| Figure {figure} | {said} | {' | '.join(str(n or '') for n in counts)} |"
    yield ""


def _figures(statements: Sequence[Statement], inputs: PaperInputs) -> Iterator[str]:
    for name in TITLES:
        title = title_of(name, inputs)
        yield f"### Figure {name.removeprefix('fig')}: {title}\n"
        yield f"![{title}](figures/paper_{name}.png)\n"
        yield as_markdown([s for s in statements if s.figure == name], lambda _: "").strip()
        yield ""


def _pack(source: Path, target: Path) -> None:
    """Save a figure smaller and with fewer colours, a fifth of the bytes."""
    picture = PIL.Image.open(source).convert("RGB")
    small = picture.resize(
        [round(SHOWN * side) for side in picture.size], PIL.Image.Resampling.LANCZOS
    )
    small.quantize(SHADES, PIL.Image.Quantize.MAXCOVERAGE).save(target, "PNG", optimize=True)


if __name__ == "__main__":
    main()
