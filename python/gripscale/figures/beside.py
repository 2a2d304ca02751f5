"""The figures of a case drawn in a thread of their own, while the kernel solves.

The kernel leaves Python's lock free, so that importing matplotlib and drawing cost next to nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gripscale.case.results import CaseResults


@contextmanager
def drawn_beside(results: CaseResults, folder: Path) -> Iterator[Callable[[str], None]]:
    """Draw all figures of a case into `folder` while it is being solved.

    Gives a function to be called with the name of the prediction that a wave was just solved for:
    what is complete is drawn. On leaving all the rest is drawn; what went wrong is raised there.
    """
    begun: list[str] = []
    with ThreadPoolExecutor(1, thread_name_prefix="figures") as pool:
        jobs: list[Future[None]] = []

        def draw(what: str, *arguments: Any) -> None:
            jobs.append(pool.submit(_draw, what, results, *arguments, folder))

        def solving(name: str) -> None:
            if name in begun:
                return
            if begun:
                draw("draw_blocks", begun[-1])
            else:
                draw("draw_inputs")
            begun.append(name)

        yield solving
        if begun:
            draw("draw_blocks", begun[-1])
            draw("draw_contact")
        for job in jobs:
            job.result()


def _draw(what: str, *arguments: Any) -> None:
    getattr(import_module("gripscale.figures.case_all"), what)(*arguments)
