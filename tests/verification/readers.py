"""Every reader of files with a small file it reads, and what anything it returns must be."""

import io
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import gripscale as gs
from gripscale.case_file import read_case_file
from gripscale.experiment.measured_friction import MeasuredFriction, read_measured_friction
from gripscale.io import netcdf
from tests.samples import EXAMPLES

DATA = EXAMPLES / "data"
HEIGHTS = np.random.default_rng(7).normal(size=(18, 17)).round(3)
LINE = HEIGHTS.ravel()[:40]
STEPS = np.arange(40)


@dataclass(frozen=True)
class Reader:
    """A reader, a file it reads, what its answers must be, and how often it takes its turn."""

    name: str
    suffix: str
    content: bytes
    read: Callable[[Path], Any]
    check: Callable[[Any], None]
    turns: int = 20


def text(titles: str, *columns: Any, separator: str = "\t") -> bytes:
    """Return a table as a text file."""
    rows = ([f"{value:.10g}" for value in row] for row in zip(*columns, strict=True))
    return "\n".join([titles, *(separator.join(row) for row in rows), ""]).encode()


def points() -> bytes:
    x, y = (0.5 * a.ravel() for a in np.indices(HEIGHTS.shape))
    return text("x [mm]\ty [mm]\tz [um]", x, y, HEIGHTS.ravel())


def captif() -> bytes:
    path = DATA / "road/20211011_aylesbury_dec_station_0.dat"
    return b"\n".join(path.read_bytes().split(b"\n")[:80])


def sdf() -> bytes:
    """Return a map in the text form of ISO 25178-71."""
    columns, rows = HEIGHTS.shape
    head = [
        *("aISO-1.0", "ManufacID = none", "CreateDate = 010120260000", "ModDate = 010120260000"),
        *(f"NumPoints = {columns}", f"NumProfiles = {rows}", "Xscale = 1e-06", "Yscale = 2e-06"),
        *("Zscale = 1e-06", "Zresolution = -1", "Compression = 0", "DataType = 7", "CheckType = 0"),
    ]
    heights = (f"{value:g}" for value in HEIGHTS.T.ravel())
    return "\n".join([*head, "*", *heights, "*", ""]).encode()


