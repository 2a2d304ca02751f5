"""`gripscale run CASE.toml`: the whole chain, from files to tables, figures and results."""

from __future__ import annotations

import importlib
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from gripscale.cli.terminal import (
    CasePath,
    command,
    failure_of,
    print_error,
    print_wrapped,
    screen,
    with_doc_link,
)
from gripscale.core.errors import FileError, GripscaleError

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console

    from gripscale.analysis.measured_friction import MeasuredFriction
    from gripscale.case import CaseResults
    from gripscale.case.events import Event, OnEvent
    from gripscale.core.units import DisplayUnit


REPORT_WIDTH = 110


class ProgressFormat(StrEnum):
    """How `gripscale run` reports what it does."""

    TEXT = "text"
    JSON = "json"


class RunExtras(NamedTuple):
    """What stands beside the chain: direct contact, worth of the effects, measured friction."""

    direct: xr.Dataset | None
    effects: xr.Dataset | None
    friction: MeasuredFriction | None


@command
def run(
    case: CasePath,
    output: Annotated[
        Path | None,
        typer.Option(
            help="Results folder, instead of the one in the case.", metavar="DIR", readable=False
        ),
    ] = None,
    fresh: Annotated[
        bool,
        typer.Option(
            "--fresh", help="Solve all anew, also what an earlier run of the same case finished."
        ),
    ] = False,
    progress: Annotated[
        ProgressFormat,
        typer.Option(
            help="json: write a line of JSON for each event to standard output, and all text to "
            "standard error.",
        ),
    ] = ProgressFormat.TEXT,
) -> None:
    """Predict contact area and friction of a case; goes on where it was stopped."""
    with _json_events(progress) as emit:
        _run(screen(stderr=progress == ProgressFormat.JSON), emit, case, output, fresh)


@contextmanager
def _json_events(progress: ProgressFormat) -> Iterator[OnEvent]:
    """Give what writes an event to standard output, if asked for; the last tells the exit code."""
    from gripscale.case.events import RunFailed, RunFinished, to_json

    def emit(event: Event) -> None:
        if progress == ProgressFormat.JSON:
            print(to_json(event), flush=True)

    try:
        yield emit
    except (GripscaleError, KeyboardInterrupt) as error:
        emit(RunFailed(*failure_of(error)))
        raise
    emit(RunFinished())


def _run(console: Console, emit: OnEvent, case: Path, output: Path | None, fresh: bool) -> None:
    """Prepare, solve, print and write a case, with an event for each step."""
    from gripscale.analysis.comparison import FILE as DIRECT
    from gripscale.analysis.comparison import save_reference
    from gripscale.analysis.effects import FILE as EFFECTS
    from gripscale.analysis.effects import case_effects
    from gripscale.analysis.measured_comparison import friction_of_case
    from gripscale.case import folder, prepare_case, read_case, run_case
    from gripscale.case.events import (
        DirectContactSolved,
        EffectsSolved,
        FileWritten,
        WaveSolved,
    )
    from gripscale.charts.background import background_figures

    file = read_case(case)
    target = output if output is not None else file.resolve(file.case.output.folder)
    folder.require_writable(target)
    friction = friction_of_case(file)
    results = prepare_case(file)
    opening = _opening(results)
    for line in opening:
        print_wrapped(console, line)
    print_event = _event_printer(console, results.shown("speed"))
    with background_figures(results, target / "figures") as draw_solved:

        def on_event(event: Event) -> None:
            emit(event)
            print_event(event)
            if isinstance(event, WaveSolved):
                draw_solved(event.prediction)

        with console.status("solving") if console.is_terminal else nullcontext():
            run_case(results, output=target, on_event=on_event, fresh=fresh)
            direct = save_reference(results, target)
            if direct is not None:
                emit(DirectContactSolved.of(direct))
                emit(FileWritten(str(target / DIRECT)))
            effects = case_effects(results, results.chain, target, target / "effects")
            if effects is not None:
                emit(EffectsSolved.of(effects))
                emit(FileWritten(str(target / EFFECTS.format(model=results.chain.name))))
        _conclude_run(console, target, opening, results, RunExtras(direct, effects, friction))
        emit(FileWritten(str(target / "report.txt")))
    console.print()
    print_wrapped(console, f"Results, report and figures are in {target}")
    _tell_old_page(console, target, results)
    _fail_if_any(results)


