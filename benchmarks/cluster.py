"""A thousand predictions on a cluster of two workers: time beside the tasks, and a killed worker.

Overhead a task is the wall time of both workers less that of the tasks themselves, over the tasks.
The study is solved once in this process, and once more on a cluster one of whose workers is killed
after a tenth of the tasks: the same to the last bit.
"""

from __future__ import annotations

import importlib
import logging
import os
import signal
import time
from typing import Any

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.rough_contact import tread
from benchmarks.table import show
from gripscale.experiment import Progress
from gripscale.questions import Study
from gripscale.surface import self_affine_profile
from gripscale.theory.persson import Persson

TASKS, WORKERS = 1000, 2


def run(console: Console) -> None:
    """Print the times; skip with a sentence where Dask is missing."""
    try:
        distributed: Any = importlib.import_module("distributed")
    except ModuleNotFoundError:
        console.print("cluster: skipped, Dask is not installed: pip install gripscale[cluster]\n")
        return
    line = self_affine_profile(0.8, 0.02, 3e-4, 0.2, 5e-5, seed=1)
    case = gs.Case(line, tread(), pressure=3e5, speed=0.3, smallest_wavelength=4e-4)
    study = Study(case, {"speed": np.geomspace(1e-3, 10.0, TASKS)}, model=Persson())
    with (
        distributed.LocalCluster(
            n_workers=WORKERS,
            threads_per_worker=1,
            processes=True,
            dashboard_address=None,
            silence_logs=logging.CRITICAL,
        ) as made,
        distributed.Client(made) as client,
    ):
        rows = [_row("this process", *_timed(study)), _row("two workers", *_timed(study, client))]
        killed: list[int] = []

        def kill(progress: Progress) -> None:
            if progress.done == TASKS // 10 and not killed:
                killed.append(min(client.run(os.getpid).values()))
                os.kill(killed[0], signal.SIGKILL)

        after = _timed(study, client, on_task=kill)
    alone = _timed(study)[0]
    same = all(alone[name].identical(after[0][name]) for name in alone.data_vars)
    rows.append(_row(f"two workers, one killed; {'the same' if same else 'OTHER NUMBERS'}", *after))
    show(
        console,
        f"{TASKS} predictions, Persson's theory",
        ["where", "wall s", "tasks s", "overhead a task, ms"],
        rows,
        "Asked: 20 ms a task, nothing lost.",
    )


def _timed(study: Study, client: Any = None, on_task: Any = None) -> tuple[Any, float, float, int]:
    """Return the study, its wall time, that of its tasks [s], and the workers."""
    seconds: list[float] = []

    def note(progress: Progress) -> None:
        seconds.append(progress.seconds)
        if on_task is not None:
            on_task(progress)

    start = time.perf_counter()
    data = study.run(client=client, workers=1, on_task=note)
    return data, time.perf_counter() - start, sum(seconds), 1 if client is None else WORKERS


def _row(where: str, _: Any, wall: float, tasks: float, workers: int) -> list[str]:
    overhead = 1e3 * (workers * wall - tasks) / TASKS
    return [where, f"{wall:.1f}", f"{tasks:.1f}", f"{overhead:.1f}"]
