"""Solving many tasks: what the store has is read, the rest is solved and stored as it comes.

Results are written by the calling thread only, in whatever order they come; a result depends on
its task alone, so neither the order nor the number of workers changes a bit of it.

On one machine the workers are threads: nearly all time is spent in the compiled kernel, which
leaves Python's lock free. Measured on two cores with six chains of eight waves: one thread 7.8 s,
two threads 4.6 s, two processes 3.9 s once they have started, which takes them 1 to 2 s. Threads
need no guard in the caller's script; `client="local"` gives processes.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import closing, contextmanager
from dataclasses import dataclass
from typing import Any

import xarray as xr

from gripscale import checks
from gripscale.study.store import Store
from gripscale.study.task import Solved, Task


@dataclass(frozen=True)
class Progress:
    """What became of one task, as `on_task` is told."""

    done: int
    total: int
    label: str
    result: xr.Dataset
    seconds: float
    """Time it took to solve [s]; zero if it was found in the store."""
    stored: bool
    """Whether it was found in the store."""


OnTask = Callable[[Progress], None]


def solve_all(
    tasks: Mapping[str, Task],
    store: Store,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> dict[str, xr.Dataset]:
    """Return the result of every task by its key, solving only what `store` does not have.

    Parameters
    ----------
    tasks
        Tasks by label. Equal tasks are solved once.
    store
        Where finished tasks are kept.
    workers
        Threads, or processes of a local cluster; one per core by default.
    client
        None: threads of this process. "local": a Dask cluster of processes on this machine.
        "tcp://...": the address of a Dask scheduler. Or a `distributed.Client`.
    on_task
        Called after each task with its `Progress`.

    Raises
    ------
    InputError
        If an input cannot be used, or the cluster cannot be reached.
    FileError
        If a result cannot be written.
    """
    wanted: dict[str, tuple[str, Task]] = {}
    for label, task in tasks.items():
        wanted.setdefault(task.key, (label, task))
    results: dict[str, xr.Dataset] = {}

    def tell(key: str, seconds: float, *, stored: bool) -> None:
        if on_task is not None:
            label = wanted[key][0]
            on_task(Progress(len(results), len(wanted), label, results[key], seconds, stored))

    for key in wanted:
        found = store.get(key)
        if found is not None:
            results[key] = found
            tell(key, 0.0, stored=True)
    missing = [task for key, (_, task) in wanted.items() if key not in results]
    with _solver(missing, workers, client) as stream:
        for key, solved, seconds in stream:
            results[key] = store.put(key, solved.assign_attrs(seconds=seconds))
            tell(key, seconds, stored=False)
    return results


def cores() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def _solver(tasks: list[Task], workers: int | None, client: Any) -> Iterator[Iterable[Solved]]:
    """Give the results of `tasks` as they come, from threads or from a cluster."""
    count = cores() if workers is None else checks.whole("workers", workers, least=1, most=1024)
    if not tasks:
        yield ()
    elif client is None:
        with closing(_threads(tasks, count)) as stream:
            yield stream
    else:
        from gripscale.study.cluster import cluster

        with cluster(client, count) as solve, closing(solve(tasks)) as stream:
            yield stream


def _threads(tasks: list[Task], workers: int) -> Generator[Solved, None, None]:
    """Solve in threads; on any end but the natural one, stop after the waves now being solved."""
    stop = threading.Event()
    pool = ThreadPoolExecutor(workers, thread_name_prefix="gripscale")
    try:
        futures: list[Future[Solved]] = [pool.submit(task.solve, stop) for task in tasks]
        for future in as_completed(futures):
            yield future.result()
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)
