"""What the commands share: where they print, and how an error becomes one sentence and a code."""

from __future__ import annotations

import os
import sys
import textwrap
import time
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from contextvars import ContextVar
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ParamSpec

import typer

from gripscale.core.errors import ConvergenceError, GripscaleError, InputError
from gripscale.core.wording import Words

if TYPE_CHECKING:
    import xarray as xr
    from pydantic import BaseModel
    from rich.console import Console

    from gripscale.case_file import CaseFile
    from gripscale.core.finding import Finding
    from gripscale.experiment.solve import Progress
    from gripscale.io.table import Table
    from gripscale.questions.result import Result


BAD_INPUT, _NOT_CONVERGED, STOPPED = 2, 3, 130
"""Exit codes: an input that cannot be used, a wave without solution, stopped from outside."""

RUN_REPORT, RUN_CLOSING = "report.txt", "Results, report and figures are in"
"""Text in the folder of a run, and what its last line says."""

PLAIN_WIDTH = 100
"""Characters per line where there is no terminal to ask."""

P = ParamSpec("P")


def screen(stderr: bool = False) -> Console:
    """Return a console for a terminal, or for a plain file or pipe of sensible width."""
    from rich.console import Console

    stream = sys.stderr if stderr else sys.stdout
    wide = None if stream.isatty() or "COLUMNS" in os.environ else PLAIN_WIDTH
    return Console(stderr=stderr, width=wide, highlight=False, markup=False)


def print_error(message: str) -> None:
    """Print one sentence to stderr, unwrapped."""
    from rich.text import Text

    text = Text("error: ", style="bold red").append(message, style="not bold default")
    screen(stderr=True).print(text, soft_wrap=True)


RESULTS_FOLDER: ContextVar[Path | None] = ContextVar("results", default=None)
"""Folder that the running command writes its results into."""


def failure_of(error: GripscaleError | KeyboardInterrupt) -> tuple[str, int]:
    """Return the sentence and the exit code a command ends with after `error`."""
    if isinstance(error, KeyboardInterrupt):
        target = RESULTS_FOLDER.get()
        if target is None or not any(target.rglob("[!.]*.nc")):
            return "stopped; nothing was finished", STOPPED
        stopped = (
            f"stopped; finished results are kept in {target}, "
            "and the same command continues from them"
        )
        return stopped, STOPPED
    from gripscale.report.failures import explained

    exit_code = _NOT_CONVERGED if isinstance(error, ConvergenceError) else BAD_INPUT
    return explained(error), exit_code


def print_wrapped(console: Console, message: str) -> None:
    """Print a line, continued with its own indent where too long; words and paths stay whole."""
    from rich.text import Text

    indent = " " * (len(message) - len(message.lstrip()))
    lines = textwrap.wrap(
        message,
        console.width,
        subsequent_indent=f"{indent}  ",
        break_long_words=False,
        break_on_hyphens=False,
        replace_whitespace=False,
    )
    console.print(Text("\n".join(lines)), soft_wrap=True)


def print_parts(console: Console, parts: Iterable[str | Table]) -> None:
    """Print sentences as lines, and tables set apart from them."""
    from gripscale.io.table import spaced

    for part in spaced(parts):
        if isinstance(part, str):
            print_wrapped(console, part)
        else:
            console.print(part)


def conclude(
    console: Console,
    target: Path,
    parts: Sequence[str | Table],
    *,
    results: Sequence[xr.Dataset],
    text: str,
    closing: str,
    opening: Sequence[str | Table] = (),
    lead: Sequence[str] = (),
    warnings: Sequence[Finding] = (),
    width: int = PLAIN_WIDTH,
    files: Mapping[str, str] | None = None,
    draw: Callable[[], object] | None = None,
    page: Callable[[], Path] | None = None,
    failure: str = "",
) -> None:
    """End a command: print and write what it found, draw its figures, set the exit code.

    The numbers of `results` are written as a flat table for Excel.
    `lead`, the answer, the first of the ranked `warnings` and `parts` are printed. The file `text`,
    with lines of `width`, has `lead`, all warnings, then `opening`, which the screen shows already,
    then `parts`; `files` are further texts by name.
    `closing` says what is in the folder. `page` writes a page, where the libraries for it are
    installed; `failure` is what has no result, and sets the exit code.
    """
    from gripscale.io.folders import write_text
    from gripscale.io.table import as_text
    from gripscale.questions.result import warning_lines
    from gripscale.questions.summary_table import write_summary

    console.print()
    print_parts(console, [*lead, *warning_lines(warnings, text), *parts])
    answer = [*lead, *warning_lines(warnings)]
    above = [line for lines in (answer, opening) if lines for line in (*lines, "")]
    texts = {text: as_text(*above, *parts, width=width), **(files or {})}
    for name, content in texts.items():
        write_text(target / name, content)
    write_summary(results, target)
    if draw is not None:
        draw()
    console.print()
    print_wrapped(console, f"{closing} {target}")
    if page is not None:
        try:
            print_wrapped(console, f"Page: {page()}")
        except InputError as error:  # the extra is not installed
            print_wrapped(console, f"note: no page; {error}")
    if failure:
        print_error(failure)
        raise typer.Exit(_NOT_CONVERGED)


def command(body: Callable[P, None]) -> Callable[P, None]:
    """Return `body` with gripscale's own errors turned into a sentence and an exit code."""

    @wraps(body)
    def inside(*args: P.args, **kwargs: P.kwargs) -> None:
        RESULTS_FOLDER.set(None)
        try:
            body(*args, **kwargs)
        except (GripscaleError, KeyboardInterrupt) as error:
            if isinstance(error, GripscaleError):
                error.args = (with_options(error.words, kwargs),)
            message, exit_code = failure_of(error)
            print_error(message)
            raise typer.Exit(exit_code) from None

    return inside


