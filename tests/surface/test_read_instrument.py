import builtins

import numpy as np
import pytest

from gripscale.core.errors import FileError, InputError
from gripscale.surface import clean, read_map, read_profile

from .surface_cases import DATA

MAP = DATA / "surfaces" / "al3d-1.al3d"
LINE = DATA / "surfaces" / "mitutoyo_2_mock.xlsx"


def test_line_scan_has_its_certified_roughness():
    profile = read_profile(LINE)
    assert len(profile) == 6664
    assert profile.step == pytest.approx(1.5e-6, rel=1e-6)
    levelled, _ = clean(profile, spikes=None)
    # The file certifies Rq = 3.959 um; the instrument's filter is not applied here, for which
    # half a per cent is allowed. A wrong unit, step or line is off by far more.
    assert np.sqrt(np.mean(levelled.z**2)) == pytest.approx(3.959e-6, rel=5e-3)


def test_map_gives_profiles_along_both_directions():
    along_x = read_map(MAP).lines()
    along_y = read_map(MAP).lines("y")
    assert (len(along_x), len(along_x[0])) == (296, 200)
    assert (len(along_y), len(along_y[0])) == (200, 296)
    assert along_x[0].length == pytest.approx(199 / 200 * 87.6054e-6, rel=1e-6)
    assert along_y[0].length == pytest.approx(295 / 296 * 129.655992e-6, rel=1e-6)
    assert along_x[7].z[11] == along_y[11].z[7]
    assert read_profile(MAP).source.endswith("line 148 along x")
    assert np.array_equal(read_profile(MAP, line=3).z, along_x[3].z)


def test_map_has_its_documented_roughness():
    z = np.array([profile.z for profile in read_map(MAP).lines()])
    rows, columns = np.indices(z.shape)
    plane = np.stack([rows.ravel(), columns.ravel(), np.ones(z.size)], axis=1)
    rest = z.ravel() - plane @ np.linalg.lstsq(plane, z.ravel(), rcond=None)[0]
    assert rest.std() == pytest.approx(0.29e-6, abs=0.005e-6)  # SOURCE.txt, two digits


def test_wrong_use_is_refused(tmp_path):
    with pytest.raises(InputError, match="single line"):
        read_profile(LINE, direction="y")
    with pytest.raises(InputError, match="from 0 to 295"):
        read_profile(MAP, line=296)
    with pytest.raises(InputError, match=r"x_unit is 'mm'"):
        read_profile(MAP, x_unit="mm")
    junk = tmp_path / "junk.sdf"
    junk.write_bytes(bytes(range(256)) * 10)
    with pytest.raises(FileError, match=r"junk\.sdf: expected a map with the number NumPoints"):
        read_profile(junk)
    cut = tmp_path / "cut.al3d"
    cut.write_bytes(MAP.read_bytes()[:3000])
    with pytest.raises(
        FileError, match=r"cut\.al3d: .* got 3000 bytes in none of these formats, or"
    ):
        read_profile(cut)


@pytest.mark.parametrize("suffix", [".al3d", ".xlsx", ".npy"])
def test_empty_and_missing_instrument_files(tmp_path, suffix):
    path = tmp_path / f"surface{suffix}"
    with pytest.raises(FileError, match="no such file"):
        read_profile(path)
    path.touch()
    with pytest.raises(FileError, match="empty file"):
        read_profile(path)


def test_text_of_bare_points_needs_units_and_equal_steps(tmp_path):
    heights = np.random.default_rng(0).standard_normal(30)
    path = tmp_path / "line.xyz"
    np.savetxt(path, np.c_[0.5 * np.arange(30), heights])
    with pytest.raises(FileError, match="names no unit of length"):
        read_profile(path)
    profile = read_profile(path, x_unit="um", z_unit="nm")
    assert profile.step == pytest.approx(0.5e-6)
    assert profile.z == pytest.approx(1e-9 * heights)
    np.savetxt(path, np.c_[1.5 ** np.arange(30), heights])
    with pytest.raises(FileError, match=r"line\.xyz, line 2: expected distances in column 1"):
        read_profile(path, x_unit="um", z_unit="nm")


def test_a_map_without_lateral_size_is_refused(tmp_path):
    path = tmp_path / "map.npy"
    np.save(path, np.random.default_rng(0).standard_normal((20, 30)))
    with pytest.raises(FileError, match=r"map\.npy: expected a lateral size"):
        read_profile(path)


def test_without_the_extra_the_message_names_it(monkeypatch):
    real = builtins.__import__

    def without(name, *args, **kwargs):
        if name.startswith("SurfaceTopography"):
            raise ModuleNotFoundError(name, name=name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(FileError, match=r"gripscale\[formats\]"):
        read_profile(MAP)
