"""The bench: what its store has is read, all other tasks are solved and stored as they come.

Answers are written by the calling thread only, in whatever order they come; an answer depends on
its task alone, so neither the order nor the number of workers changes a bit of it.

The workers are threads, because the compiled kernel leaves Python's lock free. Processes are worth
their start on many cores (docs/uncertainty.md); the script then needs the guard
`if __name__ == "__main__"`. Workers of a Dask cluster need no common file system; one that dies
loses only the prediction it was solving.
"""

from __future__ import annotations

import importlib
import multiprocessing
import signal
import sys
import warnings
from collections.abc import Callable, Generator, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import xarray as xr

from gripscale.core import ConvergenceError, InputError, RubberWarning, provenance
from gripscale.core.parallel import in_threads, sharing, worker_count
from gripscale.core.provenance import software
from gripscale.experiment.task import PREDICTIONS, Solved, Store, Task
from gripscale.io import netcdf
from gripscale.model import OnProgress


@dataclass(frozen=True)
class Progress:
    """One finished task, as `on_task` gets it."""

    done: int
    total: int
    label: str
    result: xr.Dataset
    seconds: float
    """Time to solve it [s]; zero if it was in the store."""
    stored: bool
    """Whether it was in the store."""


OnTask = Callable[[Progress], None]
_Solve = Callable[[list[Task]], Generator[Solved, None, None]]
# Reduces the answer of a task to what is kept in memory.
Pick = Callable[[xr.Dataset, Task], xr.Dataset]


@dataclass(frozen=True)
class Bench:
    """Where tasks are solved."""

    store: Store | None
    """Keeps every answer as soon as it is there; None for tasks that are solved at one go."""
    workers: int | None = None
    """Threads, or processes of a local cluster; one per core by default."""
    client: Any = None
    """None: threads of this process. "processes": processes on this machine. "local": the same by
    a Dask cluster, which replaces those that die.
    "tcp://...": the address of a Dask scheduler. Or a `distributed.Client`."""
    on_task: OnTask | None = None
    """Called after each task with its `Progress`."""
    on_step: OnProgress = None
    """Called in threads of this process with each step of a model, such as a solved contact."""
    memory: Mapping[str, xr.Dataset] = field(default_factory=dict)
    """Answers by the keys of their tasks that need not be read from the store."""

    def solve(self, tasks: Mapping[str, Task], pick: Pick | None = None) -> dict[str, xr.Dataset]:
        """Return the answer of every task by its key; only what the store lacks is solved.

        `tasks` by label; equal ones are solved once. `pick` is what is kept of an answer beside the
        attributes `prediction_key` and `seconds`; by default all of it. Raises `InputError` if an
        input cannot be used or the cluster cannot be reached, `FileError` if an answer cannot be
        written.
        """
        wanted: dict[str, tuple[str, Task]] = {}
        for label, task in tasks.items():
            wanted.setdefault(task.key, (label, task))
        answers: dict[str, xr.Dataset] = {}

        def finish(key: str, answer: xr.Dataset, seconds: float, *, stored: bool) -> None:
            label, task = wanted[key]
            kept = answer
            if pick is not None:
                names = ("prediction_key", "seconds")
                attrs = {name: answer.attrs[name] for name in names if name in answer.attrs}
                kept = pick(answer, task).assign_attrs(attrs)
            answers[key] = kept
            if self.on_task is not None:
                count = len(answers), len(wanted)
                self.on_task(Progress(*count, label, answer, seconds, stored))

        for key in wanted:
            answer = self.memory.get(key)
            if answer is None and self.store is not None:
                answer = self.store.get(key)
            if answer is not None:
                finish(key, answer, 0.0, stored=True)
        missing = [task for key, (_, task) in wanted.items() if key not in answers]
        count = worker_count(self.workers)
        with ExitStack() as ending:
            solve: _Solve = partial(_in_threads, workers=count, on_step=self.on_step)
            if missing and self.client == PROCESSES:
                solve = partial(_in_processes, workers=min(count, len(missing)))
            elif missing and self.client is not None:
                solve = ending.enter_context(cluster(self.client, count))
            for key, solved, seconds in ending.enter_context(closing(solve(missing))):
                answer = solved.assign_attrs(seconds=seconds)
                if self.store is not None:
                    path = self.store.put(key, answer)
                    # a reduction takes the same numbers from either; else as it is read later
                    answer = answer if pick else netcdf.load_dataset(path)
                finish(key, answer, seconds, stored=False)
        return answers


