"""Solving many tasks: what the store has is read, the rest is solved and stored as it comes.

Results are written by the calling thread only, in whatever order they come; a result depends on
its task alone, so neither the order nor the number of workers changes a bit of it.

On one machine the workers are threads: nearly all time is spent in the compiled kernel, which
leaves Python's lock free. Measured on two cores with six chains of eight waves: one thread 7.8 s,
two threads 4.6 s, two processes 3.9 s once they have started, which takes them 1 to 2 s. Threads
need no guard in the caller's script; `client="local"` gives processes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from typing import Any

import xarray as xr

from gripscale.parallel import in_threads, worker_count
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


@contextmanager
def _solver(tasks: list[Task], workers: int | None, client: Any) -> Iterator[Iterable[Solved]]:
    """Give the results of `tasks` as they come, from threads or from a cluster."""
    count = worker_count(workers)
    if not tasks:
        yield ()
    elif client is None:
        with closing(in_threads([task.solve for task in tasks], count)) as stream:
            yield (solved for _, solved in stream)
    else:
        from gripscale.study.cluster import cluster

        with cluster(client, count) as solve, closing(solve(tasks)) as stream:
            yield stream
