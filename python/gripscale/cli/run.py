"""`gripscale run CASE.toml`: the whole chain, from files to tables, figures and results."""

from __future__ import annotations

import importlib
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from datetime import datetime
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.cli import terminal
from gripscale.cli.terminal import CasePath, argument, command, option
from gripscale.core.errors import FileError, GripscaleError

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console

    from gripscale.case_file import CaseResults
    from gripscale.case_file.events import Event, OnEvent
    from gripscale.case_file.read import CaseFile
    from gripscale.charts.figure_folder import Figures
    from gripscale.core.units import DisplayUnit
    from gripscale.experiment.measured_friction import MeasuredFriction
    from gripscale.io.table import Table


REPORT, REPORT_WIDTH = "report.txt", 110
"""The text a run leaves, and the characters of its lines."""
CLOSING = "Results, report and figures are in"


class ProgressFormat(StrEnum):
    """How `gripscale run` reports what it does."""

    TEXT = "text"
    JSON = "json"


@command
def run(
    case: CasePath,
    output: Annotated[
        Path | None, option("Results folder, instead of the one in the case.", metavar="DIR")
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
            "standard error."
        ),
    ] = ProgressFormat.TEXT,
) -> None:
    """Predict contact area and friction of a case; goes on where it was stopped."""
    from gripscale.case_file import folder
    from gripscale.case_file.finished import is_finished
    from gripscale.case_file.read import read_case
    from gripscale.charts.figure_folder import FigureFolder, figures_elsewhere

    as_json = progress == ProgressFormat.JSON
    console = terminal.screen(stderr=as_json)
    with _json_events(progress) as emit:
        file = read_case(case)
        target = output if output is not None else file.resolve(file.case.output.folder)
        if not (fresh or as_json) and is_finished(file, target, _shown_too(target)):
            _print_finished(console, target)
        else:
            folder.require_writable(target)
            terminal.RESULTS.set(target)
            kinds = file.case.output.figures
            with figures_elsewhere(FigureFolder(target / "figures", kinds)) as figures:
                _run(console, emit, file, target, figures, fresh)


@contextmanager
def _json_events(progress: ProgressFormat) -> Iterator[OnEvent]:
    """Give what writes an event to standard output, if asked for; the last tells the exit code."""
    from gripscale.case_file.events import RunFailed, RunFinished, to_json

    def emit(event: Event) -> None:
        if progress == ProgressFormat.JSON:
            print(to_json(event), flush=True)

    try:
        yield emit
    except (GripscaleError, KeyboardInterrupt) as error:
        emit(RunFailed(*terminal.failure_of(error)))
        raise
    emit(RunFinished())


def _print_finished(console: Console, target: Path) -> None:
    """Print the report of a run that is finished."""
    report = target / REPORT
    date = datetime.fromtimestamp(report.stat().st_mtime).strftime("%Y-%m-%d %H:%M")
    typer.echo(report.read_text(encoding="utf-8"))
    words = f"Finished {date}. Case, files and software are the same; nothing was solved "
    terminal.print_wrapped(console, f"{words}again (--fresh does). {CLOSING} {target}")


def _shown_too(target: Path) -> tuple[Path, ...]:
    """Return the files of other commands that a run shows."""
    return (target / "uncertainty" / "uncertainty.nc",)


def _run(
    console: Console, emit: OnEvent, file: CaseFile, target: Path, figures: Figures, fresh: bool
) -> None:
    """Prepare, solve, print and write a case, with an event for each step."""
    from gripscale.case_file import prepare_case
    from gripscale.case_file.events import FileWritten
    from gripscale.case_file.finished import case_replaced, note_finished
    from gripscale.case_file.run import require_feasible
    from gripscale.charts.background import background_figures
    from gripscale.charts.write import draw_effects, draw_heat
    from gripscale.questions.calibration.measured_comparison import friction_of_case
    from gripscale.report.notices import explained
    from gripscale.report.summary import FILE as SUMMARY

    friction = friction_of_case(file)
    results = prepare_case(file)
    require_feasible(results)
    other = case_replaced(file, target)
    if other:
        words = f"Replaces the results of {other} in {target}; --output DIR keeps both."
        terminal.print_wrapped(console, words)
    with background_figures(results, figures) as draw:
        opening = _print_answer(console, results, friction, target)
        effects = _solve(console, emit, results, target, draw, fresh)
        parts, heat = _parts(results, friction, effects, target)
        solved = [] if results.direct is None else [results.direct]
        solved += [results.dataset(name) for name in results.predictions]

        def draw_conditions() -> None:
            if heat is not None:
                draw_heat(heat, figures)
            if effects is not None:
                draw_effects([effects], figures)

        terminal.conclude(
            console,
            target,
            parts,
            results=solved,
            text=REPORT,
            closing=CLOSING,
            opening=opening,
            width=REPORT_WIDTH,
            draw=draw_conditions,
        )
        emit(FileWritten(str(target / REPORT)))
        if solved:
            emit(FileWritten(str(target / SUMMARY)))
    _print_older_page(console, results, target)
    failures = list(results.failures.values())
    for failure in failures[:-1]:
        terminal.print_error(explained(failure))
    if failures:
        raise failures[-1]
    note_finished(file, target, _shown_too(target))