WORTH_WAITING = 2.0
"""Time left from which on a line says it [s]."""


def time_left(seconds: float) -> str:
    """Return about how long something still takes, as a clause; empty for a moment."""
    if seconds < WORTH_WAITING:
        return ""
    if seconds < 90.0:
        return f"; about {seconds:.0f} s left"
    return f"; about {seconds / 60.0:.0f} min left"


def progress_printer(console: Console) -> Callable[[Progress], None]:
    """Return what prints a line for each prediction, with the time that the others may take."""
    from gripscale.questions.words import SYMBOLS, believed

    begun, solved = time.monotonic(), 0

    def print_line(progress: Progress) -> None:
        nonlocal solved
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
            print_wrapped(console, f"{text}, already solved")
            return
        each = (time.monotonic() - begun) / solved
        wait = time_left(each * (progress.total - progress.done))
        print_wrapped(console, f"{text}, {progress.seconds:.1f} s{wait}")

    return print_line


def option(text: str, *names: str, metavar: str | None = None) -> Any:
    """Return an option whose default is not printed."""
    return typer.Option(*names, help=text, metavar=metavar, readable=False, show_default=False)


def argument(text: str, metavar: str | None = None) -> Any:
    """Return an argument whose default is not printed."""
    return typer.Argument(help=text, metavar=metavar, readable=False, show_default=False)


CasePath = Annotated[Path, argument("The case file (TOML).", "CASE.toml")]
OwnFolder = Annotated[
    Path | None,
    option(
        "Results folder, instead of this command's own in that of the case.",
        "--output",
        metavar="DIR",
    ),
]
MeasuredPath = Annotated[
    Path | None,
    option(
        "Measured friction, instead of what the case names: a table with columns speed and "
        "friction, and if known spread, temperature and pressure.",
        "--measured",
        metavar="FILE.csv",
    ),
]
Workers = Annotated[int | None, option("Cores to use; all by default.")]
Cluster = Annotated[
    str | None, option('"local", or the address of a Dask scheduler: tcp://host:8786.')
]


def keys_of(context: typer.Context, table: type[BaseModel]) -> dict[str, Any]:
    """Return the options of a command that are keys of a table of the case, those that are set."""
    values = {key: context.params.get(key) for key in table.model_fields}
    return {key: value for key, value in values.items() if value is not None and value is not False}


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


def columns_of(text: str) -> dict[str, str | int] | list[str | int]:
    """Return columns typed as 1,3,4 or as frequency=1,storage=3,loss_factor=4."""
    parts = text.split(",")
    if not all("=" in part for part in parts):
        return [column_of(part) for part in parts]
    pairs = [part.split("=", 1) for part in parts]
    return {quantity.strip(): column_of(column) for quantity, column in pairs}


def open_folder(
    file: CaseFile, output: Path | None, name: str, *opening: str
) -> tuple[Console, Path]:
    """Print what a command begins with and make its folder `name`, by default in the case's."""
    from gripscale.io.folders import make_folder, require_writable

    target = output or file.resolve(file.case.output.folder) / name
    require_writable(target)
    RESULTS_FOLDER.set(target)
    console = screen()
    for line in opening:
        print_wrapped(console, line)
    make_folder(target)
    return console, target


class CaseCommand:
    """A command that asks a question of a case: the case, where it prints, and its folder.

    `open_results` comes after all that may be refused: before it, nothing is printed or written.
    """

    def __init__(self, path: Path) -> None:
        from gripscale.case_file import read_case, read_case_file

        self.file = read_case_file(path)
        self.case = read_case(self.file)

    def open_results(self, output: Path | None, name: str, *opening: str) -> None:
        """Print what the command begins with; its folder and its text are called `name`."""
        self._text = f"{name}.txt"
        self.console, self.target = open_folder(self.file, output, name, *opening)

    def solving(self, workers: int | None) -> dict[str, Any]:
        """Return where a question keeps what it solves, on how many cores, and what tells of it."""
        progress = progress_printer(self.console)
        return {"folder": self.target, "workers": workers, "on_task": progress}

    def finish(
        self,
        result: Result,
        contents: str,
        *,
        text: str = "",
        opening: Sequence[str | Table] = (),
        drawings: str = "figures",
        files: Mapping[str, str] | None = None,
        keep_figures: bool = False,
        page: bool = False,
    ) -> None:
        """End the command with the result of its question: save, print and draw it.

        `contents` is what the folder holds beside the result, `text` the file of what is printed
        where it has another name, and `drawings` the folder of the figures; `files` are further
        texts by name. With `keep_figures` figures of an earlier run stay as they are. With `page`
        the page of the result is written, too.
        """
        from gripscale.charts.figure_folder import FigureFolder
        from gripscale.io.folders import make_folder

        target = self.target
        result.save(target / result.file)
        figures = FigureFolder(target / drawings, self.file.case.output.figures)
        make_folder(figures.path)

        def draw() -> None:
            if keep_figures and any(figures.path.iterdir()):
                return
            for name, figure in result.figures():
                figures.save(figure, name)

        conclude(
            self.console,
            target,
            list(result.parts()),
            results=[result.data],
            lead=result.lines,
            warnings=result.findings,
            text=text or self._text,
            closing=f"Result ({result.file}), {contents} are in",
            opening=opening,
            files=files,
            draw=draw,
            page=partial(result.page, target / "report.html") if page else None,
            failure=result.failure,
        )
