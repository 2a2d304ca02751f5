"""`make bench`: accuracy beside time, subject by subject.

python benchmarks/bench.py [elastic sliding elements convergence case] [--figure PNG]
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
import sliding
from rich.console import Console

WIDTH = 150
SUBJECTS = ["elastic", "sliding", "elements", "convergence", "case"]


def main() -> None:
    """Run the chosen subjects, all by default."""
    parser = argparse.ArgumentParser(description="Accuracy beside time, subject by subject.")
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=", ".join(SUBJECTS))
    parser.add_argument(
        "--figure",
        type=Path,
        default=Path("results/bench/convergence.png"),
        help="where the convergence figure goes",
    )
    arguments = parser.parse_args()
    unknown = sorted(set(arguments.subjects) - set(SUBJECTS))
    if unknown:
        parser.error(f"unknown subject {unknown[0]!r}; expected one of {', '.join(SUBJECTS)}")
    console = Console(width=WIDTH, highlight=False)
    console.print(f"{machine.describe()}\n")
    start = time.perf_counter()
    runs = {
        "elastic": elastic.run,
        "sliding": sliding.run,
        "elements": elements.run,
        "convergence": lambda screen: convergence.run(screen, arguments.figure),
        "case": case.run,
    }
    for subject in arguments.subjects or SUBJECTS:
        runs[subject](console)
    console.print(f"All in {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
