"""Ctrl-C while a result is written: the file is whole, and only then the interrupt acts."""

import signal
import threading

import numpy as np
import pytest
import xarray as xr

from gripscale.core.parallel import held_back
from gripscale.io import netcdf


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