def _print_answer(
    console: Console, results: CaseResults, friction: MeasuredFriction | None, target: Path
) -> list[str]:
    """Solve what the answer is of, print it above the inputs; return the lines of the report."""
    from gripscale.core.provenance import version_of
    from gripscale.experiment.measured_friction import friction_doubts
    from gripscale.questions.answer.page import answer_lines
    from gripscale.questions.compare.comparison import reference
    from gripscale.questions.inputs import record
    from gripscale.questions.inputs.page_record import InputRecord
    from gripscale.report.notices import case_notices, warning_lines

    file = results.file
    header = f"gripscale {version_of('gripscale')}, case {file.path}"
    terminal.print_wrapped(console, header)
    if file.case.below_measurement.down_to is not None:
        terminal.print_wrapped(console, "solving with the roughness below the measurement ...")
    direct = reference(results, target)
    notes = friction_doubts(friction, results.load.speed)
    inputs_record = InputRecord(record.inputs(results, friction_notes=notes))
    warnings = case_notices(direct, inputs_record)
    answer, inputs = ["", *answer_lines(direct)], ["", *_inputs(results)]
    for line in (*answer, *warning_lines(warnings, REPORT), *inputs):
        terminal.print_wrapped(console, line)
    return [header, *answer, *warning_lines(warnings), *inputs]


def _solve(
    console: Console,
    emit: OnEvent,
    results: CaseResults,
    target: Path,
    draw: OnEvent,
    fresh: bool,
) -> xr.Dataset | None:
    """Solve and write the chain and, where the case asks for them, the effects of conditions."""
    from gripscale.case_file import run_case
    from gripscale.case_file.events import DirectContactSolved, EffectsSolved, FileWritten
    from gripscale.questions.compare.comparison import FILE as DIRECT
    from gripscale.questions.compare.comparison import save_reference
    from gripscale.questions.vary.effects import FILE as EFFECTS
    from gripscale.questions.vary.effects import case_effects

    print_event = _event_printer(console, results.display_unit("speed"))

    def on_event(event: Event) -> None:
        emit(event)
        print_event(event)
        draw(event)

    with console.status("solving") if console.is_terminal else nullcontext():
        run_case(results, output=target, on_event=on_event, fresh=fresh)
        if results.direct is not None:
            save_reference(results, target)
            emit(DirectContactSolved.of(results.direct))
            emit(FileWritten(str(target / DIRECT)))
        effects = case_effects(results, results.chain, target, target / "effects")
        if effects is not None:
            emit(EffectsSolved.of(effects))
            emit(FileWritten(str(target / EFFECTS.format(model=results.chain.name))))
    return effects


def _print_older_page(console: Console, results: CaseResults, target: Path) -> None:
    """Say if a page of an earlier result stays beside this one."""
    page, first = target / "report.html", next(iter(results.predictions), None)
    written = page.read_text(encoding="utf-8", errors="replace") if page.is_file() else None
    if first is not None and written is not None and results.key(first) not in written:
        words = shlex.join(["gripscale", "report", str(target)])
        text = f"{page.name} in it is older and shows another result; `{words}` renews it"
        terminal.print_wrapped(console, text)


def _inputs(results: CaseResults) -> list[str]:
    """Return what the run starts from, line by line."""
    from gripscale.io.table import as_text
    from gripscale.questions.inputs.page import conditions_lines, rubber_parts, surface_lines

    rubber = as_text(*rubber_parts(results.rubber), width=10**6).splitlines()
    lines = [
        "Surface",
        *(f"  {line}" for line in surface_lines(results.surface)),
        "",
        "Rubber",
        *(f"  {line}".rstrip() for line in rubber),
    ]
    if results.conditions is not None:
        conditions = conditions_lines(results.conditions, results.rubber.rubber)
        lines += ["", "Conditions", *(f"  {line}" for line in conditions)]
    return lines