@contextmanager
def bench_in(
    folder: str | Path | None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    on_step: OnProgress = None,
) -> Iterator[Bench]:
    """Give a bench with its store in the folder of a result; a temporary store without a folder."""
    with ExitStack() as ending:
        if folder is None:
            folder = ending.enter_context(TemporaryDirectory(prefix="gripscale-"))
        yield Bench(Store(Path(folder) / PREDICTIONS), workers, client, on_task, on_step)


def _in_threads(
    tasks: list[Task], workers: int, on_step: OnProgress
) -> Generator[Solved, None, None]:
    """Yield results as they come.

    Tasks whose parts fill the threads are solved one after the other: the first answer comes early.
    """
    jobs = [partial(task.solve, on_step=on_step) for task in tasks]
    parts = min((task.model.parts(task.surface) for task in tasks), default=1)
    at_once = workers // parts if workers % parts == 0 else workers
    with closing(in_threads(jobs, workers, at_once)) as stream:
        yield from (solved for _, solved in stream)


PROCESSES = "processes"


def _in_processes(tasks: list[Task], workers: int) -> Generator[Solved, None, None]:
    """Yield results as they come; an interrupt waits for the tasks that are being solved."""
    context = multiprocessing.get_context("spawn")  # a fork would lack the threads of the kernel
    with ProcessPoolExecutor(workers, context, _ignore_interrupts) as pool:
        try:
            # whole tasks: what an answer rests on may come from parts its numbers do not need
            futures = [pool.submit(_alone, task) for task in tasks]
            for future in as_completed(futures):
                yield future.result()
        except BrokenProcessPool as error:
            raise ConvergenceError(
                "a process that solved a prediction ended; the machine may be short of memory "
                "(use fewer workers, or run again: what was solved is kept)"
            ) from error
        finally:
            pool.shutdown(cancel_futures=True)


def _ignore_interrupts() -> None:
    """Leave Ctrl-C, which reaches all processes of a terminal, to the one that asked for them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore", RubberWarning)  # the caller has seen those of its inputs


CONNECT_SECONDS = 10  # how long to wait for a scheduler to answer


@contextmanager
def cluster(client: Any, workers: int) -> Iterator[_Solve]:
    """Give a function that solves tasks on a cluster: "local", ended afterwards, or a scheduler's.

    A `distributed.Client` stays open. Raises `InputError` if Dask is not installed, the scheduler
    does not answer or has another gripscale.
    """
    if sys.modules.get("dask", importlib) is None:  # kept out by the command line
        del sys.modules["dask"]
    try:
        distributed = importlib.import_module("distributed")
    except ModuleNotFoundError as error:
        raise InputError(
            "a cluster needs Dask, which is not installed: pip install gripscale[cluster]"
        ) from error
    with ExitStack() as ending:
        if client == "local":
            local = distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
            )
            client = ending.enter_context(local)
        if not isinstance(client, distributed.Client):
            try:
                connected = distributed.Client(
                    client, timeout=CONNECT_SECONDS, set_as_default=False
                )
            except (OSError, ValueError, TimeoutError) as error:
                raise InputError(
                    f'cluster must be "local" or the address of a Dask scheduler that answers, '
                    f'such as "tcp://host:8786"; got {client!r}'
                ) from error
            client = ending.enter_context(connected)
        here = software()
        for worker, there in client.run(provenance.software).items():
            if there != here:  # other code, whatever its version says
                raise InputError(
                    f"worker {worker} has {there}, this machine {here}; install the same"
                )

        def solve(tasks: list[Task]) -> Generator[Solved, None, None]:
            futures = [client.submit(_alone, task, key=f"gripscale-{task.key}") for task in tasks]
            stream = distributed.as_completed(futures, loop=client.loop, with_results=True)
            try:
                for future, result in stream:
                    yield result
                    future.release()
            except distributed.KilledWorker as error:
                raise ConvergenceError(
                    f"the cluster gave up a prediction that {error.allowed_failures} workers died "
                    "on; they may be short of memory"
                ) from error
            finally:
                client.cancel(futures)

        yield solve


def _alone(task: Task) -> Solved:
    """Solve in a worker, whose neighbours have the other cores."""
    with sharing(1):
        return task.solve()
