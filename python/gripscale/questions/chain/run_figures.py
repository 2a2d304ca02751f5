"""The figures of a run, drawn in a thread of its own while the kernel solves."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from gripscale.charts.figure_folder import FigureProcess, Figures
from gripscale.questions.chain.charts import contact_sheet
from gripscale.questions.chain.charts_of_blocks import all_blocks
from gripscale.questions.chain.events import Event, OnEvent, PredictionFinished, WaveSolved
from gripscale.questions.chain.run import planned
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.cut_off.charts import cut_off_sheet
from gripscale.questions.inputs.charts_of_rubber import rubber_figures
from gripscale.questions.inputs.charts_of_surface import surface_figures
from gripscale.questions.inputs.record import excited
from gripscale.questions.words import JUDGE

if TYPE_CHECKING:
    from gripscale.case import Case
    from gripscale.questions.answer.answer import Answer
    from gripscale.questions.chain.run import ChainRun


@contextmanager
def background_figures(run: ChainRun, figures: Figures) -> Iterator[OnEvent]:
    """Draw the figures of a case while it is being solved.

    Gives a function to be called with the events of `gripscale.case_file.run_case`: with the
    first wave the folder of results is ready and the direct contact solved, with the end of a
    prediction its blocks are complete. On leaving, what went wrong is raised.
    """
    names = [name for name, _ in planned(run.case)]
    with ThreadPoolExecutor(1, thread_name_prefix="figures") as pool:
        jobs: dict[str, Future[None]] = {}

        def draw(task: Callable[..., None], *arguments: Any) -> None:
            if task.__name__ not in jobs:
                jobs[task.__name__] = pool.submit(task, *arguments, figures)

        def on_event(event: Event) -> None:
            if isinstance(event, WaveSolved):
                if isinstance(figures, FigureProcess) and "draw_direct" not in jobs:
                    figures.release()
                draw(draw_inputs, run.case)
                if run.answer is not None:
                    draw(draw_direct, run.answer)
            elif isinstance(event, PredictionFinished):
                draw(draw_blocks, run, event.prediction)
                if event.prediction == names[-1]:
                    draw(draw_contact, run)

        if isinstance(figures, FigureProcess):
            draw(draw_inputs, run.case)
        yield on_event
        if "draw_direct" in jobs:
            draw(draw_contact, run)
        for future in jobs.values():
            future.result()


def draw_inputs(case: Case, figures: Figures) -> None:
    """Draw profiles, correlation and master curve."""
    surface_figures(case.surface, figures)
    omega = excited(case.load.speed, case.surface.sines)
    rubber_figures(case.measured_rubber, omega, figures)


def draw_blocks(run: ChainRun, name: str, figures: Figures) -> None:
    """Draw the blocks of a prediction, "dynamic" or "static"."""
    figures.save(all_blocks(run.dataset(name)), f"blocks_{name}")


def draw_contact(run: ChainRun, figures: Figures) -> None:
    """Draw area and friction of all predictions, what judges them, and against the cut-off."""
    predictions = map(run.dataset, run.predictions)
    titles = {PredictionView(data).title.lower(): data for data in predictions}
    if run.answer is not None and run.answer.is_solved:
        titles[JUDGE] = run.answer.data
    figures.save(contact_sheet(titles), "contact_and_friction")
    if run.answer is not None and run.answer.curve is not None:
        figures.save(cut_off_sheet(run.answer.curve), "cut_off")


def draw_direct(answer: Answer, figures: Figures) -> None:
    """Draw rubber on surface, pressure and friction of the first direct contact, if it is solved.

    The page shows the others.
    """
    for name, figure in answer.figures():
        figures.save(figure, name)
