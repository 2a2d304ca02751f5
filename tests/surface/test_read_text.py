import numpy as np
import pytest

from gripscale.core.errors import FileError, InputError
from gripscale.surface import read_map, read_profile

from .surface_cases import ROAD

ROWS = [(0.5 * i, (-1) ** i * 0.25 * i) for i in range(20)]


def table(rows=ROWS, header="x [mm],z [um]\n", separator=",", end="\n"):
    return header + end.join(f"{x}{separator}{z}" for x, z in rows)


@pytest.mark.parametrize(
    ("path", "points", "missing"), [(ROAD[0], 51067, 4373), (ROAD[1], 51290, 4841)]
)
def test_captif_files_give_all_points_at_the_true_step(path, points, missing):
    profile = read_profile(path)
    assert (len(profile), profile.missing) == (points, missing)
    # Last distance, printed to 1 um, over the number of steps: the step is known to 1e-6/51000.
    last = {51067: 1.914413, 51290: 1.922773}[points]
    assert profile.length == pytest.approx(last, abs=1e-12)
    assert profile.step == pytest.approx(37.48900e-6, abs=2e-11)


def test_captif_heights_are_those_of_the_file():
    profile = read_profile(ROAD[0])
    assert profile.z[:3] == pytest.approx([-3.015e-3, -3.004e-3, -2.987e-3], abs=1e-15)
    # Distances are within half the last printed digit of those in the file (line 40: 1.087 mm).
    assert profile.x[29] == pytest.approx(1.087e-3, abs=0.51e-6)


def test_units_come_from_titles_or_arguments_and_must_agree(written):
    bare = written(table(header=""))
    assert read_profile(bare, x_unit="cm", z_unit="µm").x[1] == pytest.approx(0.5e-2)
    titled = written(table(), "titled.txt")
    assert read_profile(titled, x_unit="mm").z[2] == pytest.approx(0.5e-6)
    with pytest.raises(InputError, match=r"x_unit is 'm'.*'mm'"):
        read_profile(titled, x_unit="m")
    with pytest.raises(FileError, match="column 1 names no unit") as caught:
        read_profile(bare)
    assert caught.value.missing == "x_unit"
    with pytest.raises(InputError, match=r"z_unit must be one of m, .* got 'furlong'"):
        read_profile(bare, x_unit="mm", z_unit="furlong")


def test_a_text_file_is_one_profile(written):
    path = written(table())
    assert np.array_equal(read_profile(path, line=0).z, read_profile(path).z)
    with pytest.raises(InputError, match="from 0 to 0"):
        read_profile(path, line=1)


def test_falling_rows_are_turned_round(written):
    up = read_profile(written(table()))
    down = read_profile(written(table([*ROWS[:0:-1], ROWS[0]]), "down.txt"))
    assert np.array_equal(up.x, down.x)
    assert np.array_equal(up.z, down.z)
    assert up.notes == ()
    assert "turned round" in down.notes[0]


BAD_FILES = {
    "empty": (b"", "empty file"),
    "blank": (b"\r\n \n", "empty file"),
    "binary": (bytes(range(256)) * 20, "in none of these formats"),
    "no numbers": (b"a road\nwithout heights\n", r"found none from line 1 \('a road'\)"),
    "one column": (b"1\n2\n3\n", "two columns"),
    "three columns": (b"1,2,3\n" * 20, "line 1: expected two columns"),
    "ragged": (table() + "\n10.0,1,5", "line 22: expected 2 columns as in line 2; got 3"),
    "word": (table() + "\n10.0,high",
     "line 22: expected a number in column z; got 'high'; an empty cell"),
    "no distance": (table() + "\nnan,1.0", "line 22: expected a distance"),
    "few points": (table(ROWS[:9]), "at least 16 points; got 9"),
    "backwards": (table([*ROWS[:18], (3.0, 1.0)]), "line 20: .* increase in equal steps"),
    "twice": (table([*ROWS[:12], ROWS[11], *ROWS[12:]]),
     r"line 14: expected each distance in column 1 once; got 5.5 \(line 13\) again: take"),
    "exchanged": (table([(z, x) for x, z in ROWS]),
     "columns 1 and 2 look exchanged: .* column 2 goes in equal steps; exchange their titles"),
    "mostly left out": (table([*ROWS, (99.0, 1.0)]), "half the points .* got 21 of 199"),
    "all missing": (table([(x, "nan") for x, _ in ROWS]), "all missing|found none"),
    "unknown unit": (table(header="x [mm],z [V]\n"), "'V', which is no known unit"),
}  # fmt: skip


@pytest.mark.parametrize("kind", BAD_FILES)
def test_a_bad_file_is_refused_with_path_and_place(written, kind):
    text, says = BAD_FILES[kind]
    path = written(text)
    with pytest.raises(FileError, match=says) as caught:
        read_profile(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "title", ["depth [mm]", "Tiefe (mm)", "Profiltiefe [mm]", "Profondeur [mm]", "z_depth [mm]"]
)
def test_depths_are_doubted_until_the_way_they_count_is_stated(written, title):
    path = written(table(header=f"x [mm];{title}\n", separator=";"))
    taken, up, down = (read_profile(path, z_axis=axis) for axis in (None, "up", "down"))
    assert 'is taken as height, up: z_axis = "down" turns it over' in str(taken.doubts[0])
    assert up.doubts == down.doubts == ()
    assert np.array_equal(taken.z, up.z)
    assert np.array_equal(down.z, -up.z)
    with pytest.raises(InputError, match="z_axis must be"):
        read_profile(path, z_axis="left")


def test_depths_of_a_map_are_doubted_and_turned_over(written):
    rows = "\n".join(f"{x},{y},{x * y % 7}" for x in range(16) for y in range(16))
    path = written(f"x [mm],y [mm],depth [mm]\n{rows}")
    taken, down = read_map(path), read_map(path, z_axis="down")
    assert "titled 'depth'" in str(taken.turned().lines()[0].doubts[0])
    assert down.doubts == ()
    assert np.array_equal(down.z, -taken.z)
