"""Maps from files: text tables and points, instrument formats, and what is no map."""

import builtins

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.surface import clean

from .surface_cases import DATA

AL3D = DATA / "surfaces" / "al3d-1.al3d"
LINE = DATA / "surfaces" / "mitutoyo_2_mock.xlsx"
HEIGHTS = np.random.default_rng(0).standard_normal((20, 17))


def points(z=HEIGHTS, dx=0.5, dy=0.25):
    """Rows of x, y and z, x running fastest."""
    x, y = (d * np.arange(n) for n, d in zip(z.shape, (dx, dy), strict=True))
    return np.stack([*(a.T.ravel() for a in np.meshgrid(x, y, indexing="ij")), z.T.ravel()], axis=1)


def written(tmp_path, rows, name="map.xyz", **more):
    path = tmp_path / name
    np.savetxt(path, rows, **more)
    return path


def test_an_instrument_map():
    surface = gs.read_map(AL3D)
    assert surface.z.shape == (200, 296)
    assert surface.step == pytest.approx((87.6054e-6 / 200, 129.655992e-6 / 296), rel=1e-6)
    assert (surface.name, surface.source) == ("al3d-1", str(AL3D))
    for number in (0, 7, 199):
        one, other = surface.line(number, "y"), gs.read_profile(AL3D, direction="y", line=number)
        assert (one.name, one.source) == (other.name, other.source)
        np.testing.assert_array_equal(one.x, other.x)
        np.testing.assert_array_equal(one.z, other.z)
    assert gs.read_profile(AL3D).source.endswith("line 148 along x")
    line = gs.read_profile(LINE)
    assert (len(line), line.step) == (6664, pytest.approx(1.5e-6, rel=1e-6))
    levelled = [clean(line, spikes=None)[0].z for line in surface.lines()]
    assert 0.2e-6 < np.std(levelled) < 0.29e-6  # 0.29 um with one plane for all (SOURCE.txt)


@pytest.mark.parametrize("order", ["as written", "reversed", "shuffled"])
def test_points_in_any_order(tmp_path, order):
    rows = points()
    if order == "reversed":
        rows = rows[::-1]
    if order == "shuffled":
        rows = np.random.default_rng(1).permutation(rows)
    path = written(tmp_path, rows, header="x [mm]\ty [mm]\tz [um]", delimiter="\t")
    surface = gs.read_map(path)
    assert surface.step == pytest.approx((0.5e-3, 0.25e-3))
    np.testing.assert_allclose(surface.z, 1e-6 * HEIGHTS, rtol=1e-15)


def test_points_left_out_or_without_a_number_are_missing(tmp_path):
    rows = points()
    rows[30, 2] = np.nan
    path = written(tmp_path, np.delete(rows, [50, 51], axis=0))
    surface = gs.read_map(path, x_unit="mm", z_unit="um")
    missing = np.zeros(HEIGHTS.shape, dtype=bool)
    missing.T.flat[[30, 50, 51]] = True
    np.testing.assert_array_equal(np.isnan(surface.z), missing)


def test_rounded_distances_are_made_even(tmp_path):
    """A step of 37.5 um printed to the micrometre."""
    path = written(tmp_path, points(dx=0.0375, dy=0.0375), fmt="%.3f")
    surface = gs.read_map(path, x_unit="mm", z_unit="mm")
    # 19 and 16 steps, the last distance rounded by up to half a micrometre
    assert surface.step == pytest.approx((37.5e-6, 37.5e-6), abs=0.5e-6 / 16)
    assert np.ptp(np.diff(surface.x)) < 1e-15


def test_a_table_is_an_image_whose_rows_run_along_y(tmp_path):
    table = HEIGHTS.T.copy()
    table[3, 5] = np.nan
    path = written(tmp_path, table, "map.txt")
    surface = gs.read_map(path, step=(1e-4, 2e-4), z_unit="um")
    assert surface.z.shape == (20, 17)
    assert surface.step == pytest.approx((1e-4, 2e-4))
    assert np.isnan(surface.z[5, 3])
    assert surface.missing == 1
    assert surface.z[7, 2] == pytest.approx(1e-6 * HEIGHTS[7, 2])
    assert gs.read_map(path, step=1e-4, z_unit="um").step == pytest.approx((1e-4, 1e-4))


