"""Ctrl-C held back while something must not be left half done.

xarray guards its files with one lock for all. An interrupt that lands while it is taken leaves it
taken, and the next file waits for ever.
"""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from types import FrameType
from typing import TypeVar

from gripscale.core import checks


@contextmanager
def held_back() -> Iterator[None]:
    """Let an interrupt from the keyboard act only when the block is left."""
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or before is None:
        yield
        return
    came: list[tuple[int, FrameType | None]] = []
    signal.signal(signal.SIGINT, lambda number, frame: came.append((number, frame)))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came and callable(before):
            before(*came[-1])


# Independent tasks on all cores: threads, since kernel and transforms leave Python's lock free.

T = TypeVar("T")
Job = Callable[[threading.Event], T]
"""Solves one task; gives up between two steps once the event is set."""
_here = threading.local()


class Stopped(Exception):
    """Somebody asked for an end."""


def look() -> None:
    """Raise `Stopped` if the job that this thread works on is to end.

    For long work below a job, which does not know the job's event; does nothing in other threads.
    """
    stop = getattr(_here, "stop", None)
    if stop is not None and stop.is_set():
        raise Stopped


@contextmanager
def sharing(workers: int) -> Iterator[None]:
    """Let what this thread solves use `workers` threads by default: others work beside it."""
    before = getattr(_here, "workers", None)
    _here.workers = workers
    try:
        yield
    finally:
        _here.workers = before


def cores() -> int:
    """Return how many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def worker_count(workers: int | None) -> int:
    """Return `workers`, or one per core; in a job of `in_threads` or under `sharing` its share.

    Raises `InputError` if it is not a whole number from 1 to 1024.
    """
    if workers is not None:
        return checks.whole("workers", workers, least=1, most=1024)
    share: int | None = getattr(_here, "workers", None)
    return cores() if share is None else share


def in_threads(jobs: Sequence[Job[T]], workers: int) -> Generator[tuple[int, T], None, None]:
    """Yield the place and the result of each job as they come.

    Jobs fewer than workers share them: what a job solves uses its share by default.
    On any end but the natural one (an error, Ctrl-C, `close`) the others are told to stop, and
    those that run are waited for: they hear it from their event and from `look`.
    """
    stop = threading.Event()
    share = max(workers // max(len(jobs), 1), 1)
    pool = ThreadPoolExecutor(workers, "gripscale", initializer=_serve, initargs=(stop, share))
    try:
        futures: dict[Future[T], int] = {
            pool.submit(job, stop): place for place, job in enumerate(jobs)
        }
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)


def _serve(stop: threading.Event, workers: int) -> None:
    """Tell `look` what ends the jobs of this thread, and how many threads each may use."""
    _here.stop = stop
    _here.workers = workers
