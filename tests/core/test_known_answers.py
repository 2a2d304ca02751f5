"""Changes of a file whose right answer is known: the values are the right ones, or refused."""

import re

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.experiment.measured_friction import read_measured_friction
from tests.verification import readers as sound

PROFILE = sound.text("x [mm]\tz [um]", sound.STEPS, sound.LINE).decode()
POINTS = sound.points().decode()
CURVE = sound.curve().decode()
FRICTION = sound.friction().decode()
PLACES = [0, 1, 17, 39]
METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9, "in": 0.0254}

SAME_TEXT = {
    "utf-16": lambda text: text.encode("utf-16"),
    "decimal commas": lambda text: text.replace(".", ","),
    "decimal commas and semicolons": lambda text: text.replace("\t", ";").replace(".", ","),
    "a comment": lambda text: text.replace("\n", "\n# 1 2 3\n", 1),
    "columns from right to left": lambda text: "\n".join(
        re.sub(r"[^\t;]+", "{}", line).format(*re.findall(r"[^\t;]+", line)[::-1])
        for line in text.split("\n")
    ),
}
REFUSED_TEXT = {
    "thousands ill parted": lambda text: changed(text, 5, -1, "1,23.5"),
    "one decimal comma": lambda text: changed(text, 5, -1, "1,5"),
    "beyond floating point": lambda text: changed(text, 5, -1, "1e400"),
    "beyond reason": lambda text: changed(text, 5, -1, "1e101"),
    "400 digits": lambda text: changed(text, 5, -1, "9" * 400),
    "a cell more": lambda text: changed(text, 5, -1, "1.5\t1.5"),
    "a NUL": lambda text: text.replace("\n", "\n\0", 1),
    "another unit": lambda text: text.replace("[", "[ell", 1),
    "a first line lost within": lambda text: text.replace("]", "", 1),
}


def changed(text, row, cell, new):
    """Return a file with one cell of a row, counted without the titles, replaced."""
    lines = text.split("\n")
    separator = "\t" if "\t" in lines[0] else ";"
    cells = lines[row + 1].split(separator)
    cells[cell] = new
    lines[row + 1] = separator.join(cells)
    return "\n".join(lines)


def of_profile(path):
    profile = gs.read_profile(path)
    return np.array([profile.x, profile.z])


def of_points(path):
    surface = gs.read_map(path)
    return np.concatenate([surface.x, surface.y, surface.z.ravel()])


def of_curve(path):
    curve = gs.read_master_curve(path)
    return np.array([curve.frequency, curve.storage, curve.loss])


def of_friction(path):
    found = read_measured_friction(path)
    return np.array([found.speed, found.friction, found.spread, found.temperature])


READERS = {
    "profile": (PROFILE, of_profile),
    "points": (POINTS, of_points),
    "curve": (CURVE, of_curve),
    "friction": (FRICTION, of_friction),
}


@pytest.fixture
def read(tmp_path):
    def with_reader(name, content):
        path = tmp_path / f"{name}.csv"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return READERS[name][1](path)

    return with_reader


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("change", SAME_TEXT)
def test_the_same_in_other_words(read, name, change):
    text = READERS[name][0]
    np.testing.assert_allclose(read(name, SAME_TEXT[change](text)), read(name, text), rtol=1e-15)


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("change", REFUSED_TEXT)
def test_what_has_no_one_meaning(read, name, change):
    with pytest.raises((FileError, InputError)):
        read(name, REFUSED_TEXT[change](READERS[name][0]))


@pytest.mark.parametrize("unit", METRES)
def test_units_of_length(read, unit):
    x, z = read("profile", PROFILE.replace("[mm]", f"[{unit}]"))
    assert x == pytest.approx(METRES[unit] * sound.STEPS, rel=1e-14)
    assert z == pytest.approx(1e-6 * sound.LINE, rel=1e-14)
    whole = read("points", POINTS.replace("z [um]", f"z [{unit}]"))
    assert whole[-sound.HEIGHTS.size :] == pytest.approx(METRES[unit] * sound.HEIGHTS.ravel())


