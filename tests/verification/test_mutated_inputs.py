"""Two hundred thousand damaged files: each is read as something sane or refused in one sentence.

Never another exception, a warning, a wait or memory beyond reason. `GRIPSCALE_MUTATIONS` sets the
number of files, `GRIPSCALE_SEED` where they begin: a failure names the seed of its file.
"""

import contextlib
import os
import random
import resource
import signal
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from gripscale.core.errors import FileError, InputError
from tests.verification.mutations import mutated
from tests.verification.readers import Reader, readers

SEED = int(os.environ.get("GRIPSCALE_SEED", "0"))
MANY = int(os.environ.get("GRIPSCALE_MUTATIONS", "200000"))
FEW = 700
LONGEST = 2.0
"""Seconds of a processor a file may take."""
MEMORY = 1 << 30
"""Bytes beyond those at the start that reading may ask for."""
LONGEST_SENTENCE = 500


class TookTooLong(BaseException):
    """Not an Exception, which a reader might catch."""


@contextlib.contextmanager
def bounded() -> Iterator[None]:
    """Hold what runs inside to `MEMORY`, where the system can, and let alarms interrupt it."""

    def late(*_: object) -> None:
        raise TookTooLong

    before = resource.getrlimit(resource.RLIMIT_AS)
    handler = signal.signal(signal.SIGPROF, late)
    if sys.platform == "linux":
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        used = pages * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, before[1]))
    try:
        yield
    finally:
        signal.signal(signal.SIGPROF, handler)
        resource.setrlimit(resource.RLIMIT_AS, before)


def fault(reader: Reader, path: Path) -> str | None:
    """Return what is wrong with how a file is read, None if nothing is; and count refusals."""
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        found = reader.read(path)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        reader.check(found)
    except (InputError, FileError) as error:
        said = str(error).replace(str(path), "file")
        if not said.isprintable() or len(said) > LONGEST_SENTENCE:
            return f"no sentence: {said[:3000]!r}"
        return ""
    except TookTooLong:
        return f"longer than {LONGEST} s"
    except BaseException as error:
        return f"{type(error).__name__}: {str(error)[:300]}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    return None


def attacked(folder: Path, times: int) -> tuple[Counter[str], list[str]]:
    """Return how often each reader refused, and every fault with the seed that repeats it."""
    known = readers(folder)
    for reader in known:
        path = folder / f"sound{reader.suffix}"
        path.write_bytes(reader.content)
        reader.check(reader.read(path))
    turns = [reader for reader in known for _ in range(reader.turns)]
    refused, faults = Counter[str](), []
    with bounded():
        for seed in range(SEED, SEED + times):
            chance = random.Random(seed)
            reader = chance.choice(turns)
            path = folder / f"file{reader.suffix}"
            path.write_bytes(mutated(reader.content, chance))
            found = fault(reader, path)
            refused[reader.name] += found == ""
            if found:
                faults.append(f"seed {seed}, {reader.name}: {found}")
    return refused, faults


def judged(folder: Path, times: int) -> None:
    refused, faults = attacked(folder, times)
    assert not faults, f"{len(faults)} of {times}:\n" + "\n".join(faults[:20])
    assert 0.4 * times < refused.total() < times
    assert min(refused.values()) > 0


def test_a_sample_of_damaged_files(tmp_path: Path) -> None:
    judged(tmp_path, FEW)


@pytest.mark.verification
def test_damaged_files(tmp_path: Path) -> None:
    judged(tmp_path, MANY)