def _opening(results: CaseResults) -> list[str]:
    """Return what the run starts from, line by line."""
    from gripscale.core.provenance import version_of
    from gripscale.report.inputs_text import rubber_lines, surface_lines

    return [
        f"gripscale {version_of('gripscale')}, case {results.file.path}",
        "",
        "Surface",
        *(f"  {line}" for line in surface_lines(results.surface)),
        "",
        "Rubber",
        *(f"  {line}" for line in rubber_lines(results.rubber)),
        *_conditions(results),
        *(text for note in results.load_notes() for text in ("", f"note: {note}")),
    ]


def _conditions(results: CaseResults) -> list[str]:
    from gripscale.report.inputs_text import conditions_lines

    if results.conditions is None:
        return []
    told = conditions_lines(results.conditions, results.rubber.rubber)
    notes = (f"note: {text}" for text in results.conditions_notes())
    return ["", "Conditions", *(f"  {line}" for line in (*told, *notes))]


def _event_printer(console: Console, speed_unit: DisplayUnit) -> OnEvent:
    """Return what prints a sentence for each event that a person waits for."""
    from gripscale.case.events import PredictionFinished, ResultsReplaced, WaveSolved
    from gripscale.case.results import title

    def print_event(event: Event) -> None:
        match event:
            case ResultsReplaced():
                print_wrapped(console, event.message)
            case WaveSolved():
                if event.number == 1 and event.pass_number == 1:
                    console.print()
                    print_wrapped(console, title(event.speed, speed_unit))
                elif event.number == 1:
                    print_wrapped(console, f"  pass {event.pass_number}")
                parts = [
                    f"  wave {event.number} of {event.count}: {event.wavelength * 1e3:.3g} mm",
                    f"contact {event.contact_fraction:.3f}",
                ]
                if event.speed > 0.0:
                    parts.append(f"friction {event.friction:.3f}")
                if event.status != "conditions not settled":
                    parts.append(event.message)
                parts.append("already solved" if event.stored else f"{event.seconds:.1f} s")
                print_wrapped(console, ", ".join(parts))
            case PredictionFinished(passes=int(passes)):
                agree = "agree" if event.converged else f"do not agree ({event.message})"
                print_wrapped(
                    console, f"  rubber and contact {agree} after {passes} passes on these meshes"
                )

    return print_event


def _conclude_run(
    console: Console,
    target: Path,
    opening: list[str],
    results: CaseResults,
    known: RunExtras,
) -> None:
    """Print the tables and what chain and effects are worth, and write them down."""
    from gripscale.analysis.propagation import input_digests, stored_uncertainty
    from gripscale.case import folder
    from gripscale.charts.view import PredictionView
    from gripscale.report import tables_run
    from gripscale.report.tables_comparison import judgement
    from gripscale.report.tables_measured import measured_lines
    from gripscale.report.tables_uncertainty import uncertainty_lines

    solved = {PredictionView(d).title: d for d in map(results.dataset, results.predictions)}
    for name, data in solved.items():
        console.print()
        console.print(tables_run.prediction_table(data, name, console.width))
    beside = list(_conditions_tables(results, known.effects))
    for table in beside:
        console.print()
        console.print(table)
    if solved:
        console.print()
        print_wrapped(console, tables_run.LEGEND)
    views = [PredictionView(data, name) for name, data in solved.items()]
    last = list(judgement(views[0], known.direct)) if views and known.direct is not None else []
    if known.friction is not None and results.load.speed > 0.0:
        last += measured_lines(known.friction, results.load.speed, results.shown("speed"))
    sampled = stored_uncertainty(target)
    last += uncertainty_lines(sampled, results.file.text, input_digests(results.file))
    if last:
        console.print()
    for line in last:
        print_wrapped(console, line)
    written = [
        tables_run.prediction_table(data, name, REPORT_WIDTH) for name, data in solved.items()
    ]
    parts = (*opening, "", *written, tables_run.LEGEND, *beside, "", *last)
    folder.write_text(target / "report.txt", tables_run.as_text(*parts, width=REPORT_WIDTH))


