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

from gripscale.core import GripscaleError, Words
from gripscale.questions import terminal

if TYPE_CHECKING:
    from gripscale.io.table import Table

# Options that state what is missing, by its key in a case.
_EXAMPLES = {
    "shift": ': here with --wlf C1 C2, such as --wlf 8.86 "101.6 K"',
    "columns": ", such as --columns frequency=2,storage=3,loss=4",
    "modulus": ", such as --modulus E",
    "channel": ", such as --channel 2",
}


RubberSheet = Annotated[
    str | None,
    terminal.option("Excel sheet of the rubber, by name or number from 1, if several hold moduli."),
]
RubberFrequency = Annotated[
    str | None,
    terminal.option('Of all rows, such as "10 Hz", if no column holds it: a temperature ramp.'),
]
RubberModulus = Annotated[
    str | None, terminal.option("E (Young) or G (shear), if the file of the rubber does not say.")
]
RubberHeader = Annotated[
    int | None,
    terminal.option("Lines above the rows of the rubber, if there are numbers among them."),
]
ReferenceTemperature = Annotated[
    str | None,
    terminal.option('Such as "20 C": what a master curve holds for, or sweeps are shifted to.'),
]
WlfConstants = Annotated[
    tuple[float, str] | None,
    terminal.option('Constants c1 and c2 of a shift, such as 8.86 "101.6 K".', metavar="C1 C2"),
]


def shift_of_wlf(constants: tuple[float, str]) -> dict[str, Any]:
    """Return the constants of a WLF shift, as typed, as a key of the case."""
    return {"kind": "wlf", "c1": constants[0], "c2": constants[1]}


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
    temperature: Annotated[
        str | None, terminal.option('Of the rubber before the contact, such as "20 C".')
    ] = None,
    pressure: Annotated[str | None, terminal.option('Such as "3 bar", as by default.')] = None,
    speed: Annotated[str | None, terminal.option('Such as "1 m/s", as by default.')] = None,
    footprint: Annotated[
        str | None, terminal.option('Length of the nominal contact; "100 mm" by default.')
    ] = None,
    thickness: Annotated[
        str | None, terminal.option('Of the rubber, such as "8 mm"; it has no end by default.')
    ] = None,
    filled: Annotated[
        bool | None,
        typer.Option(
            "--filled/--unfilled",
            help="Whether the rubber has carbon black or silica, as every tread; asked for in a "
            "terminal, and without it the answer has both numbers.",
        ),
    ] = None,
    interface: Annotated[
        str | None, terminal.option('"dry": a dry road, which also shears the contact area.')
    ] = None,
    step: Annotated[
        str | None,
        terminal.option(
            'Distance between points where a file has none: "0.1 mm", of a map "1 um, 2 um".'
        ),
    ] = None,
    x_unit: terminal.SurfaceUnit = None,
    z_unit: terminal.SurfaceUnit = None,
    z_axis: terminal.SurfaceAxis = None,
    channel: terminal.SurfaceChannel = None,
    crop: terminal.SurfaceCrop = None,
    longest_wavelength: terminal.LongestWavelength = None,
    wlf: WlfConstants = None,
    columns: Annotated[str | None, terminal.option(terminal.COLUMNS)] = None,
    sheet: RubberSheet = None,
    header: RubberHeader = None,
    reference_temperature: ReferenceTemperature = None,
    frequency: RubberFrequency = None,
    frequency_unit: Annotated[
        str | None, terminal.option("Such as rad/s, if the file of the rubber does not state it.")
    ] = None,
    modulus: RubberModulus = None,
    temperature_unit: Annotated[
        str | None, terminal.option("K, C or F, if the file of the rubber does not state it.")
    ] = None,
    modulus_unit: Annotated[
        str | None,
        terminal.option("Such as MPa, if that file does not state it, or states a wrong one."),
    ] = None,
) -> None:
    """Write a commented case for measured files, and list what is doubtful about it."""
    from gripscale.case_file.laboratory import first_choice
    from gripscale.case_file.look import kinds_table
    from gripscale.case_file.new import new_case

    layout = {
        "columns": None if columns is None else terminal.columns_of(columns),
        "sheet": None if sheet is None else terminal.column_of(sheet),
        "header": header,
        "reference_temperature": reference_temperature,
        "frequency": frequency,
        "frequency_unit": frequency_unit,
        "modulus": modulus,
        "temperature_unit": temperature_unit,
        "modulus_unit": modulus_unit,
    }
    surface = terminal.surface_keys(
        channel=channel,
        crop=crop,
        x_unit=x_unit,
        z_unit=z_unit,
        z_axis=z_axis,
        longest_wavelength=longest_wavelength,
    )
    console = terminal.screen()
    terminal.show_step(console, terminal.READING)
    with naming_options():
        case = new_case(
            files,
            output,
            load={"pressure": pressure, "speed": speed, "footprint": footprint},
            temperature=temperature,
            step=None if step is None else terminal.lengths_of(step),
            shift=None if wlf is None else shift_of_wlf(wlf),
            layout={key: value for key, value in layout.items() if value is not None},
            thickness=thickness,
            filled=filled,
            interface=interface,
            surface=surface,
            kinds=kinds_of(kinds),
            ask=_ask if in_terminal() else first_choice,
        )
    terminal.end_steps()
    lines: list[str | Table] = [kinds_table(case.files), f"Case: {case.path}"]
    if case.findings:
        doubts = (f"  {at}. {finding}" for at, finding in enumerate(case.findings, start=1))
        lines += ["", "Doubts, the most important first:", *doubts]
    lines += ["", "Next:", f"  {shlex.join(['gripscale', 'run', str(case.path)])}"]
    terminal.print_parts(console, lines)


@terminal.command
def look_at(
    files: Annotated[list[Path], terminal.argument("Measured files, or folders.", "FILE...")],
    kinds: Kinds = None,
    step: Annotated[
        str | None, terminal.option('Distance between points where a file has none: "0.1 mm".')
    ] = None,
    x_unit: terminal.SurfaceUnit = None,
    z_unit: terminal.SurfaceUnit = None,
    channel: terminal.SurfaceChannel = None,
    columns: Annotated[str | None, terminal.option(terminal.COLUMNS)] = None,
) -> None:
    """Show how files are read: what each is taken for, its columns, first rows and a picture."""
    from gripscale.case_file.kinds import FileKeys
    from gripscale.case_file.laboratory import all_taken
    from gripscale.case_file.look import parts_of
    from gripscale.io.text_table import files_read_once

    keys = terminal.surface_keys(x_unit=x_unit, z_unit=z_unit, channel=channel, crop=None)
    layout = {} if columns is None else {"columns": terminal.columns_of(columns)}
    reading = FileKeys(None if step is None else terminal.lengths_of(step), keys, layout)
    with files_read_once():
        for file in all_taken(files, reading, kinds_of(kinds)):
            terminal.print_parts(terminal.screen(), [*parts_of(file, reading), ""])
