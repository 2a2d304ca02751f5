"""What the commands share: what they print and where, and how an error becomes a sentence."""

from __future__ import annotations

import inspect
import os
import sys
import time
from collections.abc import Callable, Container, Iterable, Sequence
from contextvars import ContextVar
from functools import cached_property, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, ParamSpec

import typer

from gripscale.core import ConvergenceError, GripscaleError, Words

if TYPE_CHECKING:
    from rich.console import Console
    from rich.status import Status

    from gripscale.case import Case
    from gripscale.experiment.solve import Progress
    from gripscale.io.table import Table
    from gripscale.questions.result import Result


# Exit codes: an input that cannot be used, a wave without solution, stopped from outside.
BAD_INPUT, _NOT_CONVERGED, STOPPED = 2, 3, 130
READING = "reading and fitting the measurements ..."
ON_PAGE = "report.html"  # where all findings of a command stand
PLAIN_WIDTH = 100  # characters per line where there is no terminal to ask
P = ParamSpec("P")


class Manner(NamedTuple):
    """How a command on a case prints, and whether it replaces results of another case."""

    quiet: bool = False
    json: bool = False
    replace: bool = False


_USUAL = Manner()
MANNER: ContextVar[Manner] = ContextVar("manner", default=_USUAL)  # manner of the running command


def screen(stderr: bool = False) -> Console:
    """Return a console for a terminal, or for a plain file or pipe of sensible width."""
    from rich.console import Console

    manner = MANNER.get()
    stream = sys.stderr if stderr else sys.stdout
    wide = None if stream.isatty() or "COLUMNS" in os.environ else PLAIN_WIDTH
    quiet = not stderr and (manner.quiet or manner.json)  # the command prints its result only
    return Console(stderr=stderr, width=wide, highlight=False, markup=False, quiet=quiet)


def print_error(message: str, label: str = "error: ") -> None:
    """Print one sentence to stderr, unwrapped."""
    from rich.text import Text

    text = Text(label, style="bold red").append(message, style="not bold default")
    screen(stderr=True).print(text, soft_wrap=True)


# Folder that the running command writes its results into.
RESULTS_FOLDER: ContextVar[Path | None] = ContextVar("results", default=None)


def print_wrapped(console: Console, message: str) -> None:
    """Print a line, continued with its own indent where too long; words and paths stay whole."""
    from rich.text import Text

    from gripscale.io.table import wrapped

    console.print(Text(wrapped(message, console.width)), soft_wrap=True)


def print_parts(console: Console, parts: Iterable[str | Table]) -> None:
    """Print sentences as lines, and tables set apart from them."""
    from gripscale.io.table import spaced

    for part in spaced(parts):
        if isinstance(part, str):
            print_wrapped(console, part)
        else:
            console.print(part)


# The line of a terminal that shows the last step of the work.
_STATUS: ContextVar[Status | None] = ContextVar("status", default=None)
# Variable of the environment: set, each step of the work has a line of its own, as for a log.
PROGRESS_LINES = "GRIPSCALE_PROGRESS_LINES"


def show_step(console: Console, text: str) -> None:
    """Write a step of the work over the one before it in a terminal; write nothing elsewhere."""
    from rich.text import Text

    if os.environ.get(PROGRESS_LINES):
        print_wrapped(console, text)
        return
    if console.quiet or not console.is_terminal:  # standard output is a file, or for the result
        console = screen(stderr=True)
    if MANNER.get().quiet or not console.is_terminal:
        return
    status = _STATUS.get()
    if status is None:
        status = console.status("", refresh_per_second=4.0)
        status.start()
        _STATUS.set(status)
    line = Text(text.strip())
    line.truncate(console.width - 3, overflow="ellipsis")
    status.update(line)


def end_steps() -> None:
    """Clear the line of the steps."""
    status = _STATUS.get()
    if status is not None:
        status.stop()
        _STATUS.set(None)


def command(body: Callable[P, None]) -> Callable[P, None]:
    """Return `body` with gripscale's own errors turned into a sentence and an exit code."""

    @wraps(body)
    def inside(*args: P.args, **kwargs: P.kwargs) -> None:
        RESULTS_FOLDER.set(None)
        MANNER.set(_USUAL)
        try:
            body(*args, **kwargs)
        except KeyboardInterrupt:
            end_steps()
            target = RESULTS_FOLDER.get()
            kept = target is not None and any(target.rglob("[!.]*.nc"))
            rest = f"what was finished is kept in {target}" if kept else "nothing was finished"
            print_error(f"Stopped; {rest}.", "")
            raise typer.Exit(STOPPED) from None
        except GripscaleError as error:
            from gripscale.report.failures import explained

            end_steps()
            error.args = (with_options(error.words, kwargs),)
            print_error(explained(error))
            failed = isinstance(error, ConvergenceError)
            raise typer.Exit(_NOT_CONVERGED if failed else BAD_INPUT) from None

    return inside


