"""Who may use how many cores, and Ctrl-C while a result is written."""

import signal
import threading
from contextlib import closing
from dataclasses import dataclass

import numpy as np
import pytest
import xarray as xr

from gripscale import Rubber
from gripscale.core.errors import InputError
from gripscale.core.parallel import cores, held_back, in_threads, sharing, worker_count
from gripscale.experiment import solve
from gripscale.experiment.task import Task
from gripscale.io import netcdf
from gripscale.model import Load, Model
from gripscale.surface import Surface
from tests.samples import THREE_SINES


def count(_=None):
    """Return what a solve that is not told otherwise would use."""
    return worker_count(None)


def test_what_is_asked_for_comes_before_all_else():
    before = count()
    with sharing(5):
        assert count() == 5
        assert worker_count(3) == 3
    assert count() == before


@pytest.mark.parametrize(
    ("jobs", "workers", "each"), [(1, 4, 4), (2, 4, 2), (3, 4, 1), (4, 4, 1), (9, 4, 1), (1, 1, 1)]
)
def test_jobs_side_by_side_share_the_workers(jobs, workers, each):
    with closing(in_threads([count] * jobs, workers)) as stream:
        assert [used for _, used in stream] == [each] * jobs


@pytest.mark.parametrize(("at_once", "each"), [(1, 4), (2, 2), (4, 1)])
def test_fewer_jobs_at_once_have_more_workers_each(at_once, each):
    with closing(in_threads([count] * 5, 4, at_once)) as stream:
        assert [used for _, used in stream] == [each] * 5


@dataclass(frozen=True)
class Shared(Model):
    """Model that answers with the threads it may use."""

    threads: int
    name = "shared"

    def parts(self, surface):
        return self.threads

    def predict(self, rubber, surface, load, *, on_progress=None):
        return xr.Dataset({"used": count()})


@pytest.mark.parametrize(
    ("parts", "workers", "each"), [(1, 2, 1), (2, 2, 2), (2, 8, 2), (3, 2, 1), (4, 4, 4)]
)
def test_tasks_with_parts_leave_them_threads(parts, workers, each):
    loads = [Load(1e5, float(speed), 0.1) for speed in range(1, 10)]
    surface, model = Surface(THREE_SINES, ""), Shared(parts)
    tasks = {str(load): Task(Rubber(6e6), surface, load, model) for load in loads}
    answers = solve.Bench(None, workers).solve(tasks)
    assert [int(answer["used"]) for answer in answers.values()] == [each] * len(loads)


def test_a_share_is_that_of_one_thread():
    found = []
    with sharing(1):
        other = threading.Thread(target=lambda: found.append(count()))
        other.start()
        other.join()
    assert found == [cores()]


def test_a_share_is_given_back_after_an_error():
    before = count()
    with pytest.raises(InputError), sharing(before + 1):
        worker_count(0)
    assert count() == before


def test_a_worker_of_a_cluster_uses_one_core():
    class Counting:
        def solve(self):
            return count()

    with sharing(7):
        assert solve._alone(Counting()) == 1


# Ctrl-C while a result is written: the file is whole, and only then the interrupt acts.


def interrupt():
    signal.raise_signal(signal.SIGINT)


def test_interrupt_acts_when_the_block_is_left():
    done = []

    def work():
        with held_back():
            interrupt()
            done.append("the rest of the block")
        done.append("what follows")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert done == ["the rest of the block"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_nothing_is_raised_without_an_interrupt():
    with held_back():
        pass
    with pytest.raises(KeyboardInterrupt):
        interrupt()


def test_other_threads_are_left_alone():
    seen = []

    def work():
        with held_back():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [signal.default_int_handler]


def test_result_being_written_is_whole_and_the_next_one_does_not_wait(tmp_path, monkeypatch):
    data = xr.Dataset({"x": ("t", np.arange(3.0))})
    write = xr.Dataset.dump_to_store

    def interrupted(self, *args, **options):
        interrupt()
        return write(self, *args, **options)

    monkeypatch.setattr(xr.Dataset, "dump_to_store", interrupted)
    with pytest.raises(KeyboardInterrupt):
        netcdf.save(data, tmp_path / "a.nc")
    monkeypatch.undo()
    assert netcdf.load_dataset(tmp_path / "a.nc").equals(data)
    netcdf.save(data, tmp_path / "b.nc")