def _event_printer(console: Console, speed_unit: DisplayUnit) -> OnEvent:
    """Return what prints a sentence for each event that a person waits for."""
    from gripscale.case_file.events import PredictionFinished, ResultsReplaced, WaveSolved
    from gripscale.case_file.results import title

    def print_event(event: Event) -> None:
        match event:
            case ResultsReplaced():
                terminal.print_wrapped(console, event.message)
            case WaveSolved():
                if event.number == 1 and event.pass_number == 1:
                    console.print()
                    terminal.print_wrapped(console, title(event.speed, speed_unit))
                elif event.number == 1:
                    terminal.print_wrapped(console, f"  pass {event.pass_number}")
                parts = [
                    f"  wave {event.number} of {event.count}: {event.wavelength * 1e3:.3g} mm",
                    f"contact {event.contact_fraction:.3f}",
                ]
                if event.speed > 0.0:
                    parts.append(f"friction {event.friction:.3f}")
                if event.status != "conditions not settled":
                    parts.append(event.message)
                parts.append("already solved" if event.stored else f"{event.seconds:.1f} s")
                terminal.print_wrapped(console, ", ".join(parts))
            case PredictionFinished(passes=int(passes)):
                agree = "agree" if event.converged else f"do not agree ({event.message})"
                terminal.print_wrapped(
                    console, f"  rubber and contact {agree} after {passes} passes on these meshes"
                )

    return print_event


def _parts(
    results: CaseResults,
    friction: MeasuredFriction | None,
    effects: xr.Dataset | None,
    target: Path,
) -> tuple[list[str | Table], xr.Dataset | None]:
    """Return tables and sentences of a run, and the prediction that has heat to be drawn."""
    from gripscale.case_file.results import DYNAMIC
    from gripscale.questions.calibration.page_of_measured import measured_lines
    from gripscale.questions.chain.page import LEGEND, heat_table, prediction_table
    from gripscale.questions.chain.view import PredictionView
    from gripscale.questions.compare.page import judgement, slopes_table
    from gripscale.questions.cut_off.page import basis_lines, rules_table
    from gripscale.questions.uncertainty.page import uncertainty_lines
    from gripscale.questions.uncertainty.propagation import input_digests, stored_uncertainty
    from gripscale.questions.vary.page_side_by_side import effects_table

    views = [PredictionView(results.dataset(name), name) for name in results.predictions]
    parts: list[str | Table] = [prediction_table(view.data, view.title) for view in views]
    parts += [LEGEND] if views else []
    moving, heat = results.dynamic, None
    if moving is not None and moving.conditions is not None and moving.conditions.heat is not None:
        heat = results.dataset(DYNAMIC)
        parts.append(heat_table(heat))
    if effects is not None:
        parts.append(effects_table(effects))
    if results.direct is not None:
        parts += slopes_table(results.direct)
        parts += ["", *judgement(views[0], results.direct)] if views else []
    if friction is not None and results.load.speed > 0.0:
        parts += measured_lines(friction, results.load.speed, results.display_unit("speed"))
    sampled = stored_uncertainty(target)
    parts += uncertainty_lines(sampled, results.file.text, input_digests(results.file))
    for curve in results.continued.values():
        parts += ["", *basis_lines(curve), rules_table(curve)]
    return parts, heat


@command
def report(
    result: Annotated[
        Path,
        argument(
            "Results folder of a run, comparison, study, calibration or uncertainty, or of "
            "surfaces or rubbers side by side; or one of its .nc files.",
            "RESULT",
        ),
    ],
    output: Annotated[
        Path | None,
        option("The page, instead of report.html in the results folder.", metavar="FILE.html"),
    ] = None,
) -> None:
    """Write one HTML page with inputs, results, figures and evidence; it needs no network."""
    from gripscale.report import write_report

    page = write_report(result, output)
    terminal.print_wrapped(
        terminal.screen(), f"Report, {page.stat().st_size / 1e6:.1f} MB, is {page}"
    )


PASS_ON = {"allow_extra_args": True, "ignore_unknown_options": True, "help_option_names": []}
"""Settings of the command: whatever follows its name is for the reproduction."""


@command
def reproduce(context: typer.Context) -> None:
    """Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements."""
    root = Path(__file__).resolve().parents[3]
    clone = (root / "reproduction" / "__main__.py").is_file()
    if not clone and "--help" in context.args:
        typer.echo(context.get_help())
        return
    if not clone:
        raise FileError(
            "the reproduction is in the source of gripscale, not in the package: "
            "run `python -m reproduction` in a clone of it"
        )
    sys.path.insert(0, str(root))
    raise typer.Exit(importlib.import_module("reproduction.__main__").main(context.args))


@command
def app(
    case: Annotated[
        Path | None,
        argument("A case file to start with, instead of the shipped road.", "CASE.toml"),
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
