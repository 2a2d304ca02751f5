"""Result files on disk: what was written is read, and nothing else."""

import random
import shutil
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from gripscale.core.errors import FileError
from gripscale.io import netcdf

DATA = xr.Dataset({"friction": ("scale", np.arange(5.0))}, attrs={"title": "waves"})


@pytest.fixture
def path(tmp_path):
    return netcdf.save(DATA, tmp_path / "result.nc", {"group": DATA})


def refused(path):
    for read in (netcdf.load_dataset, netcdf.load_tree):
        with pytest.raises(FileError, match=r"result\.nc cannot be read as a netCDF result"):
            read(path)


def test_any_byte_changed_is_seen(path):
    """HDF5 alone reads one of six hundred such files as other numbers."""
    sound, chance = path.read_bytes(), random.Random(1)
    for at in [*range(60), *(chance.randrange(len(sound)) for _ in range(200)), len(sound) - 1]:
        damaged = bytearray(sound)
        damaged[at] ^= 1 << chance.randrange(8)
        path.write_bytes(damaged)
        refused(path)


@pytest.mark.parametrize("change", ["cut", "half the seal", "more", "twice", "a bit lost"])
def test_another_length(path, change):
    sound = path.read_bytes()
    path.write_bytes(
        {
            "cut": sound[: len(sound) // 2],
            "half the seal": sound[:-30],
            "more": sound + b"\n",
            "twice": 2 * sound,
            "a bit lost": sound[:3000] + sound[3001:],
        }[change]
    )
    refused(path)


def test_files_from_elsewhere_have_no_seal(path, tmp_path):
    other = tmp_path / "other.nc"
    DATA.to_netcdf(other, engine=netcdf.ENGINE)
    assert netcdf.load_dataset(other).identical(DATA)
    assert xr.load_dataset(path, engine=netcdf.ENGINE).identical(DATA)


def test_a_result_changed_on_purpose(path):
    """Another program that writes to the file takes the seal off."""
    import netCDF4

    with netCDF4.Dataset(path, "a") as file:
        file.title = "a longer title, written by hand"
        file["friction"][0] = 7.0
    found = netcdf.load_dataset(path)
    assert found.title.endswith("by hand")
    assert found.friction[0] == 7.0


def test_a_full_disk_is_a_sentence_whatever_the_library_raises(tmp_path, monkeypatch):
    """HDF5 raises a RuntimeError, Matplotlib an AttributeError; what was there stays whole."""
    path = netcdf.save(xr.Dataset({"a": 1.0}), tmp_path / "a.nc")
    before = path.read_bytes()

    def write(temporary):
        temporary.write_bytes(b"half")
        raise RuntimeError("NetCDF: HDF error")

    with pytest.raises(RuntimeError, match="HDF error"):  # no full disk: a defect to be seen
        netcdf.write_whole(path, write)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: SimpleNamespace(free=0))
    with pytest.raises(FileError, match=r"a\.nc cannot be written: the disk is full"):
        netcdf.write_whole(path, write)
    assert path.read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == ["a.nc"]