def test_units_of_a_curve(read):
    frequency, storage, loss = read("curve", CURVE)
    turned = read("curve", CURVE.replace("[Hz]", "[rad/s]"))
    assert turned[0] == pytest.approx(frequency / (2.0 * np.pi), rel=1e-14)
    shear = read("curve", CURVE.replace("E'", "G'").replace("[MPa]", "[kPa]"))
    assert shear[1:] == pytest.approx(3e-3 * np.array([storage, loss]), rel=1e-14)
    for at, title in enumerate(("E' [MPa]", "E'' [MPa]")):
        with pytest.raises(InputError):
            read("curve", CURVE.replace(f"\t{title}", f"\t{title.replace('E', 'G')}"))
        scaled = np.array([storage, loss])
        scaled[at] *= 1e-3
        kilo = read("curve", CURVE.replace(f"\t{title}", f"\t{title.replace('M', 'k')}"))
        assert kilo[1:] == pytest.approx(scaled, rel=1e-14)
    lines = CURVE.strip().split("\n")
    assert (read("curve", "\n".join([lines[0], *lines[:0:-1]])) == [frequency, storage, loss]).all()


def test_units_of_friction(read):
    speed, *_, kelvin = read("friction", FRICTION)
    other = read("friction", FRICTION.replace("[mm/s]", "[km/h]").replace("[C]", "[K]"))
    assert other[0] == pytest.approx(speed * 1e3 / 3.6, rel=1e-14)
    assert other[3] == pytest.approx(kelvin - 273.15, rel=1e-12)


@pytest.mark.parametrize("code", ["-9999", "9999", "-32768", "999999", "-99999.0", "1e38"])
@pytest.mark.parametrize("row", PLACES)
def test_codes_of_missing_values(read, code, row):
    x, z = read("profile", changed(PROFILE, row, 1, code))
    assert np.isnan(z).nonzero()[0].tolist() == [row]
    assert np.delete(z, row) == pytest.approx(np.delete(1e-6 * sound.LINE, row))
    assert x == pytest.approx(1e-3 * sound.STEPS)
    whole = read("points", changed(POINTS, row, 2, code))[-sound.HEIGHTS.size :]
    assert np.isnan(whole).nonzero()[0].tolist() == [row]
    for cell in (1, 2, 3):
        with pytest.raises(FileError):
            read("friction", changed(FRICTION, min(row, 6), cell, code))
    if code.startswith("-"):
        for cell in (0, 1, 2):
            curve = read("curve", changed(CURVE, row // 2, cell, code))
            assert len(curve[0]) == len(read("curve", CURVE)[0]) - 1


def test_a_height_among_heights_is_no_code(read):
    """Heights of thousands of nanometres, one of them 9999."""
    text = sound.text("x [mm]\tz [nm]", sound.STEPS, 1e4 * sound.LINE)
    _, z = read("profile", changed(text.decode(), 3, 1, "9999"))
    assert z[3] == pytest.approx(9.999e-6)
    assert not np.isnan(z).any()


@pytest.mark.parametrize("row", [1, 20, 38])
def test_rows_lost_doubled_and_swapped(read, row):
    lines = PROFILE.split("\n")
    _, z = read("profile", "\n".join(lines[: row + 1] + lines[row + 2 :]))
    assert np.isnan(z).nonzero()[0].tolist() == [row]
    for wrong in (
        [*lines[: row + 1], lines[row], *lines[row + 1 :]],
        [*lines[:row], lines[row + 1], lines[row], *lines[row + 2 :]],
    ):
        with pytest.raises(FileError):
            read("profile", "\n".join(wrong))


def test_headers_of_instruments(tmp_path):
    path = tmp_path / "map.al3d"
    path.write_bytes(sound.al3d().replace(b"1e-6\0", b"3e-6\0", 1))
    assert gs.read_map(path).step == pytest.approx((3e-6, 2e-6))
    hole = np.float32(1e-6 * sound.HEIGHTS[5, 3]).tobytes()
    path.write_bytes(sound.al3d().replace(hole, np.float32(1e30).tobytes()))
    assert np.argwhere(np.isnan(gs.read_map(path).z)).tolist() == [[5, 3]]


@pytest.mark.parametrize("count", ["1000000000", "-18", "0", "1e9", "18.5"])
@pytest.mark.parametrize("key", ["NumPoints", "NumProfiles"])
def test_counts_no_file_has(tmp_path, key, count):
    path = tmp_path / "map.sdf"
    path.write_text(re.sub(f"{key} = .*", f"{key} = {count}", sound.sdf().decode()))
    with pytest.raises(FileError):
        gs.read_map(path)


def test_points_that_are_on_no_grid(tmp_path):
    """Ten thousand points on a diagonal would be a map of a hundred million."""
    path = tmp_path / "diagonal.xyz"
    place = np.arange(10_000.0)
    np.savetxt(path, np.c_[place, place, place % 7.0], header="x [um] y [um] z [um]")
    with pytest.raises(FileError, match="got 10000 on one of 10000 x 10000"):
        gs.read_map(path)
