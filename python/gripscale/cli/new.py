"""`gripscale new`: a case from one's own files, with what is doubtful about it."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperCommand

from gripscale.cli.keys import takes_keys
from gripscale.core import GripscaleError, Words
from gripscale.questions import terminal

if TYPE_CHECKING:
    from gripscale.io.table import Table

SURFACE_KEYS = ("channel", "crop", "x_unit", "z_unit", "z_axis", "longest_wavelength")
LOAD_KEYS = ("pressure", "speed", "footprint")
CASE_KEYS = ("temperature", "step", "thickness", "interface")
# Options that state what is missing, by its key in a case.
_EXAMPLES = {
    "shift": ': here with --wlf C1 C2, such as --wlf 8.86 "101.6 K"',
    "columns": ", such as --columns frequency=2,storage=3,loss=4",
    "modulus": ", such as --modulus E",
    "channel": ", such as --channel 2",
}


@contextmanager
def naming_options() -> Iterator[None]:
    """Let an error about something missing from a file end with the option that states it."""
    try:
        yield
    except GripscaleError as error:
        if error.missing in _EXAMPLES:
            error.words = Words(error.words, _EXAMPLES[error.missing])
        raise


Kinds = Annotated[
    list[str] | None,
    terminal.option(
        "What a file is, where it is taken for something else: profile, map, sweeps, master-curve, "
        "ramp, prony, strain-sweep, shift, friction or unused; may be repeated.",
        "--as",
        metavar="KIND FILE",
    ),
]


def kinds_of(pairs: list[str] | None) -> dict[str | Path, str]:
    """Return the kind of each file of options --as."""
    return {file: kind for kind, _, file in (pair.partition("=") for pair in pairs or ())}


class KindCommand(TyperCommand):
    """A command whose option --as takes a kind and a file."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Join the words behind --as, of which the parser takes one."""
        words = iter(args)
        joined: list[str] = []
        for word in words:
            joined.append(word)
            if word == "--as":
                kind = next(words, "")
                joined.append(kind if "=" in kind else f"{kind}={next(words, '')}")
        return super().parse_args(ctx, joined)


def in_terminal() -> bool:
    """Return whether somebody can be asked."""
    return sys.stdin.isatty() and sys.stdout.isatty()


def _ask(question: str, answers: Sequence[str]) -> str:
    """Ask a question of which the first answer is the likeliest, until one is chosen."""
    listed = "\n".join(f"  {at}. {answer}" for at, answer in enumerate(answers, start=1))
    terminal.end_steps()
    words = {str(at): answer for at, answer in enumerate(answers, start=1)}
    words |= {answer.lower(): answer for answer in answers}
    while True:
        reply = str(typer.prompt(f"{question}\n{listed}\n", default="1")).strip().lower()
        if reply in words:
            return words[reply]


@terminal.command
@takes_keys(
    *(*LOAD_KEYS, *CASE_KEYS, *SURFACE_KEYS),
    *("wlf", "columns", "sheet", "header", "reference_temperature", "frequency"),
    *("frequency_unit", "modulus", "temperature_unit", "modulus_unit"),
)
def new(
    files: Annotated[
        list[Path],
        terminal.argument(
            "Measured profiles or a map, and a master curve or sweeps or a rubber known by name "
            "(styrene_butadiene), in any order; or folders, with shift factors, strain sweeps and "
            "measured friction.",
            "FILE...",
        ),
    ],
    kinds: Kinds = None,
    output: Annotated[
        Path, terminal.option("The case file to write.", "--output", "-o", metavar="CASE.toml")
    ] = Path("case.toml"),
    filled: Annotated[
        bool | None,
        typer.Option(
            "--filled/--unfilled",
            help="Whether the rubber has carbon black or silica, as every tread; asked for in a "
            "terminal, and without it the answer has both numbers.",
        ),
    ] = None,
    *,
    keys: dict[str, Any],
) -> None:
    """Write a commented case for measured files, and list what is doubtful about it."""
    from gripscale.case_file.laboratory import first_choice
    from gripscale.case_file.look import kinds_table
    from gripscale.case_file.new import new_case

    surface, load, of_case = (
        {key: keys.pop(key) for key in names if key in keys}
        for names in (SURFACE_KEYS, LOAD_KEYS, CASE_KEYS)
    )
    shift = keys.pop("wlf", None)
    console = terminal.screen()
    terminal.show_step(console, terminal.READING)
    with naming_options():
        case = new_case(
            files,
            output,
            load=load,
            shift=shift,
            layout=keys,
            filled=filled,
            surface=surface,
            kinds=kinds_of(kinds),
            ask=_ask if in_terminal() else first_choice,
            **of_case,
        )
    terminal.end_steps()
    lines: list[str | Table] = [kinds_table(case.files), f"Case: {case.path}"]
    if case.findings:
        doubts = (f"  {at}. {finding}" for at, finding in enumerate(case.findings, start=1))
        lines += ["", "Doubts, the most important first:", *doubts]
    lines += ["", "Next:", f"  {shlex.join(['gripscale', 'run', str(case.path)])}"]
    terminal.print_parts(console, lines)


@terminal.command
@takes_keys("step", "x_unit", "z_unit", "channel", "columns")
def look_at(
    files: Annotated[list[Path], terminal.argument("Measured files, or folders.", "FILE...")],
    kinds: Kinds = None,
    *,
    keys: dict[str, Any],
) -> None:
    """Show how files are read: what each is taken for, its columns, first rows and a picture."""
    from gripscale.case_file.kinds import FileKeys
    from gripscale.case_file.laboratory import all_taken
    from gripscale.case_file.look import parts_of
    from gripscale.io.text_table import files_read_once

    layout = {"columns": keys.pop("columns")} if "columns" in keys else {}
    reading = FileKeys(keys.pop("step", None), keys, layout)
    with files_read_once():
        for file in all_taken(files, reading, kinds_of(kinds)):
            terminal.print_parts(terminal.screen(), [*parts_of(file, reading), ""])
