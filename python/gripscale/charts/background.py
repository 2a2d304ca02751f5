"""The figures of a run, described in a thread of its own while the kernel solves."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING

from gripscale.case_file.events import Event, OnEvent, PredictionFinished, WaveSolved
from gripscale.charts.figure_folder import FigureProcess, Figures

if TYPE_CHECKING:
    from gripscale.case_file.results import CaseResults


@contextmanager
def background_figures(results: CaseResults, figures: Figures) -> Iterator[OnEvent]:
    """Draw the figures of a case while it is being solved.

    Gives a function to be called with the events of `gripscale.case_file.run_case`: with the
    first wave
    the folder of results is ready and the direct contact solved, with the end of a prediction its
    blocks are complete. On leaving, what went wrong is raised.
    """
    planned = [name for name, _ in results.planned()]
    with ThreadPoolExecutor(1, thread_name_prefix="figures") as pool:
        jobs: dict[str, Future[None]] = {}

        def job(task: str, *arguments: str) -> None:
            from gripscale.charts import write

            getattr(write, task)(results, *arguments, figures)

        def draw(task: str, *arguments: str) -> None:
            if task not in jobs:
                jobs[task] = pool.submit(job, task, *arguments)

        def on_event(event: Event) -> None:
            if isinstance(event, WaveSolved):
                if isinstance(figures, FigureProcess) and "draw_direct" not in jobs:
                    figures.release()
                draw("draw_inputs")
                draw("draw_direct")
            elif isinstance(event, PredictionFinished):
                draw("draw_blocks", event.prediction)
                if event.prediction == planned[-1]:
                    draw("draw_contact")

        if isinstance(figures, FigureProcess):
            draw("draw_inputs")
        yield on_event
        if "draw_direct" in jobs:
            draw("draw_contact")
        for future in jobs.values():
            future.result()
