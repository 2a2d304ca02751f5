"""The figures of a case, drawn in a thread of their own while the kernel solves."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gripscale.case.results import CaseResults


@contextmanager
def background_figures(results: CaseResults, folder: Path) -> Iterator[Callable[[str], None]]:
    """Draw all figures of a case into `folder` while it is being solved.

    Gives a function to be called with the name of the prediction that a wave was just solved for:
    what is complete is drawn. On leaving all the rest is drawn; what went wrong is raised there.
    A thread of its own draws: the kernel leaves Python's lock free, so that importing matplotlib
    and drawing cost next to nothing.
    """
    begun: list[str] = []
    with ThreadPoolExecutor(1, thread_name_prefix="figures") as pool:
        jobs: list[Future[None]] = []

        def job(task: str, *arguments: str) -> None:
            from gripscale.charts import write

            getattr(write, task)(results, *arguments, folder)

        def draw(task: str, *arguments: str) -> None:
            jobs.append(pool.submit(job, task, *arguments))

        def solving(name: str) -> None:
            if name in begun:
                return
            if begun:
                draw("draw_blocks", begun[-1])
            else:
                draw("draw_inputs")
                draw("draw_direct")
            begun.append(name)

        yield solving
        if begun:
            draw("draw_blocks", begun[-1])
            draw("draw_contact")
        for future in jobs:
            future.result()
