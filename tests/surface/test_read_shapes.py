"""Files of surveyors, scanners, workbooks and instruments, with spacings in headers.

Files are printed with six digits or single precision: read right to 1e-6 of the largest number.
"""

import time

import numpy as np
import openpyxl
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.surface.header import Header, read_header

X, Y = 0.2 * np.arange(20), 0.3 * np.arange(17)
Z = np.sin(2.0 * X)[:, None] * np.cos(1.5 * Y) + 0.1 * X[:, None]
"""Heights over points [mm]."""
DIGITS = 5e-6
MM = {"x_unit": "mm", "z_unit": "mm"}


def triangles(x, y, z):
    """Two triangles for each square of a grid, facing up, shape (triangles, 3, 3)."""
    points = np.stack(np.broadcast_arrays(x, y, z), axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    pairs = [np.stack(corners, axis=2).reshape(-1, 3, 3) for corners in ((a, b, c), (a, c, d))]
    return np.concatenate(pairs)


def write_stl(path, corners, *, as_text=False):
    if as_text:
        facets = [
            "facet normal 0 0 1\n outer loop\n"
            + "".join(f"  vertex {x:.6e} {y:.6e} {z:.6e}\n" for x, y, z in facet)
            + " endloop\nendfacet\n"
            for facet in corners
        ]
        path.write_text(f"solid road\n{''.join(facets)}endsolid road\n")
        return path
    table = np.zeros(len(corners), [("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    table["c"] = corners
    count = np.array([len(corners)], "<u4").tobytes()
    path.write_bytes(b"solid, by its name only".ljust(80) + count + table.tobytes())
    return path


@pytest.mark.parametrize("as_text", [True, False])
def test_triangles_between_points_of_a_grid(tmp_path, as_text):
    corners = np.random.default_rng(0).permutation(triangles(X[:, None], Y, Z))
    path = write_stl(tmp_path / "map.stl", corners, as_text=as_text)
    surface = gs.read_map(path, x_unit="mm")
    assert surface.step == pytest.approx((0.2e-3, 0.3e-3), rel=DIGITS)
    np.testing.assert_allclose(surface.z, 1e-3 * Z, atol=1e-3 * DIGITS * np.abs(Z).max())
    line = gs.read_profile(path, x_unit="mm", direction="y", line=3)
    np.testing.assert_array_equal(line.z, surface.z[3])
    with pytest.raises(FileError, match="names no unit of length; give x_unit"):
        gs.read_map(path)


def test_triangles_of_any_shape_are_interpolated_within_each(tmp_path):
    """A plane stays a plane; a hole is missing."""
    inner = np.zeros(Z.shape)
    inner[1:-1, 1:-1] = 0.05 * np.random.default_rng(1).uniform(-1.0, 1.0, Z[1:-1, 1:-1].shape)
    x, y = X[:, None] + inner, Y + inner
    corners = triangles(x, y, 0.3 * x - 0.2 * y)
    middle = corners[:, :, :2].mean(axis=1)
    hole = np.hypot(*(middle - [2.0, 2.4]).T) < 0.7
    surface = gs.read_map(write_stl(tmp_path / "map.stl", corners[~hole]), x_unit="mm")
    assert surface.step == pytest.approx((np.sqrt(0.06) * 1e-3,) * 2, rel=0.05)
    plane = 0.3 * surface.x[:, None] - 0.2 * surface.y
    there = np.isfinite(surface.z)
    np.testing.assert_allclose(surface.z[there], plane[there], atol=1e-3 * DIGITS * 4.0)
    distance = np.hypot(surface.x[:, None] - 2.0e-3, surface.y - 2.4e-3)
    assert not there[distance < 0.4e-3].any()
    assert there[distance > 1.1e-3].all()


def overhang():
    """One point beyond the next: a little fold."""
    x = np.repeat(X[:, None], Y.size, axis=1)
    x[9, 8] += 0.3
    return triangles(x, Y, Z)


def wall():
    """Two levels side by side, and what stands upright between them."""
    low, high = X[:10, None], X[9:, None]
    upright = triangles(np.repeat(X[9:10, None], 2, axis=0), Y, np.array([[0.0], [1.0]]))
    levels = [triangles(low, Y, np.zeros(1)), triangles(high, Y, np.ones(1))]
    return np.concatenate([*levels, upright])


@pytest.mark.parametrize(
    "corners",
    [
        np.concatenate([triangles(X[:, None], Y, Z), triangles(X[:, None], Y, Z - 9.0)[:, ::-1]]),
        np.concatenate([triangles(X[:, None], Y, Z), triangles(X[:, None] + 0.1, Y, Z + 9.0)]),
        overhang(),
        wall(),
    ],
    ids=["closed body", "second floor", "overhang", "wall"],
)
def test_triangles_above_each_other_are_no_surface(tmp_path, corners):
    path = write_stl(tmp_path / "map.stl", corners)
    with pytest.raises(FileError, match=r"map\.stl: expected a surface with one height at each po"):
        gs.read_map(path, x_unit="mm")


@pytest.mark.parametrize("content", [b"solid\nendsolid\n", b"x" * 90, b"vertex 1 2 nan " * 3])
def test_a_file_without_triangles_is_refused(written, content):
    with pytest.raises(FileError, match=r"map\.stl: expected triangles of three vertices"):
        gs.read_map(written(content, "map.stl"), x_unit="mm")


ESRI = "ncols 20\nnrows 17\nxllcorner 350000.5\nyllcorner 5600000\ncellsize 0,2\nNODATA_value -99\n"


def esri(head=ESRI, code="-99"):
    """Rows from north to south, the point (4, 3) missing."""
    rows = [[f"{height:.6g}" for height in row] for row in Z.T]
    rows[3][4] = code
    return head + "\n".join(" ".join(row) for row in rows[::-1])


def test_a_grid_of_esri(written):
    surface = gs.read_map(written(esri(), "road.asc"), **MM)
    assert surface.step == pytest.approx((0.2e-3, 0.2e-3))
    missing = np.zeros(Z.shape, dtype=bool)
    missing[4, 3] = True
    np.testing.assert_array_equal(np.isnan(surface.z), missing)
    np.testing.assert_allclose(surface.z[~missing], 1e-3 * Z[~missing], rtol=DIGITS)
    path = written(esri(ESRI.replace("cellsize 0,2", "dx 0.2\ndy 0.3")), "road.asc")
    assert gs.read_map(path, **MM).step == pytest.approx((0.2e-3, 0.3e-3))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("nrows 17", "nrows 18", "expected 20 x 18 heights by its header; got 340"),
        ("cellsize 0,2\n", "", "the number cellsize in its header; got none"),
        ("cellsize 0,2", "cellsize 0", "expected cellsize finite and above zero; got 0"),
    ],
)
def test_a_faulty_grid_is_refused(written, old, new, words):
    path = written(esri(ESRI.replace(old, new)), "road.asc")
    with pytest.raises(FileError, match=words):
        gs.read_map(path, **MM)
    with pytest.raises(FileError, match=r"road\.asc: the file names no unit of length"):
        gs.read_map(path)


@pytest.mark.parametrize("suffix", [".xyz", ".asc"])
def test_points_far_from_the_origin_with_colours(written, suffix):
    """Coordinates of a survey, a tenth of the points left out; a profile is a line of the map."""
    rows = [
        f"{350000 + x:.3f} {5600000 + y:.3f} {Z[i, j]:.6g} 120 130 140"
        for j, y in enumerate(Y)
        for i, x in enumerate(X)
        if (i * j) % 10 != 9
    ]
    head = [] if suffix == ".asc" else ["//X Y Z R G B"]
    cut = [row.rsplit(" ", 3)[0] for row in rows] if suffix == ".asc" else rows
    path = written([*head, *cut], f"points{suffix}")
    surface = gs.read_map(path, **MM)
    i, j = np.indices(Z.shape)
    np.testing.assert_array_equal(np.isnan(surface.z), (i * j) % 10 == 9)
    np.testing.assert_allclose(np.nan_to_num(surface.z - 1e-3 * Z), 0.0, atol=1e-3 * DIGITS)
    np.testing.assert_array_equal(gs.read_profile(path, **MM, line=2).z, surface.z[:, 2])


def test_scattered_points_are_refused(tmp_path):
    path = tmp_path / "points.xyz"
    np.savetxt(path, np.random.default_rng(0).uniform(0.0, 9.0, (500, 3)), fmt="%.4f")
    for read in (gs.read_map, gs.read_profile):
        with pytest.raises(FileError, match="scattered points are to be put on a grid first"):
            read(path, **MM)


def test_a_map_in_a_workbook(tmp_path):
    book = openpyxl.Workbook()
    for row in Z.T:
        book.active.append([float(height) for height in row])
    book.save(tmp_path / "map.xlsx")
    surface = gs.read_map(tmp_path / "map.xlsx", step=1e-4, z_unit="mm")
    np.testing.assert_allclose(surface.z, 1e-3 * Z, rtol=1e-14)


def lines(*texts):
    return list(enumerate(texts, start=1))


@pytest.mark.parametrize(
    ("texts", "header"),
    [
        (["# Spacing: 0.1 mm"], Header(step=(1e-4, 1e-4))),
        (["# Height unit: um", "# Spacing [mm]: 0.1"], Header(None, "um", (1e-4, 1e-4))),
        (["Schrittweite;0,1;mm", "Höheneinheit: µm"], Header(None, "um", (1e-4, 1e-4))),
        (["Messpunktabstand = 50 µm", "Einheit der Höhe: mm"], Header(None, "mm", (5e-5, 5e-5))),
        (["dx = 10 um", "dy = 20 um", "Units: um"], Header("um", "um", (1e-5, 2e-5))),
        (["% x step: 0.2", "% y step: 0.3", "% Einheiten: mm"], Header("mm", "mm", (2e-4, 3e-4))),
        (["Pixelgröße (µm):\t2,5"], Header(step=(2.5e-6, 2.5e-6))),
        (["# Spacing: 0.1", "# Height unit: mm"], Header(None, "mm")),
        (["Spacing: 0.1 V", "Unit: N", "Distance: 100 mm", "Heights: 20 mm", "1;2"], Header()),
        (["x [mm];z [mm]", "0.0;mm", "unit"], Header()),
    ],
)
def test_what_a_header_states(texts, header):
    read = read_header(lines(*texts))
    assert (read.x_unit, read.z_unit) == (header.x_unit, header.z_unit)
    assert read.step == (None if header.step is None else pytest.approx(header.step))


COLUMN = "\n".join(f"{height:.6g}" for height in Z.T.ravel())
HEAD = "Profilometer\n# Spacing: 0.2 mm\n# Height unit: mm\n"


def test_one_column_below_its_spacing(written):
    path = written(HEAD + COLUMN, "line.txt")
    profile = gs.read_profile(path)
    assert profile.step == pytest.approx(0.2e-3)
    np.testing.assert_allclose(profile.z, 1e-3 * Z.T.ravel(), rtol=DIGITS)
    assert gs.read_profile(path, step=0.2e-3).step == pytest.approx(0.2e-3)
    with pytest.raises(InputError, match=r"step is 0\.3 mm, but .*line\.txt says 0\.2 mm;"):
        gs.read_profile(path, step=0.3e-3)
    with pytest.raises(InputError, match=r"z_unit is 'um', but .* says 'mm'"):
        gs.read_profile(path, z_unit="um")


def test_a_table_below_its_spacings(tmp_path):
    path = tmp_path / "map.txt"
    np.savetxt(path, Z.T, header="dx: 0.2 mm\ndy: 0.3 mm\nheight unit: mm")
    surface = gs.read_map(path)
    assert surface.step == pytest.approx((0.2e-3, 0.3e-3))
    np.testing.assert_allclose(surface.z, 1e-3 * Z, rtol=DIGITS)


# Layouts of instruments: read right, or refused with the option that cures it.

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
def test_one_column_of_heights_needs_its_step(written, title, decimal):
    body = [f"{1e3 * height:.4f}".replace(".", decimal) for height in HEIGHTS]
    body[3] = "nan"
    path = written(title + "\n".join(body))
    with pytest.raises(FileError, match="got one column of numbers: give step, the dist") as caught:
        gs.read_profile(path)
    assert caught.value.missing == "step"
    profile = gs.read_profile(path, step=STEP, z_unit=None if title else "mm")
    assert profile.step == pytest.approx(STEP)
    expected = np.where(np.arange(200) == 3, np.nan, HEIGHTS)
    np.testing.assert_allclose(profile.z, expected, atol=0.5001e-7)


def test_a_step_beside_distances_is_refused(written):
    path = written(["x [mm];z [mm]", *(f"{0.05 * i:.2f};1" for i in range(20))])
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
def test_a_map_in_sdf_has_its_lengths_in_its_header(written, width, sign):
    """Profile by profile along x; lines of three counts look like points to other readers."""
    counts = [f"{count:g}" for count in MAP.T.ravel()]
    counts[30] = "BAD"  # point 6 of the second profile
    body = [" ".join(counts[i : i + width]) for i in range(0, len(counts), width)]
    text = HEADER.replace("=", sign) + "\n".join(body) + "\n*\n"
    surface = gs.read_map(written(text, "map.sdf"))
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
def test_a_faulty_sdf_is_refused_at_once(written, old, new, words):
    body = "\n".join(f"{count:g}" for count in MAP.T.ravel())
    path = written(HEADER.replace(old, new) + body, "map.sdf")
    start = time.perf_counter()
    with pytest.raises(FileError, match=words):
        gs.read_map(path)
    assert time.perf_counter() - start < 1.0