def al3d() -> bytes:
    """Return a map as Alicona instruments write it."""
    columns, rows = HEIGHTS.shape
    tags = [
        *(("Version", "1"), ("TagCount", "8"), ("TextureImageOffset", "0")),
        *(("DepthImageOffset", "1024"), ("PixelSizeXMeter", "1e-6"), ("PixelSizeYMeter", "2e-6")),
        *(("InvalidPixelValue", "1e30"), ("Cols", str(columns)), ("Rows", str(rows))),
        ("NumberOfPlanes", "0"),
    ]
    head = b"AliconaImaging\0\r\n" + b"".join(
        key.encode().ljust(20, b"\0") + value.encode().ljust(30, b"\0") + b"\r\n"
        for key, value in tags
    )
    padded = np.zeros((rows, -(-columns * 4 // 8) * 2), dtype="<f4")
    padded[:, :columns] = 1e-6 * HEIGHTS.T
    return head.ljust(1024, b"\0") + padded.tobytes()


def x3p(folder: Path) -> bytes:
    with warnings.catch_warnings():  # of its own dependencies, at the first import
        warnings.simplefilter("ignore")
        from SurfaceTopography import Topography

    path = folder / "map.x3p"
    Topography(HEIGHTS, (18.0, 17.0), unit="µm").to_x3p(str(path))
    return path.read_bytes()


def npy() -> bytes:
    stream = io.BytesIO()
    np.save(stream, HEIGHTS)
    return stream.getvalue()


def workbook(**sheets: Any) -> bytes:
    """Return an xlsx file of sheets, each rows of cells."""
    import openpyxl

    book, stream = openpyxl.Workbook(), io.BytesIO()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(stream)
    return stream.getvalue()


def mitutoyo() -> bytes:
    """Return a line as SurfTest testers write it: distances and heights in columns E and F."""
    words = iter(["Ra     3.308  µm      "])
    rows = [[next(words, None), *[None] * 3, 1.5e-3 * (i + 1), z] for i, z in enumerate(LINE)]
    certificate = [[] for _ in range(48)]
    certificate[1] = [None] * 4 + ["20- Jun -2023"]
    certificate[47] = [None] * 4 + ["2.5mm"]
    return workbook(Certificate=certificate, DATA=rows)


def result(folder: Path) -> bytes:
    waves = np.geomspace(1e-2, 1e-4, 5)
    data = xr.Dataset(
        {"friction": ("scale", 0.1 * np.arange(5.0)), "status": ((), "converged")},
        {"wavelength": ("scale", waves)},
        {"title": "waves"},
    )
    path = netcdf.save(data, folder / "result.nc", {"group": data})
    return path.read_bytes()


def curve() -> bytes:
    f = np.geomspace(1e-2, 1e6, 20)
    return text("f [Hz]\tE' [MPa]\tE'' [MPa]", f, 2.0 + np.log10(f) ** 2, 0.3 + 0.0 * f)


def friction() -> bytes:
    titles = "speed [mm/s];friction;spread;temperature [C]"
    speeds = np.geomspace(0.1, 100.0, 7)
    same = np.ones(7)
    return text(titles, speeds, 0.5 + 0.0 * speeds, 0.1 * same, 23.5 * same, separator=";")


def check_line(profile: gs.Profile) -> None:
    assert profile.x.shape == profile.z.shape
    assert profile.x.ndim == 1
    assert np.isfinite(profile.x).all()
    assert (np.diff(profile.x) > 0.0).all()
    assert not np.isinf(profile.z).any()
    assert np.isfinite(profile.z).any()


def check_map(surface: gs.HeightMap) -> None:
    assert surface.z.shape == (surface.x.size, surface.y.size)
    assert (np.diff(surface.x) > 0.0).all()
    assert (np.diff(surface.y) > 0.0).all()
    assert not np.isinf(surface.z).any()
    assert np.isfinite(surface.z).any()


def check_curve(curve: gs.MasterCurve) -> None:
    columns = np.array([curve.frequency, curve.storage, curve.loss])
    assert np.isfinite(columns).all()
    assert (columns > 0.0).all()
    assert (np.diff(curve.frequency) >= 0.0).all()


def check_friction(measured: MeasuredFriction) -> None:
    assert (measured.speed > 0.0).all()
    assert np.isfinite([measured.speed, measured.friction]).all()
    assert not (measured.spread < 0.0).any()
    assert not (measured.temperature <= 0.0).any()
    assert not np.isinf([measured.spread, measured.temperature]).any()


def check_case(file: Any) -> None:
    load = file.case.load
    numbers = [load.pressure, load.speed, load.footprint]
    assert np.isfinite(numbers).all()
    assert min(numbers[0], numbers[2]) > 0.0
    assert load.speed >= 0.0


def same_as(good: xr.Dataset) -> Callable[[xr.Dataset], None]:
    """Return a check that a result is read as it was written."""

    def check(found: xr.Dataset) -> None:
        assert found.identical(good)

    return check


def readers(folder: Path) -> list[Reader]:
    """Return all of them; `folder` is for files only a library can write."""
    (folder / "result.nc").write_bytes(result(folder))
    good, tree = (read(folder / "result.nc") for read in (netcdf.load_dataset, netcdf.load_tree))
    mm = {"x_unit": "mm", "z_unit": "um"}
    table = text("", *HEIGHTS.T).lstrip()
    bare = text("", STEPS, LINE, separator=";").lstrip()
    case = EXAMPLES / "road_and_tread/case.toml"
    waves = EXAMPLES / "three_waves/case.toml"
    line, surface = check_line, check_map
    step = {"step": 1e-4, "z_unit": "um"}
    return [
        Reader("profile", ".csv", text("x [mm]\tz [um]", STEPS, LINE), gs.read_profile, line, 40),
        Reader("bare profile", ".txt", bare, partial(gs.read_profile, **mm), line, 40),
        Reader("captif", ".dat", captif(), gs.read_profile, line, 40),
        Reader("points", ".xyz", points(), gs.read_map, surface, 10),
        Reader("table", ".txt", table, partial(gs.read_map, **step), surface, 15),
        Reader("curve", ".csv", curve(), gs.read_master_curve, check_curve, 60),
        Reader("friction", ".csv", friction(), read_measured_friction, check_friction, 60),
        Reader("case", ".toml", case.read_bytes(), read_case_file, check_case, 60),
        Reader("waves", ".toml", waves.read_bytes(), read_case_file, check_case, 60),
        Reader("result", ".nc", result(folder), netcdf.load_dataset, same_as(good), 40),
        Reader("tree", ".nc", result(folder), netcdf.load_tree, same_as(tree), 20),
        Reader("x3p", ".x3p", x3p(folder), gs.read_map, surface, 2),
        Reader("al3d", ".al3d", al3d(), gs.read_map, surface, 4),
        Reader("sdf", ".sdf", sdf(), gs.read_map, surface, 4),
        Reader("npy", ".npy", npy(), partial(gs.read_map, **step), surface, 2),
        Reader("xyz line", ".xyz", bare, partial(gs.read_profile, **mm), line, 6),
        Reader("mitutoyo", ".xlsx", mitutoyo(), gs.read_profile, line, 1),
    ]