# Options of every command on a case, by the fields of `Manner`.
_SHARED = {
    "quiet": Annotated[
        bool,
        typer.Option("--quiet", "-q", help="Print the answer and what may change it, no more."),
    ],
    "json": Annotated[
        bool, typer.Option("--json", help="Print the result as JSON in SI units, and nothing else.")
    ],
    "replace": Annotated[
        bool,
        typer.Option("--replace", help="Replace results of another case in the results folder."),
    ],
}


def case_command(body: Callable[..., None]) -> Callable[..., None]:
    """Return the command of a question about a case, with the options that all of these have."""

    @wraps(body)
    def inside(**options: Any) -> None:
        MANNER.set(Manner(**{name: options.pop(name) for name in _SHARED}))
        body(**options)

    signature = inspect.signature(body, eval_str=True)
    shared = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=False, annotation=kind)
        for name, kind in _SHARED.items()
    ]
    parameters = [*signature.parameters.values(), *shared]
    outside = command(inside)
    outside.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    outside.__annotations__ = {item.name: item.annotation for item in parameters}
    return outside


WORTH_WAITING = 2.0  # time left from which on a line says it [s]


def time_left(seconds: float) -> str:
    """Return about how long something still takes, as a clause; empty for a moment."""
    if seconds < WORTH_WAITING:
        return ""
    if seconds < 90.0:
        return f"; about {seconds:.0f} s left"
    return f"; about {seconds / 60.0:.0f} min left"


def progress_printer(console: Console) -> Callable[[Progress], None]:
    """Return what shows each prediction as a step, with the time that the others may take.

    The first answer is printed and stays: a number to judge the rest by, while this is solved.
    """
    from gripscale.questions.answer.variables import SYMBOLS, believed, is_estimated

    begun, solved, first_printed = time.monotonic(), 0, False

    def show(progress: Progress) -> None:
        nonlocal solved, first_printed
        solved += not progress.stored
        answer = progress.result
        width = len(str(progress.total))
        text = f"[{progress.done:>{width}}/{progress.total}] {progress.label}: "
        if answer.prediction_status != "converged":
            text += str(answer.prediction_status.item())
        else:
            area, friction = (float(answer[believed(answer, name)]) for name in SYMBOLS)
            text += f"area {area:.4g}"
            if answer.nominal_speed > 0.0:
                text += f", friction {friction:.3f}"
        if progress.stored:
            show_step(console, f"{text}, already solved")
            return
        if not first_printed and is_estimated(answer, "friction"):
            first_printed = True
            print_wrapped(console, text)
        each = (time.monotonic() - begun) / solved
        wait = time_left(each * (progress.total - progress.done))
        show_step(console, f"{text}, {progress.seconds:.1f} s{wait}")

    return show


def option(text: str, *names: str, metavar: str | None = None) -> Any:
    """Return an option whose default is not printed."""
    return typer.Option(*names, help=text, metavar=metavar, readable=False, show_default=False)


def argument(text: str, metavar: str | None = None) -> Any:
    """Return an argument whose default is not printed."""
    return typer.Argument(help=text, metavar=metavar, readable=False, show_default=False)


CasePath = Annotated[Path, argument("The case file (TOML).", "CASE.toml")]
_FOLDER = "Results folder, instead of this command's own in that of the case."
OwnFolder = Annotated[Path | None, option(_FOLDER, "--output", metavar="DIR")]
_MEASURED = (
    "Measured friction, instead of what the case names: a table with columns speed and friction, "
    "and if known spread, temperature and pressure."
)
MeasuredPath = Annotated[Path | None, option(_MEASURED, "--measured", metavar="FILE.csv")]
SurfaceUnit = Annotated[
    str | None, option("Where the file of the surface does not state it; of counts such as 0.5 um.")
]
SurfaceAxis = Annotated[
    str | None, option("Which way the heights count: up, the default, or down, of depths.")
]
SurfaceChannel = Annotated[
    str | None, option("Channel of heights of an instrument, or column of a text; title or number.")
]
SurfaceCrop = Annotated[
    tuple[str, str] | None, option('Part of the profiles, such as "120 mm" "1780 mm".')
]
_LONGEST = (
    "Longest wave kept in profiles; by default 1.5 footprints, where longer ones hold most of the "
    "mean square height, else all."
)
LongestWavelength = Annotated[str | None, option(_LONGEST)]
_MODULUS = "E (Young) or G (shear), of files of moduli that do not state it."
Modulus = Annotated[str | None, option(_MODULUS, "--modulus", metavar="E|G")]
Workers = Annotated[int | None, option("Cores to use; all by default.")]
Cluster = Annotated[
    str | None, option('"local", or the address of a Dask scheduler: tcp://host:8786.')
]


def with_options(text: str, options: Container[str]) -> str:
    """Return a text whose keys of a case are options of a command, where it has these."""
    if not isinstance(text, Words):
        return text
    return text.with_keys(lambda key: key.option if key.name in options else str(key))


