"""Surfaces in the layouts of instruments: read right, or refused with the option that cures it."""

import time

import numpy as np
import openpyxl
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError

STEP = 50e-6
HEIGHTS = 1e-3 * np.sin(np.arange(200) / 7.0)
"""Heights of a profile [m], printed in mm with four decimals: right to half of 1e-7."""
MAP = np.round(1e4 * np.random.default_rng(2).standard_normal((24, 18)))
"""Counts of a map, of 24 points along x."""


def test_a_profile_in_a_workbook(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["Distance [mm]", "Height [um]"])
    for i, height in enumerate(HEIGHTS):
        sheet.append([1e3 * STEP * i, 1e6 * height])
    book.save(tmp_path / "road.xlsx")
    profile = gs.read_profile(tmp_path / "road.xlsx")
    assert profile.step == pytest.approx(STEP)
    np.testing.assert_allclose(profile.z, HEIGHTS, atol=0.5001e-7)


@pytest.mark.parametrize("decimal", [".", ","])
@pytest.mark.parametrize("title", ["", "Height (mm)\n"])
def test_one_column_of_heights_needs_its_step(tmp_path, title, decimal):
    path = tmp_path / "line.txt"
    body = [f"{1e3 * height:.4f}".replace(".", decimal) for height in HEIGHTS]
    body[3] = "nan"
    path.write_text(title + "\n".join(body))
    with pytest.raises(FileError, match="got one column of numbers: give step, the dist") as caught:
        gs.read_profile(path)
    assert caught.value.missing == "step"
    profile = gs.read_profile(path, step=STEP, z_unit=None if title else "mm")
    assert profile.step == pytest.approx(STEP)
    expected = np.where(np.arange(200) == 3, np.nan, HEIGHTS)
    np.testing.assert_allclose(profile.z, expected, atol=0.5001e-7)


def test_a_step_beside_distances_is_refused(tmp_path):
    path = tmp_path / "road.csv"
    path.write_text("x [mm];z [mm]\n" + "\n".join(f"{0.05 * i:.2f};1" for i in range(20)))
    with pytest.raises(InputError, match=r"step must be left out; .* states where its points are"):
        gs.read_profile(path, step=STEP)


HEADER = """\
aISO-1.0
ManufacID   = HOUSE
NumPoints   = 24
NumProfiles = 18
Xscale      = 1.5e-6
Yscale      = 2.5e-6
Zscale      = 1e-9
Compression = 0
DataType    = 6
CheckType   = 0
*
"""


@pytest.mark.parametrize("width", [1, 3, 24])
@pytest.mark.parametrize("sign", ["=", ":", " "])
def test_a_map_in_sdf_has_its_lengths_in_its_header(tmp_path, width, sign):
    """Profile by profile along x; lines of three counts look like points to other readers."""
    counts = [f"{count:g}" for count in MAP.T.ravel()]
    counts[30] = "BAD"  # point 6 of the second profile
    body = [" ".join(counts[i : i + width]) for i in range(0, len(counts), width)]
    path = tmp_path / "map.sdf"
    path.write_text(HEADER.replace("=", sign) + "\n".join(body) + "\n*\n")
    surface = gs.read_map(path)
    assert surface.step == pytest.approx((1.5e-6, 2.5e-6))
    expected = 1e-9 * MAP
    expected[6, 1] = np.nan
    np.testing.assert_allclose(surface.z, expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("Xscale      = 1.5e-6\n", "", "the number Xscale in its header; got none"),
        ("1.5e-6", "wide", "the number Xscale in its header; got 'wide'"),
        ("2.5e-6", "0", "expected Yscale finite and above zero"),
        ("2.5e-6", "2e666", "expected Yscale finite and above zero"),
        ("2.5e-6", f"1{400 * '0'}", r"Yscale finite and above zero; got 10{,120}\.\.\.$"),
        ("= 24", "= 25", "expected 25 x 18 heights by its header; got 432"),
        ("= 18", "= 17.5", "expected a whole number as NumProfiles; got 17.5"),
    ],
)
def test_a_faulty_sdf_is_refused_at_once(tmp_path, old, new, words):
    path = tmp_path / "map.sdf"
    body = "\n".join(f"{count:g}" for count in np.tile(MAP.T.ravel(), 1))
    path.write_text(HEADER.replace(old, new) + body)
    start = time.perf_counter()
    with pytest.raises(FileError, match=words):
        gs.read_map(path)
    assert time.perf_counter() - start < 1.0
