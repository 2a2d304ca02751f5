"""What `gripscale run` does: it solves a case, prints and writes it, step by step."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.case_file import folder
from gripscale.core.provenance import version_of
from gripscale.io.table import Table, as_text
from gripscale.questions import terminal
from gripscale.questions.answer.answer import ANSWER_FILE, Answer, answer, answer_with_inputs
from gripscale.questions.answer.page import slopes_table
from gripscale.questions.answer.waves import waves_answer
from gripscale.questions.chain.charts import heat_sheet
from gripscale.questions.chain.page import LEGEND, heat_table, prediction_table
from gripscale.questions.chain.run import CHAIN_REPORT, DYNAMIC, ChainRun
from gripscale.questions.chain.run_figures import draw_contact, draw_inputs
from gripscale.questions.chain.view import PredictionView, title
from gripscale.questions.compare.page import judgement
from gripscale.questions.cut_off.question import CutOff, cut_off_result
from gripscale.questions.inputs.page import conditions_lines, rubber_parts, surface_lines
from gripscale.questions.page_of_folder import write_report
from gripscale.questions.result import warning_lines
from gripscale.questions.uncertainty.page import uncertainty_lines
from gripscale.questions.uncertainty.propagation import stored_uncertainty
from gripscale.questions.words import OF_THE_PAPER
from gripscale.report.failures import explained

if TYPE_CHECKING:
    import xarray as xr
    from rich.console import Console

    from gripscale.case import Case
    from gripscale.chain.prediction import ChainResult
    from gripscale.charts.figure_folder import Figures

REPORT_WIDTH = 110  # characters of the lines of the report


def solve_run(
    work: terminal.CaseCommand, target: Path, figures: Figures, *, show_chain: bool
) -> None:
    """Prepare, solve, print and write a case."""
    case, console = work.case, work.console
    chain, measured = ChainRun(case), case.surface.measured is not None
    header = f"gripscale {version_of('gripscale')}, case {work.file.path}"
    work.open_results(target, "", header)
    if measured:
        terminal.show_step(console, "solving the direct contact ...")
        chain.answer = answer(case, folder=target)
        _print_answer(console, case, chain.answer)
    replaced = folder.earlier_run(target)
    if replaced:
        terminal.print_wrapped(console, replaced)
    folder.prepare(target, work.file)
    draw_inputs(chain, figures)
    terminal.show_step(console, f"solving {OF_THE_PAPER}, for comparison ...")
    chain.solve(target, lambda so_far: _print_wave(console, case, so_far))
    if chain.answer is None:
        waves = chain.dataset(next(iter(chain.predictions)))
        chain.answer = answer_with_inputs(case, waves_answer(case, waves))
        _print_answer(console, case, chain.answer)
    chain.answer.save(target / ANSWER_FILE)
    if chain.answer.curve is not None:
        cut_off_result(chain.answer.curve, case).save(target / "cut_off.nc")
    of_chain, heat = _chain_parts(chain)
    parts, files = _parts(chain, chain.answer, target), {}
    if not measured:
        parts = [*of_chain, *parts]
    else:
        files = {CHAIN_REPORT: as_text(*of_chain, width=REPORT_WIDTH)}
        if show_chain:
            terminal.print_parts(console, ["", *of_chain])

    def draw() -> None:
        draw_contact(chain, figures)
        if heat is not None:
            figures.save(heat_sheet(heat), "heat")

    work.conclude(
        chain.answer,
        parts,
        answer_printed=True,
        text=terminal.RUN_REPORT,
        closing=terminal.RUN_CLOSING,
        page=lambda page: write_report(target, page),
        opening=[f"{header}: {case.title}", "", *_inputs(case)],
        width=REPORT_WIDTH,
        files=files,
        draw=draw,
    )
    terminal.print_wrapped(console, chain.answer.lines[0])
    failures = list(chain.failures.values())
    for failure in failures[:-1]:
        terminal.print_error(explained(failure))
    if failures:
        raise failures[-1]


def _print_answer(console: Console, case: Case, answer: Answer) -> None:
    """Print an answer with its first findings, above the inputs of its case."""
    terminal.end_steps()
    findings = warning_lines(answer.findings, terminal.RUN_REPORT, answer.half_widths)
    terminal.print_parts(console, ["", *answer.lines, *findings, "", *_inputs(case)])


def _inputs(case: Case) -> list[str]:
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


def _print_wave(console: Console, case: Case, so_far: ChainResult) -> None:
    """Show how far a prediction is."""
    wave = so_far.scales[-1]
    terminal.show_step(
        console,
        f"{title(wave.speed, case.display_unit('speed'))}, "
        f"wave {len(so_far.scales)} of {so_far.planned}: {wave.wavelength * 1e3:.3g} mm, "
        f"contact {wave.contact_fraction:.3f}",
    )


def _chain_parts(chain: ChainRun) -> tuple[list[str | Table], xr.Dataset | None]:
    """Return tables of the chain, and the prediction that has heat to be drawn."""
    views = [PredictionView(chain.dataset(name), name) for name in chain.predictions]
    parts: list[str | Table] = [prediction_table(view.data, view.title) for view in views]
    parts += [LEGEND] if views else []
    moving, heat = chain.dynamic, None
    if moving is not None and moving.conditions is not None and moving.conditions.heat is not None:
        heat = chain.dataset(DYNAMIC)
        parts.append(heat_table(heat))
    return parts, heat


def _parts(chain: ChainRun, answer: Answer, target: Path) -> list[str | Table]:
    """Return tables and sentences that stand below an answer."""
    case = chain.case
    parts: list[str | Table] = list(slopes_table(answer.data))
    sampled = stored_uncertainty(target)
    parts += uncertainty_lines(sampled, case.origin.text, case.origin.digests)
    if answer.curve is not None:
        curve = CutOff(answer.curve)
        parts += ["", *curve.basis, curve.rules_table()]
    for name in list(chain.predictions)[:1]:
        parts += ["", *judgement(PredictionView(chain.dataset(name)), answer.data)]
    return parts
