"""What `gripscale run` does: it solves a case, prints and writes it, step by step."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from gripscale.case_file import folder
from gripscale.charts.draw import FigureFolder
from gripscale.core.provenance import version_of
from gripscale.experiment.solve import Bench, Progress
from gripscale.io import netcdf
from gripscale.io.folders import make_folder
from gripscale.io.table import Table, as_text
from gripscale.questions import terminal
from gripscale.questions.answer.answer import (
    ANSWER_FILE,
    CHAIN_FILE,
    CURVE_FILE,
    Answer,
    answer_by,
    bench_of,
    solved_chain,
)
from gripscale.questions.answer.direct_contact import direct_contact_design
from gripscale.questions.answer.page import slopes_table
from gripscale.questions.answer.variables import OF_THE_PAPER
from gripscale.questions.chain.page import LEGEND, chain_tables, judgement, waves_in_brief
from gripscale.questions.cut_off.question import CutOff, cut_off_result
from gripscale.questions.inputs.charts_of_rubber import rubber_figures
from gripscale.questions.inputs.charts_of_surface import surface_figures
from gripscale.questions.inputs.page import conditions_lines, rubber_parts, surface_lines
from gripscale.questions.inputs.record import excited
from gripscale.questions.result import warning_lines
from gripscale.rubber.extrapolation import require_measured
from gripscale.rubber.material import require_load_bearing

if TYPE_CHECKING:
    from gripscale.case import Case

Parts = list[str | Table]


def solve_run(
    work: terminal.CaseCommand, target: Path, *, verbose: bool, figures: bool = False
) -> None:
    """Solve, print and write a case: its answer, and the chain of waves beside it.

    Inputs and further tables are printed if `verbose`. Figures are on the page, and also files if
    `figures`, if the case says so, or where no page can be written.
    """
    case, console = work.case, work.console
    rubber, load, measured = case.rubber_before, case.load, case.surface.measured is not None
    require_load_bearing(rubber, load.pressure, load.time_under(load.footprint))
    if case.chain.extrapolate == "refuse":
        require_measured(rubber, case.surface.sines.wavelength, load.speed)
    header = f"gripscale {version_of('gripscale')}, case {work.file.path}"
    work.open_results(target, "", header)
    terminal.show_step(console, f"solving the {'direct contact' if measured else 'chain'} ...")

    def print_answer(bench: Bench) -> Answer:
        result = answer_by(bench, case, target)
        terminal.end_steps()
        findings = warning_lines(result.findings, terminal.ON_PAGE, result.half_widths)
        more = ["", *_inputs(case)] if verbose else []
        terminal.print_parts(console, ["", *result.lines, *findings, *more])
        folder.prepare(target, work.file)
        if measured:
            terminal.show_step(console, f"solving {OF_THE_PAPER}, for comparison ...")
        return result

    bench = bench_of(target)
    result = _with_chain(case, bench, print_answer) if measured else print_answer(bench)
    terminal.end_steps()
    result.save(target / ANSWER_FILE)
    assert result.chain is not None
    netcdf.save(result.chain, target / CHAIN_FILE)
    if result.curve is not None:
        cut_off_result(result.curve, case).save(target / CURVE_FILE)
    by_default = ["png"] if figures or not all(map(find_spec, ("bokeh", "jinja2"))) else []
    _conclude(work, result, verbose, [*(work.file.case.output.figures or by_default)])


def _with_chain(case: Case, bench: Bench, answer_of: Callable[[Bench], Answer]) -> Answer:
    """Return the answer of a measured case with the chain, solved beside the last contact.

    The answer is called for as soon as all contacts are known.
    """
    design = direct_contact_design(case, case.load, traces=True)
    assert design is not None
    contacts, memory, answers = design.tasks, dict[str, xr.Dataset](), list[Answer]()

    def on_task(progress: Progress) -> None:
        memory[progress.result.attrs["prediction_key"]] = progress.result
        if not answers and memory.keys() >= {task.key for task in contacts.values()}:
            answers.append(answer_of(replace(bench, memory=memory)))

    both = replace(bench, on_task=on_task)
    try:
        both.solve(contacts | {OF_THE_PAPER: case.task()}, lambda answer, task: xr.Dataset())
    except Exception:
        if not answers:  # the chain failed before the contacts were solved
            answer_of(bench)
        raise
    answers[0].chain = solved_chain(case, bench)
    return answers[0]


def _conclude(
    work: terminal.CaseCommand, result: Answer, verbose: bool, kinds: Sequence[str]
) -> None:
    """Print what stands below the answer; write figures, as files of all `kinds`, and page.

    Of the chain of a measured surface only the waves in brief and how it compares, unless
    `verbose`.
    """
    case, target = work.case, work.target
    assert result.chain is not None
    parts: Parts = [*chain_tables(result.chain), LEGEND, *slopes_table(result.data)]
    if result.curve is not None:
        curve = CutOff(result.curve)
        parts += ["", *(line.strip() for line in curve.lines[1:]), curve.rules_table()]
    if case.surface.measured is not None:
        tables = parts if verbose else [waves_in_brief(result.chain)]
        parts = [*tables, judgement(result.chain, result.data)]

    def draw() -> None:
        if not kinds:
            return
        figures = FigureFolder(target / "figures", kinds)
        make_folder(figures.path)
        surface_figures(case.surface, figures)
        rubber_figures(case.measured_rubber, excited(case), figures)
        for name, figure in result.figures():
            figures.save(figure, name)

    work.conclude(
        result,
        parts,
        answer_printed=True,
        closing=f"Results{' and figures' if kinds else ''} are in",
        draw=draw,
    )
    if verbose:
        terminal.print_wrapped(work.console, result.lines[0])


def _inputs(case: Case) -> Parts:
    """Return what was read and fitted, as lines."""
    rubber = as_text(*rubber_parts(case.measured_rubber), width=10**6).splitlines()
    parts: dict[str, Iterable[str]] = {"Surface": surface_lines(case.surface), "Rubber": rubber}
    if case.conditions is not None:
        parts["Conditions"] = conditions_lines(case.conditions, case.rubber)
    lines: Parts = []
    for title, texts in parts.items():
        lines += ["", title, *(f"  {text}".rstrip() for text in texts)]
    return lines[1:]
