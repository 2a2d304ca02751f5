"""The command: the paper's figures, and its statements judged by number."""

from __future__ import annotations

import argparse
import sys
import textwrap
import time
from collections.abc import Sequence
from pathlib import Path

from gripscale.core.errors import ConvergenceError, GripscaleError, InputError
from gripscale.core.units import si_value
from gripscale.experiment import Progress
from gripscale.questions.terminal import surface_keys
from gripscale.questions.vary.axis import axis_value
from reproduction.inputs import OwnInputs
from reproduction.run import FIGURES, chosen, reproduce
from reproduction.statement import Statement, count

WIDTH = 100
BAD_INPUT, NOT_CONVERGED, STOPPED = 2, 3, 130
"""Exit codes, as those of `gripscale`."""
FEWEST_PAIRS = 3
"""Pairs of magnification factors."""


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
        prog="gripscale reproduce",
        description="Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements.",
    )
    add, add_own = parser.add_argument, parser.add_argument_group("own inputs").add_argument
    add("figures", nargs="*", help=f"{' '.join(FIGURES)}; all by default")
    add("--output", type=Path, default=Path("results/reproduction"), help="folder for the results")
    add("--data", type=Path, help="folder of the example data")
    add("--workers", type=int, help="cores to use; all by default")
    add("--cluster", help='"local", or the address of a Dask scheduler: tcp://host:8786')
    two: dict[str, object] = {"nargs": 2, "metavar": ("A", "B"), "default": ()}
    add_own(
        "--surface",
        help="two surfaces: profiles, cases (their surface) or surfaces known by name; all figures "
        "with a single surface show A",
        **two,  # type: ignore[arg-type]
    )
    add_own(
        "--rubber",
        help="two rubbers: files of moduli, cases (their rubber and temperature) or rubbers known "
        "by name; all figures with a single rubber show A",
        **two,  # type: ignore[arg-type]
    )
    add_own(
        "--factors",
        help="magnification factors of wavelength and amplitude, such as 3.5/2.4,3/2.2,6/3; by "
        "default those, with amplitudes fitted to a measured surface",
    )
    add_own(
        "--smallest-wavelength",
        help='of profiles, such as "0.1 mm"; by default where the measurement ends',
    )
    add_own("--x-unit", help="where the file of a profile does not state it")
    add_own("--z-unit", help="where the file of a profile does not state it")
    add_own("--channel", help="channel or column of heights; title or number")
    add_own("--crop", nargs=2, metavar=("FROM", "TO"), help='such as "120 mm" "1780 mm"')
    add_own("--modulus", choices="EG", help="Young or shear, of a file that does not state it")
    add_own("--temperature", help='of rubbers with a shift, such as "20 C"')
    return parser


def _own_inputs(asked: argparse.Namespace) -> OwnInputs:
    pairs = asked.factors.split(",") if asked.factors else ()
    factors = tuple(axis_value("factors", pair) for pair in pairs)
    if 0 < len(factors) < FEWEST_PAIRS:
        raise InputError(
            f"--factors must be {FEWEST_PAIRS} pairs or more, the worst fit of which is compared "
            f"with the others; got {asked.factors}"
        )
    return OwnInputs(
        tuple(asked.surface),
        tuple(asked.rubber),
        factors,
        surface_keys(
            x_unit=asked.x_unit,
            z_unit=asked.z_unit,
            channel=asked.channel,
            crop=asked.crop,
            smallest_wavelength=asked.smallest_wavelength,
        ),
        {"modulus": asked.modulus} if asked.modulus else {},
        si_value("--temperature", asked.temperature, "K"),
    )


def _reproduce(asked: argparse.Namespace) -> None:
    names, own = chosen(asked.figures or ["all"]), _own_inputs(asked)
    print(f"Reproducing {', '.join(names)}", flush=True)
    start = time.perf_counter()
    statements = reproduce(
        names,
        asked.output,
        data=asked.data,
        own=own,
        workers=asked.workers,
        client=asked.cluster,
        on_task=_tell_progress,
    )
    print()
    for statement in statements:
        _tell(statement)
    print(f"\n{count(statements)}; {time.perf_counter() - start:.0f} s")
    print(f"Figures, data and statements.md are in {asked.output}")


def _tell_progress(progress: Progress) -> None:
    how = "already solved" if progress.stored else f"{progress.seconds:.1f} s"
    status = str(progress.result.prediction_status.item())
    words = "" if status == "converged" else f" {status};"
    print(f"[{progress.done}/{progress.total}] {progress.label}:{words} {how}", flush=True)


def _tell(statement: Statement) -> None:
    """Print one statement: verdict, what was said, what came out, why not."""
    head = f"{statement.figure}: {statement.verdict.upper()}: {statement.said}"
    print(textwrap.fill(head, WIDTH, subsequent_indent="    "))
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
