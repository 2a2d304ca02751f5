"""Who may use how many cores: a wave solved alone all of them, waves side by side their share."""

from __future__ import annotations

import threading
from contextlib import closing

import pytest

from gripscale.core.errors import InputError
from gripscale.core.parallel import cores, in_threads, sharing, worker_count
from gripscale.experiment import solve


def count(_: object = None) -> int:
    """Return what a solve that is not told otherwise would use."""
    return worker_count(None)


def test_what_is_asked_for_comes_before_all_else() -> None:
    before = count()
    with sharing(5):
        assert count() == 5
        assert worker_count(3) == 3
    assert count() == before


@pytest.mark.parametrize(
    ("jobs", "workers", "each"), [(1, 4, 4), (2, 4, 2), (3, 4, 1), (4, 4, 1), (9, 4, 1), (1, 1, 1)]
)
def test_jobs_side_by_side_share_the_workers(jobs: int, workers: int, each: int) -> None:
    with closing(in_threads([count] * jobs, workers)) as stream:
        assert [used for _, used in stream] == [each] * jobs


def test_a_share_is_that_of_one_thread() -> None:
    found: list[int] = []
    with sharing(1):
        other = threading.Thread(target=lambda: found.append(count()))
        other.start()
        other.join()
    assert found == [cores()]


def test_a_share_is_given_back_after_an_error() -> None:
    before = count()
    with pytest.raises(InputError), sharing(before + 1):
        worker_count(0)
    assert count() == before


def test_a_worker_of_a_cluster_uses_one_core() -> None:
    class Counting:
        def solve(self) -> int:
            return count()

    with sharing(7):
        assert solve._alone(Counting()) == 1  # type: ignore[arg-type,comparison-overlap]