def _conditions_tables(results: CaseResults, worth: xr.Dataset | None) -> Iterator[Any]:
    """Yield the temperature of each wave and what each effect is worth, and draw both."""
    from gripscale.case.results import DYNAMIC
    from gripscale.charts.write import draw_effects, draw_heat
    from gripscale.report.tables_comparison import effects_table
    from gripscale.report.tables_run import heat_table

    moving = results.dynamic
    figures = None if results.folder is None else results.folder / "figures"
    if moving is not None and moving.conditions is not None and moving.conditions.heat is not None:
        data = results.dataset(DYNAMIC)
        if figures is not None:
            draw_heat(data, figures)
        yield heat_table(data)
    if worth is not None:
        if figures is not None:
            draw_effects([worth], figures)
        yield effects_table(worth)


def _tell_old_page(console: Console, target: Path, results: CaseResults) -> None:
    """Say so if the page in the folder does not show this result."""
    page, first = target / "report.html", next(iter(results.predictions), None)
    if first is None or not page.is_file():
        return
    if results.key(first) not in page.read_text(encoding="utf-8", errors="replace"):
        words = shlex.join(["gripscale", "report", str(target)])
        print_wrapped(
            console, f"{page.name} in it is older and shows another result; `{words}` renews it"
        )


def _fail_if_any(results: CaseResults) -> None:
    """Raise the last failure, which sets the exit code, after a sentence for the others."""
    failures = list(results.failures.values())
    for failure in failures[:-1]:
        print_error(with_doc_link(failure))
    if failures:
        raise failures[-1]


# `gripscale report RESULT`: one self-contained HTML page of a result.


@command
def report(
    result: Annotated[
        Path,
        typer.Argument(
            help="Results folder of a run, comparison, study, calibration or uncertainty, or one "
            "of its .nc files.",
            metavar="RESULT",
            readable=False,
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            help="The page, instead of report.html in the results folder.",
            metavar="FILE.html",
            readable=False,
        ),
    ] = None,
) -> None:
    """Write one HTML page with inputs, results, figures and evidence; it needs no network."""
    from gripscale.report import write_report

    page = write_report(result, output)
    print_wrapped(screen(), f"Report, {page.stat().st_size / 1e6:.1f} MB, is {page}")


# `gripscale reproduce`: hands over to the paper's figures beside the package, in a clone.

PASS_ON = {"allow_extra_args": True, "ignore_unknown_options": True, "help_option_names": []}
"""Settings of the command: whatever follows its name is for the reproduction."""


@command
def reproduce(context: typer.Context) -> None:
    """Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements."""
    root = Path(__file__).resolve().parents[3]
    if not (root / "reproduction" / "__main__.py").is_file():
        raise FileError(
            "the reproduction is in the source of gripscale, not in the package: "
            "run `python -m reproduction` in a clone of it"
        )
    sys.path.insert(0, str(root))
    raise typer.Exit(importlib.import_module("reproduction.__main__").main(context.args))


# `gripscale app [CASE.toml]`: a page in the browser, from measurement to friction.


@command
def app(
    case: Annotated[
        Path | None,
        typer.Argument(
            help="A case file to start with, instead of the shipped road.",
            metavar="CASE.toml",
            readable=False,
            show_default=False,
        ),
    ] = None,
    port: Annotated[int, typer.Option(help="Port of 127.0.0.1; 0 takes a free one.")] = 0,
    folder: Annotated[
        Path,
        typer.Option(
            help="Where each visit gets a folder for its files and results.",
            metavar="DIR",
            readable=False,
        ),
    ] = Path("gripscale-app"),
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Open no browser; the address is printed.")
    ] = False,
) -> None:
    """Open a page that shows, runs and compares cases, on this machine only."""
    from gripscale.app import serve_app

    serve_app(folder, case=case, port=port, browser=not no_browser)
