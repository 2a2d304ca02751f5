"""The one thread that reads files and prepares cases beside the page.

One, because the library under netCDF must not be entered by two threads.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")

_ONE = ThreadPoolExecutor(1, thread_name_prefix="beside the page")


async def beside(work: Callable[[], T]) -> T:
    """Return what `work` returns; the page stays alive meanwhile."""
    return await asyncio.get_running_loop().run_in_executor(_ONE, work)


def in_turn(work: Callable[[], T]) -> T:
    """Return what `work` returns, once the thread has come to it; the page waits."""
    return _ONE.submit(work).result()
