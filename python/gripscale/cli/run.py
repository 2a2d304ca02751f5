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

from gripscale import terminal
from gripscale.core.errors import FileError, GripscaleError
from gripscale.terminal import CasePath, argument, command, option

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console

    from gripscale.case import Case
    from gripscale.case_file.read import CaseFile
    from gripscale.charts.figure_folder import Figures
    from gripscale.core.units import DisplayUnit
    from gripscale.io.table import Table
    from gripscale.questions.answer.answer import Answer
    from gripscale.questions.chain.events import Event, OnEvent
    from gripscale.questions.chain.run import ChainRun


_REPORT, REPORT_WIDTH = "report.txt", 110
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
    from gripscale.case_file.finished import is_finished
    from gripscale.case_file.read import read_case_file
    from gripscale.charts.figure_folder import FigureFolder, figures_elsewhere
    from gripscale.io.folders import require_writable

    as_json = progress == ProgressFormat.JSON
    console = terminal.screen(stderr=as_json)
    with _json_events(progress) as emit:
        file = read_case_file(case)
        target = output if output is not None else file.resolve(file.case.output.folder)
        if not (fresh or as_json) and is_finished(file, target, _shown_too(target)):
            _print_finished(console, target)
        else:
            require_writable(target)
            terminal.RESULTS_FOLDER.set(target)
            kinds = file.case.output.figures
            with figures_elsewhere(FigureFolder(target / "figures", kinds)) as figures:
                _run(console, emit, file, target, figures, fresh)


@contextmanager
def _json_events(progress: ProgressFormat) -> Iterator[OnEvent]:
    """Give what writes an event to standard output, if asked for; the last tells the exit code."""
    from gripscale.questions.chain.events import RunFailed, RunFinished, event_to_json

    def emit(event: Event) -> None:
        if progress == ProgressFormat.JSON:
            print(event_to_json(event), flush=True)

    try:
        yield emit
    except (GripscaleError, KeyboardInterrupt) as error:
        emit(RunFailed(*terminal.failure_of(error)))
        raise
    emit(RunFinished())


def _print_finished(console: Console, target: Path) -> None:
    """Print the report of a run that is finished."""
    report = target / _REPORT
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
    from gripscale.case_file import read_case
    from gripscale.case_file.finished import case_replaced, note_finished
    from gripscale.questions.chain.events import FileWritten
    from gripscale.questions.chain.run import ChainRun
    from gripscale.questions.chain.run_figures import background_figures, draw_effects, draw_heat
    from gripscale.report.failures import explained
    from gripscale.report.summary import SUMMARY_FILE as SUMMARY

    chain = ChainRun.of(read_case(file), target, fresh=fresh)
    other = case_replaced(file, target)
    if other:
        words = f"Replaces the results of {other} in {target}; --output DIR keeps both."
        terminal.print_wrapped(console, words)
    with background_figures(chain, figures) as draw:
        answer, opening = _print_answer(console, chain, target)
        effects = _solve(console, emit, file, chain, answer, draw)
        parts, heat = _parts(chain, answer, effects, target)
        solved = [answer.data] if answer.is_solved else []
        solved += [chain.dataset(name) for name in chain.predictions]

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
            text=_REPORT,
            closing=CLOSING,
            opening=opening,
            width=REPORT_WIDTH,
            draw=draw_conditions,
        )
        emit(FileWritten(str(target / _REPORT)))
        if solved:
            emit(FileWritten(str(target / SUMMARY)))
    _print_older_page(console, target)
    failures = list(chain.failures.values())
    for failure in failures[:-1]:
        terminal.print_error(explained(failure))
    if failures:
        raise failures[-1]
    note_finished(file, target, _shown_too(target))


def _print_answer(console: Console, chain: ChainRun, target: Path) -> tuple[Answer, list[str]]:
    """Solve the answer of a case, print it above the inputs; return it and the lines printed."""
    from gripscale.core.provenance import version_of
    from gripscale.questions.answer.answer import answer
    from gripscale.questions.result import warning_lines

    case = chain.case
    header = f"gripscale {version_of('gripscale')}, case {case.name}"
    terminal.print_wrapped(console, header)
    if case.below_measurement.down_to is not None:
        terminal.print_wrapped(console, "solving with the roughness below the measurement ...")
    result = chain.answer = answer(case, folder=target)
    lead, inputs = ["", *result.lines], ["", *_inputs(case)]
    for line in (*lead, *warning_lines(result.findings, _REPORT), *inputs):
        terminal.print_wrapped(console, line)
    return result, [header, *lead, *warning_lines(result.findings), *inputs]