def test_arrays_need_steps_and_a_unit(tmp_path):
    path = tmp_path / "map.npy"
    np.save(path, HEIGHTS)
    surface = gs.read_map(path, step=(1e-4, 2e-4), z_unit="um")
    assert surface.step == pytest.approx((1e-4, 2e-4))
    np.testing.assert_allclose(surface.z, 1e-6 * HEIGHTS)
    with pytest.raises(FileError, match=r"map\.npy: expected a lateral size; the file gives none"):
        gs.read_map(path, z_unit="um")
    with pytest.raises(FileError, match="names no unit of length; give z_unit"):
        gs.read_map(path, step=1e-4)


def test_one_of_several_channels_must_be_named(tmp_path):
    path = tmp_path / "map.npz"
    np.savez(path, first=HEIGHTS, second=2.0 * HEIGHTS)
    given = {"step": 1e-4, "z_unit": "um"}
    with pytest.raises(FileError, match="one channel of heights; got 1 'first', 2 'second'; give"):
        gs.read_map(path, **given)
    for channel in ("second", 2):
        np.testing.assert_allclose(gs.read_map(path, channel=channel, **given).z, 2e-6 * HEIGHTS)
    with pytest.raises(InputError, match=r"must be one of 1 'first', 2 'second', .* got 'third'"):
        gs.read_map(path, channel="third", **given)


def test_missing_heights_and_units_of_an_instrument_file(tmp_path):
    """Written by SurfaceTopography itself, in micrometres."""
    from SurfaceTopography import Topography

    z = np.ma.masked_array(HEIGHTS, mask=HEIGHTS > 1.5)
    path = tmp_path / "map.x3p"
    Topography(z, (20.0, 34.0), unit="µm").to_x3p(str(path))
    surface = gs.read_map(path)
    assert surface.step == pytest.approx((1e-6, 2e-6))
    np.testing.assert_allclose(surface.z, np.where(HEIGHTS > 1.5, np.nan, 1e-6 * HEIGHTS))


FLAT = points()


@pytest.mark.parametrize(
    ("name", "rows", "given", "error", "words"),
    [
        ("m.xyz", FLAT, {}, FileError, "column 1 names no unit of length; .* give x_unit"),
        ("m.xyz", FLAT, {"x_unit": "mm"}, FileError, "column 3 names no unit of length; .*z_unit"),
        ("m.xyz", FLAT, {"step": 1e-4}, InputError, r"step must be left out; .*m\.xyz states"),
        ("m.txt", HEIGHTS, {}, FileError, r"m\.txt: a table of heights has no steps; give step"),
        ("m.txt", HEIGHTS, {"step": 1e-4}, FileError, "the table names no unit.*give z_unit"),
        ("m.txt", HEIGHTS[:, :9], {}, FileError, "line 1: expected three columns, .* got 9"),
        ("m.txt", FLAT[:, :2], {}, FileError, "got 2; a line of two columns .*read_profile"),
        ("m.xyz", FLAT[:20], {}, FileError, "at least 16 points a way; got 1 distances in col.* 2"),
        ("m.xyz", FLAT**2, {}, FileError, "at half the points .* got 20 of 362 in steps of 0.25: "),
        ("m.xyz", np.abs(FLAT) ** 1.5, {}, FileError,
         "in column 1 that increase in equal steps; got 0 then"),
        ("m.xyz", FLAT[[*range(340), 7]], {}, FileError, "line 341: .* got that of line 8 again"),
        ("m.xyz", FLAT * [1, np.nan, 1], {}, FileError, "line 1: expected a distance in column 2"),
        ("m.xyz", FLAT * [1, 1, np.nan], {}, FileError, "some heights; got 340 points, all missi"),
        ("m.txt", HEIGHTS * np.inf, {"step": 1e-4}, FileError, "m.txt: expected rows of heights"),
        ("m.txt", HEIGHTS, {"step": (1, 2, 3)}, InputError, "step must be one distance"),
        ("m.txt", HEIGHTS, {"step": 0.0}, InputError, "step must be greater than zero"),
        ("m.txt", HEIGHTS, {"step": "wide"}, InputError, "step must be a finite number"),
        ("m.txt", HEIGHTS, {"step": 1.0, "x_unit": "mm"}, InputError, "x_unit must be left out"),
        ("m.txt", HEIGHTS, {"z_unit": "furlong"}, InputError, "z_unit must be one of"),
        ("m.txt", HEIGHTS, {"reader": "magic"}, InputError, "reader must be one of"),
        ("m.al3d", FLAT, {"reader": "instrument"}, FileError, "names no unit of length"),
    ],
)  # fmt: skip
def test_what_is_no_map_is_refused(tmp_path, name, rows, given, error, words):
    units = {} if "names no unit" in words or "step" in given else {"x_unit": "mm", "z_unit": "mm"}
    with pytest.raises(error, match=words):
        gs.read_map(written(tmp_path, rows, name), **(units | given))


