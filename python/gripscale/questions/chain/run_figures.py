"""The figures of a run, drawn in a thread of its own while the kernel solves."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager

from gripscale.charts.figure_folder import FigureProcess, Figures
from gripscale.questions.answer.reliance import is_measured
from gripscale.questions.chain.charts import contact_sheet
from gripscale.questions.chain.events import Event, OnEvent, PredictionFinished, WaveSolved
from gripscale.questions.chain.run import ChainRun, planned
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.cut_off.charts import cut_off_sheet
from gripscale.questions.inputs.charts_of_rubber import rubber_figures
from gripscale.questions.inputs.charts_of_surface import surface_figures
from gripscale.questions.inputs.record import excited
from gripscale.questions.words import JUDGE, OF_THE_PAPER


@contextmanager
def background_figures(run: ChainRun, figures: Figures) -> Iterator[OnEvent]:
    """Draw the figures of a case while it is being solved.

    Gives a function to be called with the events of `ChainRun.solve`: with the first wave the
    folder of results is ready and the direct contact solved. On leaving, what went wrong is raised.
    """
    last = list(planned(run.case))[-1]
    with ThreadPoolExecutor(1, thread_name_prefix="figures") as pool:
        jobs: dict[Callable[[ChainRun, Figures], None], Future[None]] = {}

        def draw(task: Callable[[ChainRun, Figures], None]) -> None:
            if task not in jobs:
                jobs[task] = pool.submit(task, run, figures)

        def on_event(event: Event) -> None:
            if isinstance(event, WaveSolved):
                if isinstance(figures, FigureProcess) and _draw_direct not in jobs:
                    figures.release()
                draw(_draw_inputs)
                if run.answer is not None:
                    draw(_draw_direct)
            elif isinstance(event, PredictionFinished) and event.prediction == last:
                draw(_draw_contact)

        if isinstance(figures, FigureProcess):
            draw(_draw_inputs)
        yield on_event
        if _draw_direct in jobs:
            draw(_draw_contact)
        for future in jobs.values():
            future.result()


def _draw_inputs(run: ChainRun, figures: Figures) -> None:
    surface, load = run.case.surface, run.case.load
    surface_figures(surface, figures)
    rubber_figures(run.case.measured_rubber, excited(load.speed, surface.sines), figures)


def _draw_direct(run: ChainRun, figures: Figures) -> None:
    for name, figure in [] if run.answer is None else run.answer.figures():
        figures.save(figure, name)


def _draw_contact(run: ChainRun, figures: Figures) -> None:
    """Draw area and friction of all predictions, what judges them, and against the cut-off."""
    titles = {}
    for name in run.predictions:
        view = PredictionView(run.dataset(name))
        of = "" if run.case.surface.measured is None else f"{OF_THE_PAPER}, "
        titles[f"{of}{view.title.lower()}"] = view.data
    if run.answer is not None and is_measured(run.answer.data):
        titles[JUDGE] = run.answer.data
    figures.save(contact_sheet(titles), "contact_and_friction")
    if run.answer is not None and run.answer.curve is not None:
        figures.save(cut_off_sheet(run.answer.curve), "cut_off")
