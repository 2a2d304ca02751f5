"""The command: the paper's figures, and its statements judged by number."""

from __future__ import annotations

import argparse
import sys
import textwrap
import time
from collections.abc import Sequence
from pathlib import Path

from gripscale.core.errors import ConvergenceError, GripscaleError
from gripscale.experiment import Progress
from reproduction.run import FIGURES, chosen, reproduce
from reproduction.statement import Statement

WIDTH = 100
BAD_INPUT, NOT_CONVERGED, STOPPED = 2, 3, 130
"""Exit codes, as those of `gripscale`."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command with `arguments`, by default those of the process; return its exit code."""
    asked = _parser().parse_args(arguments)
    try:
        _reproduce(asked)
    except GripscaleError as error:
        print(f"error: {error}", file=sys.stderr)
        return NOT_CONVERGED if isinstance(error, ConvergenceError) else BAD_INPUT
    except KeyboardInterrupt:
        print("error: stopped; finished predictions are kept in the folder", file=sys.stderr)
        return STOPPED
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="reproduction",
        description="Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements.",
    )
    parser.add_argument("figures", nargs="*", help=f"{' '.join(FIGURES)}; all by default")
    parser.add_argument(
        "--output", type=Path, default=Path("results/reproduction"), help="folder for the results"
    )
    parser.add_argument("--data", type=Path, help="folder of the example data")
    parser.add_argument("--workers", type=int, help="cores to use; all by default")
    parser.add_argument(
        "--cluster", help='"local", or the address of a Dask scheduler: tcp://host:8786'
    )
    return parser


def _reproduce(asked: argparse.Namespace) -> None:
    names = chosen(asked.figures or ["all"])
    print(f"Reproducing {', '.join(names)}", flush=True)
    start = time.perf_counter()
    statements = reproduce(
        names,
        asked.output,
        data=asked.data,
        workers=asked.workers,
        client=asked.cluster,
        on_task=_tell_progress,
    )
    print()
    for statement in statements:
        _tell(statement)
    held = sum(statement.holds for statement in statements)
    seconds = time.perf_counter() - start
    print(f"\n{held} of {len(statements)} statements hold; {seconds:.0f} s")
    print(f"Figures, data and statements.md are in {asked.output}")


def _tell_progress(progress: Progress) -> None:
    how = "already solved" if progress.stored else f"{progress.seconds:.1f} s"
    status = str(progress.result.prediction_status.item())
    words = "" if status == "converged" else f" {status};"
    print(f"[{progress.done}/{progress.total}] {progress.label}:{words} {how}", flush=True)


def _tell(statement: Statement) -> None:
    """Print one statement: verdict, what was said, what came out, why not."""
    print(f"{statement.figure}: {statement.verdict.upper()}: {statement.said}")
    for label, text in (
        ("at", statement.where),
        ("number", statement.number),
        ("why", statement.why_not),
    ):
        if text:
            indent = " " * 12
            lines = textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=indent)
            print("\n".join([f"    {label:>6}: {lines[0].lstrip()}", *lines[1:]]))


if __name__ == "__main__":
    sys.exit(main())