ODD = {
    "junk.sdf": bytes(range(256)) * 10,
    "cut.al3d": AL3D.read_bytes()[:3000],
    **dict.fromkeys(("empty.al3d", "empty.xlsx", "empty.npy"), b""),
}


@pytest.mark.parametrize(
    ("read", "path", "given", "words"),
    [
        (gs.read_map, LINE, {}, r"expected a map; got a line, which gripscale\.read_prof"),
        (gs.read_map, AL3D, {"step": 1e-6}, r"step must be left out; .*al3d states the size"),
        (gs.read_map, AL3D, {"x_unit": "mm"}, r"x_unit is 'mm', but .* says 'm'"),
        (gs.read_map, "nowhere.xyz", {}, "no such file"),
        (gs.read_map, "", {}, "a directory"),
        (gs.read_map, 3, {}, "path must be the path of a file; got 3"),
        (gs.read_map, "narrow.npy", {"step": 1e-4, "z_unit": "um"},
         r"narrow\.npy: a map must have at least 16 points a way"),
        (gs.read_profile, LINE, {"direction": "y"}, "single line"),
        (gs.read_profile, LINE, {"direction": "z"}, "direction must be one of x, y"),
        (gs.read_profile, AL3D, {"line": 296}, "from 0 to 295"),
        (gs.read_profile, AL3D, {"x_unit": "mm"}, "x_unit is 'mm'"),
        (gs.read_profile, "junk.sdf", {}, r"junk\.sdf: expected a map with the number NumPoints"),
        (gs.read_profile, "cut.al3d", {}, r"al3d: .* got 3000 bytes in none of these formats, or"),
        *((gs.read_profile, name, {}, "empty file") for name in [*ODD][2:]),
        *((gs.read_profile, f"no{name}", {}, "no such file") for name in ODD),
        (gs.read_profile, "", {}, "got a directory"),
        (gs.read_profile, "road\0.dat", {}, "cannot be read"),
        (gs.read_profile, 12, {}, "path must be"),
    ],
)  # fmt: skip
def test_files_of_other_kinds_are_refused(tmp_path, read, path, given, words):
    for name, content in ODD.items():
        (tmp_path / name).write_bytes(content)
    np.save(tmp_path / "narrow.npy", HEIGHTS[:, :1])
    with pytest.raises((FileError, InputError), match=words):
        read(tmp_path / path if isinstance(path, str) else path, **given)


def test_without_the_extra_the_message_names_it(monkeypatch):
    real = builtins.__import__

    def without(name, *args, **kwargs):
        if name.startswith("SurfaceTopography"):
            raise ModuleNotFoundError(name, name=name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(FileError, match=r"pip install 'gripscale\[formats\]'"):
        gs.read_map(AL3D)
