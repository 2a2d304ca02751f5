"""`make bench`: accuracy beside time, subject by subject.

python benchmarks/bench.py [SUBJECT ...] [--figures FOLDER]
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import case
import convergence
import elastic
import elements
import machine
import robustness
import scaling
import sliding
import sweep
import transient
from rich.console import Console

WIDTH = 150
SUBJECTS = [
    "elastic",
    "sliding",
    "elements",
    "convergence",
    "case",
    "transient",
    "robustness",
    "sweep",
    "scaling",
]


def main() -> None:
    """Run the chosen subjects, all by default."""
    parser = argparse.ArgumentParser(description="Accuracy beside time, subject by subject.")
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=", ".join(SUBJECTS))
    parser.add_argument(
        "--figures", type=Path, default=Path("results/bench"), help="folder for the figures"
    )
    arguments = parser.parse_args()
    unknown = sorted(set(arguments.subjects) - set(SUBJECTS))
    if unknown:
        parser.error(f"unknown subject {unknown[0]!r}; expected one of {', '.join(SUBJECTS)}")
    console = Console(width=WIDTH, highlight=False)
    console.print(f"{machine.describe()}\n")
    figures = arguments.figures
    runs = {
        "elastic": elastic.run,
        "sliding": sliding.run,
        "elements": elements.run,
        "convergence": lambda screen: convergence.run(screen, figures / "convergence.png"),
        "case": case.run,
        "transient": lambda screen: transient.run(screen, figures / "transient.png"),
        "robustness": robustness.run,
        "sweep": sweep.run,
        "scaling": lambda screen: scaling.run(screen, figures / "cost.png"),
    }
    start = time.perf_counter()
    for subject in arguments.subjects or SUBJECTS:
        mark = time.perf_counter()
        runs[subject](console)
        console.print(f"{subject}: {time.perf_counter() - mark:.0f} s\n", style="dim")
    console.print(f"All in {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
