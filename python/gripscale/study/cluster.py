"""The same tasks on a Dask cluster: `pip install gripscale[cluster]`.

Tasks go to whatever workers there are and results come back to the caller, which stores them: the
workers need gripscale but no common file system. A worker that dies takes nothing with it but the
wave it was solving; its tasks go to the others.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

from gripscale.errors import ConvergenceError, InputError
from gripscale.parallel import sharing
from gripscale.software import software
from gripscale.study.task import Solved, Task

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