def lengths_of(text: str) -> str | list[str]:
    """Return a length typed as "1 um", or several as "1 um, 2 um"."""
    lengths = [length.strip() for length in text.split(",")]
    return lengths if len(lengths) > 1 else lengths[0]


COLUMNS = (
    "Columns of frequency, storage and loss by name or number from 1, such as 1,3,4, or "
    "frequency=1,storage=3,loss_factor=5."
)


def column_of(text: str) -> str | int:
    """Return the number or the name of a column as it was typed."""
    text = text.strip()
    return int(text) if text.isdecimal() else text


def surface_keys(
    *, channel: str | None, crop: tuple[str, str] | None, **units: str | None
) -> dict[str, Any]:
    """Return options, as typed, as keys of [surface]."""
    keys: dict[str, Any] = {key: value for key, value in units.items() if value is not None}
    keys |= {} if channel is None else {"channel": column_of(channel)}
    return keys if crop is None else {**keys, "crop": list(crop)}


def columns_of(text: str) -> dict[str, str | int] | list[str | int]:
    """Return columns typed as 1,3,4 or as frequency=1,storage=3,loss_factor=4."""
    pairs = [part.split("=", 1) for part in text.split(",")]
    if any(len(pair) == 1 for pair in pairs):
        return [column_of(part) for part in text.split(",")]
    return {quantity.strip(): column_of(column) for quantity, column in pairs}


class CaseCommand:
    """A command that asks a question of a case: the case, where it prints, and its folder.

    `open_results` comes after all that may be refused: before it, nothing is printed or written.
    """

    target: Path  # folder of its results

    def __init__(self, path: Path) -> None:
        from gripscale.case_file import read_case_file

        self.file, self.console = read_case_file(path), screen()

    @cached_property
    def case(self) -> Case:
        """The case, read when it is first needed."""
        from gripscale.case_file import read_case

        show_step(self.console, READING)
        return read_case(self.file)

    def open_results(self, output: Path | None, name: str, opening: str = "") -> None:
        """Make the folder of results, `name` in that of the case by default; print the opening."""
        from gripscale.case_file.folder import claim
        from gripscale.io.folders import require_writable

        self.target = output or self.file.resolve(self.file.case.output.folder) / name
        require_writable(self.target)
        RESULTS_FOLDER.set(self.target)
        opening = ": ".join(filter(None, [opening, self.case.title]))
        claim(self.target, self.file.path, replace=MANNER.get().replace)
        end_steps()
        print_wrapped(self.console, opening)

    def solving(self, workers: int | None) -> dict[str, Any]:
        """Return the solver arguments: folder, workers and progress callback."""
        show_step(self.console, "solving ...")
        progress = progress_printer(self.console)
        return {"folder": self.target, "workers": workers, "on_task": progress}

    def finish(
        self,
        result: Result,
        contents: str,
        *,
        drawings: str = "figures",
        page: Callable[[Path], Path] | None = None,
    ) -> None:
        """End the command with its result: save, print and draw it.

        `contents` is what the folder holds beside the result, `drawings` the folder of the figures.
        """
        from gripscale.charts.draw import FigureFolder
        from gripscale.io.folders import make_folder

        target = self.target
        result.save(target / result.file)
        figures = FigureFolder(target / drawings, self.file.case.output.figures)
        make_folder(figures.path)

        def draw() -> None:
            for name, figure in result.figures():
                figures.save(figure, name)

        closing = f"Result ({result.file}), {contents} are in"
        self.conclude(result, list(result.parts()), closing=closing, draw=draw, page=page)

    def conclude(
        self,
        result: Result,
        parts: Sequence[str | Table],
        *,
        closing: str,
        draw: Callable[[], object],
        answer_printed: bool = False,
        page: Callable[[Path], Path] | None = None,
    ) -> None:
        """Print what the command found, draw figures and page, set the exit code.

        The answer, unless it is printed already, the first findings and `parts` are printed, or the
        answer alone where no more is asked for. `closing` says what is in the folder.
        """
        from gripscale.questions.result import warning_lines

        target, console = self.target, self.console
        end_steps()
        warnings = warning_lines(result.findings, ON_PAGE, result.half_widths)
        lead = () if answer_printed else (*result.lines, *warnings)
        print_parts(console, ["", *lead, *parts])
        show_step(console, "drawing figures and page ...")
        draw()
        try:
            words = f"Page: {(page or result.page)(target / 'report.html')}"
        except GripscaleError as error:  # such as an extra that is not installed
            words = f"note: no page; {error}"
        end_steps()
        print_parts(console, ["", f"{closing} {target}", words])
        if MANNER.get().json:
            from gripscale.questions.result_json import result_as_json

            typer.echo(result_as_json(result, str(self.file.path), self.case.origin.files))
        elif MANNER.get().quiet:
            console.quiet = False
            warnings = warning_lines(result.findings, widths=result.half_widths)
            print_parts(console, [*result.lines, *warnings])
        if result.failure:
            print_error(result.failure)
            raise typer.Exit(_NOT_CONVERGED)
