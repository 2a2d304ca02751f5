"""`make bench`: time and memory, subject by subject, with accuracy beside them.

python -m benchmarks [SUBJECT ...] [--figures FOLDER]
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable
from pathlib import Path

from rich.console import Console

from benchmarks import (
    case,
    cluster,
    conditions,
    gap_flow,
    large_maps,
    machine,
    questions,
    random_loads,
    rival,
    rough_contact,
    scaling,
    sizes,
    sparse_factor,
    sweep,
    transient,
    waves,
)
from gripscale.core.errors import RubberWarning

WIDTH = 150
SUBJECTS: dict[str, Callable[[Console, Path], None]] = {
    "waves": lambda console, _: waves.run(console),
    "random_loads": lambda console, _: random_loads.run(console),
    "case": lambda console, _: case.run(console),
    "questions": lambda console, _: questions.run(console),
    "transient": lambda console, _: transient.run(console),
    "sweep": lambda console, _: sweep.run(console),
    "rough_contact": lambda console, _: rough_contact.run(console),
    "gap_flow": lambda console, _: gap_flow.run(console),
    "conditions": lambda console, _: conditions.run(console),
    "rival": lambda console, _: rival.run(console),
    "scaling": lambda console, figures: scaling.run(console, figures / "cost.png"),
    "cluster": lambda console, _: cluster.run(console),
    "sizes": lambda console, _: sizes.run(console),
    "large_maps": lambda console, _: large_maps.run(console),
    "sparse_factor": lambda console, _: sparse_factor.run(console),
}
ON_REQUEST = {"large_maps", "sizes", "sparse_factor"}
"""Minutes, gigabytes or a compiler: only if asked for."""


def main() -> None:
    """Run the chosen subjects, by default all but those on request."""
    parser = argparse.ArgumentParser(description="Time and memory, subject by subject.")
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=", ".join(SUBJECTS))
    parser.add_argument(
        "--figures", type=Path, default=Path("results/bench"), help="folder for the figures"
    )
    arguments = parser.parse_args()
    unknown = sorted(set(arguments.subjects) - set(SUBJECTS))
    if unknown:
        parser.error(f"unknown subject {unknown[0]!r}; expected one of {', '.join(SUBJECTS)}")
    warnings.simplefilter("ignore", RubberWarning)  # fits of the shipped tread say the same
    console = Console(width=WIDTH, highlight=False)
    console.print(f"{machine.describe()}\n")
    start = time.perf_counter()
    for subject in arguments.subjects or [name for name in SUBJECTS if name not in ON_REQUEST]:
        mark = time.perf_counter()
        SUBJECTS[subject](console, arguments.figures)
        console.print(f"{subject}: {time.perf_counter() - mark:.0f} s\n", style="dim")
    console.print(f"All in {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
