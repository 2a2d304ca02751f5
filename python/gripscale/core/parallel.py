"""Threads for independent tasks, and interrupts held back while a file is written.

xarray guards its files with one lock for all: an interrupt that arrives while it is taken would
leave it taken, and the next file would wait for ever.
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
    """Delay an interrupt from the keyboard to the end of the block."""
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


_T = TypeVar("_T")
# Solves one task; stops between two steps once the event is set.
Job = Callable[[threading.Event], _T]
_here = threading.local()


class Stopped(Exception):
    """A job ended because the caller stopped it."""


def look() -> None:
    """Raise `Stopped` if the job of this thread is to end; do nothing in other threads."""
    stop = getattr(_here, "stop", None)
    if stop is not None and stop.is_set():
        raise Stopped


@contextmanager
def sharing(workers: int) -> Iterator[None]:
    """Limit solves on this thread to `workers` threads, because other solves run concurrently."""
    before = getattr(_here, "workers", None)
    _here.workers = workers
    try:
        yield
    finally:
        _here.workers = before


def cores() -> int:
    """Return the number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def worker_count(workers: int | None) -> int:
    """Return `workers`, by default one per core or the share of `in_threads` and `sharing`."""
    if workers is not None:
        return checks.whole("workers", workers, least=1, most=1024)
    share: int | None = getattr(_here, "workers", None)
    return cores() if share is None else share


def in_threads(
    jobs: Sequence[Job[_T]], workers: int, at_once: int | None = None
) -> Generator[tuple[int, _T], None, None]:
    """Yield the index and the result of each job in the order of completion.

    Up to `at_once` jobs, by default as many as workers, run together and share the workers. After
    an error, Ctrl-C or `close`, the event of the other jobs is set, `look` raises in their threads,
    and the running ones are awaited.
    """
    stop = threading.Event()
    at_once = max(min(at_once or workers, len(jobs)), 1)
    share = max(workers // at_once, 1)

    def start_thread() -> None:
        _here.stop, _here.workers = stop, share

    pool = ThreadPoolExecutor(at_once, "gripscale", initializer=start_thread)
    try:
        futures: dict[Future[_T], int] = {
            pool.submit(job, stop): index for index, job in enumerate(jobs)
        }
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)


def all_results(jobs: Sequence[Job[_T]], workers: int) -> list[_T]:
    """Return the results of jobs in their order, solved as by `in_threads`."""
    done = dict(in_threads(jobs, workers))
    return [done[index] for index in range(len(jobs))]
