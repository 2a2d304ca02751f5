"""The command: numbers and figure of docs/strain-rule.md.

    python -m studies.strain_rule --output results/strain_rule

About 20 minutes of one core; rows are written as they are solved, and rows that are there are kept.
"""

from __future__ import annotations

import argparse
import csv
from collections.abc import Callable
from functools import partial
from pathlib import Path

from studies.shipped import tread
from studies.strain_rule import sliding, static
from studies.strain_rule.draw import draw
from studies.strain_rule.lines import FAMILIES
from studies.strain_rule.static import SWEEPS
from studies.strain_rule.tables import Row, by_family, rows_of, sliding_error, static_error, table

Solve = Callable[[str, int, str], list[dict[str, float | str]]]
NUMBERS = (0, 3, 5, 1, 2)
"""Lines of each family; the first three slide, too, each with one sweep in turn."""


def fill(path: Path, cases: list[tuple[str, int, str]], solve: Solve) -> None:
    """Append the rows of all cases that the file has not."""
    solved = set()
    if path.exists():
        with path.open() as file:
            solved = {(r["family"], int(r["line"]), r["sweep"]) for r in csv.DictReader(file)}
    for case in cases:
        if case in solved:
            continue
        rows = solve(*case)
        new = not path.exists()
        with path.open("a", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]))
            if new:
                writer.writeheader()
            writer.writerows(rows)


def main() -> None:
    """Compute, print the tables and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("results/strain_rule"))
    parser.add_argument("--figure", type=Path, help="file; in the output folder by default")
    asked = parser.parse_args()
    asked.output.mkdir(parents=True, exist_ok=True)
    at_rest, slides = (asked.output / name for name in ("static.csv", "sliding.csv"))
    lines = [(family, number) for number in NUMBERS for family in FAMILIES]
    fill(at_rest, [(*line, name) for line in lines for name in SWEEPS], static.solve)
    in_turn = [
        (family, number, SWEEPS[(place + turn) % len(SWEEPS)])
        for turn, number in enumerate(NUMBERS[:3])
        for place, family in enumerate(FAMILIES)
    ]
    fill(slides, in_turn, partial(sliding.solve, rubber=tread()))
    rest, moving = rows_of(at_rest), rows_of(slides)
    errors: dict[str, tuple[list[Row], Callable[[Row], float]]] = {
        "area at rest": (rest, static_error),
        "area at rest, 0.4 of the slope": (rest, partial(static_error, rule="slope 0.4")),
        "area at rest, half the slope": (rest, partial(static_error, rule="slope 0.5")),
        "area in sliding": (moving, partial(sliding_error, what="area")),
        "friction": (moving, partial(sliding_error, what="friction")),
        "area, nothing heals": (moving, partial(sliding_error, what="area", judge="passing")),
        "friction, nothing heals": (
            moving,
            partial(sliding_error, what="friction", judge="passing"),
        ),
    }
    for title, (rows, error) in errors.items():
        print(title, *table(by_family(rows, error)), sep="\n", end="\n\n")
    draw(rest, moving, asked.figure or asked.output / "strain_rule.png")


if __name__ == "__main__":
    main()
