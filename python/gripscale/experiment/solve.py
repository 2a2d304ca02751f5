"""Solving many tasks: what the store has is read, the rest is solved and stored as it comes.

Results are written by the calling thread only, in whatever order they come; a result depends on
its task alone, so neither the order nor the number of workers changes a bit of it.

On one machine the workers are threads: nearly all time is spent in the compiled kernel, which
leaves Python's lock free. Measured on two cores with six chains of eight waves: one thread 7.8 s,
two threads 4.6 s, two processes 3.9 s once they have started, which takes them 1 to 2 s. Threads
need no guard in the caller's script; `client="local"` gives processes.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from typing import Any

import xarray as xr

from gripscale.core.errors import ConvergenceError, InputError
from gripscale.core.parallel import in_threads, sharing, worker_count
from gripscale.core.provenance import software
from gripscale.experiment.task import Solved, Store, Task


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
        with cluster(client, count) as solve, closing(solve(tasks)) as stream:
            yield stream


# The same tasks on a Dask cluster: `pip install gripscale[cluster]`.
#
# Tasks go to whatever workers there are and results come back to the caller, which stores them: the
# workers need gripscale but no common file system. A worker that dies takes nothing with it but the
# wave it was solving; its tasks go to the others.

Solve = Callable[[list[Task]], Generator[Solved, None, None]]

CONNECT_SECONDS = 10
"""How long to wait for a scheduler to answer."""


@contextmanager
def cluster(client: Any, workers: int) -> Iterator[Solve]:
    """Give a function that solves tasks on a cluster.

    Parameters
    ----------
    client
        "local" (a cluster of `workers` processes, ended afterwards), the address of a scheduler,
        or a `distributed.Client`, which stays open.

    Raises
    ------
    InputError
        If Dask is not installed, the scheduler does not answer or has another gripscale.
    """
    distributed = _distributed()
    with ExitStack() as ending:
        if client == "local":
            local = distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
            )
            client = ending.enter_context(local)
        if not isinstance(client, distributed.Client):
            client = ending.enter_context(_connected(distributed, client))
        _require_same_software(client)
        yield lambda tasks: _solve(distributed, client, tasks)


def _solve(distributed: Any, client: Any, tasks: list[Task]) -> Generator[Solved, None, None]:
    """Yield results as they come."""
    futures = [client.submit(_alone, task.reduced(), key=f"gripscale-{task.key}") for task in tasks]
    try:
        for future, result in distributed.as_completed(
            futures, loop=client.loop, with_results=True
        ):
            yield result
            future.release()
    except distributed.KilledWorker as error:
        raise ConvergenceError(
            f"the cluster gave up a prediction that {error.allowed_failures} workers died on; "
            "they may be short of memory"
        ) from error
    finally:
        client.cancel(futures)


def _alone(task: Task) -> Solved:
    """Solve in a worker, whose neighbours have the other cores."""
    with sharing(1):
        return task.solve()


def _distributed() -> Any:
    """Return Dask's package, or say how to get it."""
    try:
        return importlib.import_module("distributed")
    except ModuleNotFoundError as error:
        raise InputError(
            "a cluster needs Dask, which is not installed: pip install gripscale[cluster]"
        ) from error


def _connected(distributed: Any, address: Any) -> Any:
    try:
        return distributed.Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise InputError(
            f'cluster must be "local" or the address of a Dask scheduler that answers, such as '
            f'"tcp://host:8786"; got {address!r}'
        ) from error


def _require_same_software(client: Any) -> None:
    """Raise `InputError` if a worker would solve with other code, whatever its version says."""
    here = software()
    for worker, there in client.run(_software_there).items():
        if there != here:
            raise InputError(f"worker {worker} has {there}, this machine {here}; install the same")


def _software_there() -> str:
    return software()