def _solve(
    console: Console,
    emit: OnEvent,
    file: CaseFile,
    chain: ChainRun,
    answer: Answer,
    draw: OnEvent,
) -> xr.Dataset | None:
    """Solve and write the chain and, where the case asks for them, the effects of conditions."""
    from gripscale.case_file import run_case
    from gripscale.questions.answer.answer import ANSWER_FILE as ANSWER
    from gripscale.questions.chain.events import AnswerSolved, EffectsSolved, FileWritten
    from gripscale.questions.cut_off.question import cut_off_result
    from gripscale.questions.vary.effects import EFFECTS_FILE as EFFECTS
    from gripscale.questions.vary.effects import case_effects

    case, target = chain.case, chain.folder
    assert target is not None
    print_event = _event_printer(console, case.display_unit("speed"))

    def on_event(event: Event) -> None:
        emit(event)
        print_event(event)
        draw(event)

    with console.status("solving") if console.is_terminal else nullcontext():
        run_case(file, output=target, on_event=on_event, run=chain)
        if answer.is_solved:
            answer.save(target / ANSWER)
            emit(AnswerSolved.of(answer))
            emit(FileWritten(str(target / ANSWER)))
        if answer.curve is not None:
            cut_off_result(answer.curve, case).save(target / "cut_off.nc")
        effects = case_effects(case, case.chain, target, target / "effects", dynamic=chain.dynamic)
        if effects is not None:
            emit(EffectsSolved.of(effects))
            emit(FileWritten(str(target / EFFECTS.format(model=case.chain.name))))
    return effects


def _print_older_page(console: Console, target: Path) -> None:
    """Say if a page of an earlier run stays beside these results."""
    page, case = target / "report.html", target / "case.toml"
    if page.is_file() and page.stat().st_mtime < case.stat().st_mtime:
        words = shlex.join(["gripscale", "report", str(target)])
        terminal.print_wrapped(console, f"{page.name} in it is older; `{words}` renews it")


def _inputs(case: Case) -> list[str]:
    """Return what the run starts from, line by line."""
    from gripscale.io.table import as_text
    from gripscale.questions.inputs.page import conditions_lines, rubber_parts, surface_lines

    rubber = as_text(*rubber_parts(case.measured_rubber), width=10**6).splitlines()
    lines = [
        "Surface",
        *(f"  {line}" for line in surface_lines(case.surface)),
        "",
        "Rubber",
        *(f"  {line}".rstrip() for line in rubber),
    ]
    if case.conditions is not None:
        conditions = conditions_lines(case.conditions, case.rubber)
        lines += ["", "Conditions", *(f"  {line}" for line in conditions)]
    return lines


def _event_printer(console: Console, speed_unit: DisplayUnit) -> OnEvent:
    """Return what prints a sentence for each event that a person waits for."""
    from gripscale.questions.chain.events import PredictionFinished, ResultsReplaced, WaveSolved
    from gripscale.questions.chain.run import title

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
    chain: ChainRun, answer: Answer, effects: xr.Dataset | None, target: Path
) -> tuple[list[str | Table], xr.Dataset | None]:
    """Return tables and sentences of a run, and the prediction that has heat to be drawn."""
    from gripscale.questions.answer.page import slopes_table
    from gripscale.questions.calibration.page import measured_lines
    from gripscale.questions.chain.page import LEGEND, heat_table, prediction_table
    from gripscale.questions.chain.run import DYNAMIC
    from gripscale.questions.chain.view import PredictionView
    from gripscale.questions.compare.page import judgement
    from gripscale.questions.cut_off.page import cut_off_basis, rules_table
    from gripscale.questions.uncertainty.page import uncertainty_lines
    from gripscale.questions.uncertainty.propagation import stored_uncertainty
    from gripscale.questions.vary.page_side_by_side import effects_table

    case = chain.case
    views = [PredictionView(chain.dataset(name), name) for name in chain.predictions]
    parts: list[str | Table] = [prediction_table(view.data, view.title) for view in views]
    parts += [LEGEND] if views else []
    moving, heat = chain.dynamic, None
    if moving is not None and moving.conditions is not None and moving.conditions.heat is not None:
        heat = chain.dataset(DYNAMIC)
        parts.append(heat_table(heat))
    if effects is not None:
        parts.append(effects_table(effects))
    if answer.is_solved:
        parts += slopes_table(answer.data)
        parts += ["", *judgement(views[0], answer.data)] if views else []
    if case.friction is not None and case.load.speed > 0.0:
        parts += measured_lines(case.friction, case.load.speed, case.display_unit("speed"))
    sampled = stored_uncertainty(target)
    parts += uncertainty_lines(sampled, case.origin.text, case.origin.digests)
    if answer.curve is not None:
        parts += ["", *cut_off_basis(answer.curve), rules_table(answer.curve)]
    return parts, heat


@command
def report_command(
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
def open_app(
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
