"""The figures of a run, described in a thread of its own while the kernel solves."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from gripscale.charts.figure_folder import FigureProcess, Figures
from gripscale.questions.chain.events import Event, OnEvent, PredictionFinished, WaveSolved
from gripscale.questions.chain.run import planned

if TYPE_CHECKING:
    from gripscale.questions.chain.run import ChainRun


@contextmanager
def background_figures(run: ChainRun, figures: Figures) -> Iterator[OnEvent]:
    """Draw the figures of a case while it is being solved.

    Gives a function to be called with the events of `gripscale.case_file.run_case`: with the
    first wave
    the folder of results is ready and the direct contact solved, with the end of a prediction its
    blocks are complete. On leaving, what went wrong is raised.
    """
    names = [name for name, _ in planned(run.case)]
    with ThreadPoolExecutor(1, thread_name_prefix="figures") as pool:
        jobs: dict[str, Future[None]] = {}

        def job(task: str, *arguments: Any) -> None:
            from gripscale.charts import write

            getattr(write, task)(*arguments, figures)

        def draw(task: str, *arguments: Any) -> None:
            if task not in jobs:
                jobs[task] = pool.submit(job, task, *arguments)

        def on_event(event: Event) -> None:
            if isinstance(event, WaveSolved):
                if isinstance(figures, FigureProcess) and "draw_direct" not in jobs:
                    figures.release()
                draw("draw_inputs", run.case)
                if run.answer is not None:
                    draw("draw_direct", run.answer)
            elif isinstance(event, PredictionFinished):
                draw("draw_blocks", run, event.prediction)
                if event.prediction == names[-1]:
                    draw("draw_contact", run)

        if isinstance(figures, FigureProcess):
            draw("draw_inputs", run.case)
        yield on_event
        if "draw_direct" in jobs:
            draw("draw_contact", run)
        for future in jobs.values():
            future.result()
