"""Text files of every shape, read alike whether they hold a profile or a master curve."""

from pathlib import Path

import numpy as np
import pytest

from gripscale.core.errors import FileError
from gripscale.io.cells import parse_number
from gripscale.io.text_table import PlainRows, files_read_once, read_table
from gripscale.rubber import read_master_curve
from gripscale.surface import read_profile

# The first row of each holds whole numbers only, which look alike with either decimal sign.
ROAD = [(0, 1), *((0.5 * i, 0.25 * (-1) ** i) for i in range(1, 20))]
DMA = [(1, 2, 1), (2.5, 3.5, 0.5), (10.25, 4, 0.75)]
ROAD_TITLES, DMA_TITLES = ("x", "z"), ("f", "E'", "E''")
ROAD_UNITS, DMA_UNITS = ("mm", "µm"), ("Hz", "MPa", "MPa")


def lines_of(titles, units, rows, separator, decimal):
    named = [f"{title} [{unit}]" for title, unit in zip(titles, units, strict=True)]
    cells = [[f"{value:g}".replace(".", decimal) for value in row] for row in rows]
    return [separator.join(row) for row in (named, *cells)]


def files(folder, shape, *, separator=";", decimal="."):
    """Write the road and the DMA; `shape` makes bytes or a text of lines."""
    paths = []
    for name, *what in (
        ("road.txt", ROAD_TITLES, ROAD_UNITS, ROAD),
        ("dma.txt", DMA_TITLES, DMA_UNITS, DMA),
    ):
        shaped = shape(lines_of(*what, separator, decimal))
        path = folder / name
        path.write_bytes(shaped if isinstance(shaped, bytes) else shaped.encode())
        paths.append(path)
    return paths


def as_meant(profile, curve):
    x, z = np.array(ROAD).T
    assert profile.x == pytest.approx(1e-3 * x, rel=1e-14)
    assert profile.z == pytest.approx(1e-6 * z, rel=1e-14)
    frequency, storage, loss = np.array(DMA).T
    assert curve.frequency == pytest.approx(frequency, rel=1e-14)
    assert curve.storage == pytest.approx(1e6 * storage, rel=1e-14)
    assert curve.loss == pytest.approx(1e6 * loss, rel=1e-14)


def line_of_units(lines):
    words = lines[0].replace("]", "").split(";")
    names, units = zip(*(word.split(" [") for word in words), strict=True)
    return "\n".join([";".join(names), ";".join(units), *lines[1:]])


SHAPES = {
    "utf-8": lambda lines: "\n".join(lines),
    "byte order mark": lambda lines: "\n".join(lines).encode("utf-8-sig"),
    "utf-16": lambda lines: "\r\n".join(lines).encode("utf-16"),
    "utf-16 without a mark": lambda lines: "\n".join(lines).encode("utf-16-le"),
    "utf-16, big end first": lambda lines: b"\xfe\xff" + "\n".join(lines).encode("utf-16-be"),
    "latin-1": lambda lines: "\n".join(lines).encode("latin-1"),
    "doubled carriage returns": lambda lines: "\r\r\n".join(lines),
    "bare carriage returns": lambda lines: "\r".join(lines),
    "blank lines": lambda lines: "\n\n".join(lines),
    "comments among the rows": lambda lines: "\n".join([*lines[:3], "# a % b ! c", *lines[3:]]),
    "titles in a comment": lambda lines: "% " + "\n".join(lines),
    "a preamble": lambda lines: "\n".join(["Rig 7", "Date;1/2/2020", *lines]),
    "a line of units": line_of_units,
    "units behind a slash": lambda lines: "\n".join(lines).replace(" [", " / ").replace("]", ""),
    "units behind a blank": lambda lines: "\n".join(lines).replace(" [", " ").replace("]", ""),
    "separators at the ends": lambda lines: ";\n".join(lines) + ";",
    "separators around the rows": lambda lines: "\n".join(
        [lines[0], *(f";{line};" for line in lines[1:])]
    ),
    "quotes": lambda lines: "\n".join(f'"{line}"'.replace(";", '";"') for line in lines),
    "numbered rows": lambda lines: "\n".join(
        f"{i or 'no.'};{line}" for i, line in enumerate(lines)
    ),
    "remarks": lambda lines: "\n".join(f"{line};-" for line in lines),
    "a word in every row": lambda lines: "\n".join(
        [f"{lines[0]};state", *(f"{line};ok" for line in lines[1:])]
    ),
    "a remark behind a row": lambda lines: "\n".join([*lines[:3], f"{lines[3]} # wet", *lines[4:]]),
    "remarks below the rows": lambda lines: "\n".join([*lines, "", "Tested by: N. N.", "ok;ok"]),
    "dates and times": lambda lines: "\n".join(
        [f"Datum;Zeit;{lines[0]}", *(f"24.11.2022;12:03;{line}" for line in lines[1:])]
    ),
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("decimal", [".", ","])
def test_both_readers_understand(tmp_path, shape, decimal):
    road, dma = files(tmp_path, SHAPES[shape], decimal=decimal)
    as_meant(read_profile(road), read_master_curve(dma))


@pytest.mark.parametrize(
    ("separator", "decimal"),
    [(",", "."), (", ", "."), (";", ","), ("; ", ","), ("\t", "."), ("\t", ","), ("  ", ",")],
)
def test_every_separator_with_its_decimal_signs(tmp_path, separator, decimal):
    road, dma = files(tmp_path, "\n".join, separator=separator, decimal=decimal)
    as_meant(read_profile(road), read_master_curve(dma))


def third_line(new):
    """Replace the second row's first cell, 0.5 or 2.5."""
    return lambda lines: (
        "\n".join([*lines[:2], ";".join([new, *lines[2].split(";")[1:]])])
        + ("\n" + "\n".join(lines[3:]))
    )


REFUSED = {
    "nothing": (lambda _: "", "got 0 in an empty file"),
    "words": (lambda _: "a\nb\n", r"found none from line 1 \('a'\) on"),
    "two decimal signs": (third_line("2,5"),
     r"line \d: expected one decimal sign throughout; got '\S+' after '\S+' in line 3"),
    "thousands ill parted": (third_line("1,23.5"), r"line 3: expected a .*; got '1,23\.5'"),
    "underscores": (third_line("1_000"), "line 3: expected a .*; got '1_000'"),
    "foreign digits": (third_line("١"), "line 3: expected a .*; got '١'"),
    "beyond floating point": (third_line("1e999"), "line 3: expected a .*; got '1e999'"),
    "a long row": (lambda lines: "\n".join(lines) + "\n1;1;1;1;1",
     r"line \d+: expected \d columns as in line 2; got 5"),
    "a fault in the first row": (lambda lines: "\n".join([lines[0],
     lines[1].rpartition(";")[0] + ";O.1", *lines[2:]]),
     r"line 2: expected a number in column \d; got 'O\.1'"),
}  # fmt: skip


@pytest.mark.parametrize(("cell", "number"), [("1.234.567,5", 1234567.5), ("-1,234.5", -1234.5)])
def test_thousands_may_be_parted_where_cells_are_parted_otherwise(written, cell, number):
    table = read_table(written(f"{cell};{cell}\n" * 2), "numbers", kinds=(), named=bool)
    assert table.numbers(1, "a number").tolist() == [number, number]


MARKS = "NaN|n.a.|n. a.|N/A|-|--|–|#NV|#N/A|#WERT!|#DIV/0!|k.A.|No Data|nodata|inf|***|void|"


@pytest.mark.parametrize("mark", MARKS.split("|"))
@pytest.mark.parametrize("row", ["2.5;{};3", "{};2.5;3"])
def test_marks_of_missing_values(written, mark, row):
    path = written(f"1;1;1\n{row.format(mark)}\n3;3;3\n")
    table = read_table(path, "numbers", kinds=(), named=bool)
    numbers = [table.numbers(at, "a number", missing=True) for at in range(3)]
    assert np.isnan(numbers).sum() == 1
    assert len(table.rows) == 3


@pytest.mark.parametrize("shape", REFUSED)
def test_both_readers_refuse(tmp_path, shape):
    make, says = REFUSED[shape]
    road, dma = files(tmp_path, make)
    for path, read in ((road, read_profile), (dma, read_master_curve)):
        with pytest.raises(FileError, match=says) as caught:
            read(path)
        assert str(path) in str(caught.value)


def test_commas_in_remarks_are_no_decimal_signs(written):
    path = written("1.5;-;2.5\n2.5;wet, 3,5 C;3.5\n")
    table = read_table(path, "numbers", kinds=(), named=bool)
    assert table.decimal == "."
    assert table.numbers(2, "a number").tolist() == [2.5, 3.5]


@pytest.mark.parametrize(
    ("title", "name", "unit"),
    [
        ("Frequency (Hz)", "Frequency", "Hz"),
        ("E'_MPa", "E'", "MPa"),
        ("E'/MPa", "E'", "MPa"),
        ("omega rad/s", "omega", "rad/s"),
        ("E' (1 Hz) [N/mm²]", "E' (1 Hz)", "N/mm²"),
        ("loss [ell]", "loss", "ell"),
        ("loss / ell", "loss", "ell"),
        ("loss ell", "loss ell", None),
        ("G'/G''", "G'/G''", None),
    ],
)
def test_titles(written, title, name, unit):
    path, named = written(f"{title};frequency\n1;2\n"), {"frequency"}.__contains__
    table = read_table(path, "numbers", kinds=("frequency", "modulus"), named=named)
    assert (table.columns[0].name, table.columns[0].unit) == (name, unit)


@pytest.mark.parametrize("cell", ["1_000", "0x1", "1e", "1.2.3", "١", "1,5"])
def test_only_plain_numbers_are_numbers(cell):
    assert parse_number(cell) is None


def read(path):
    return read_table(path, "numbers", kinds=("length",), named={"x", "z"}.__contains__)


@pytest.mark.parametrize("separator", ["\t", ";", ",", " "])
def test_rows_of_plain_numbers_are_those_cut_cell_by_cell(written, separator):
    """All at once, to the last bit and with the printed places, as with a mark among them."""
    values = np.random.default_rng(0).standard_normal((50, 2)) * [[1.0, 1e-7]]
    lines = [f"{x:.6f}{separator}{z!r}" for x, z in values.tolist()]
    lines = [f"x [mm]{separator}z [mm]", *lines]
    first = read(written(lines))
    second = read(written([*lines, f"99.000000{separator}n/a"]))
    assert isinstance(first.rows, PlainRows)
    assert not isinstance(second.rows, PlainRows)
    assert [*first.rows] == [*second.rows][:-1]
    assert first.columns == second.columns
    for column, name in enumerate(("distance", "height")):
        numbers = first.numbers(column, name)
        assert (numbers == second.numbers(column, name, missing=True)[:-1]).all()
        assert first.resolution(column) == second.resolution(column)


def test_nan_is_read_all_at_once(written):
    """Where a value must not miss, the message names the line as for any other mark."""
    table = read(written("x [mm];z [mm]\n0.0;1.5\n0.1;NaN\n0.2;2.25\n"))
    assert isinstance(table.rows, PlainRows)
    np.testing.assert_array_equal(table.numbers(1, "height", missing=True), [1.5, np.nan, 2.25])
    assert table.resolution(1) == 0.01
    with pytest.raises(FileError, match="line 3: expected a height; got 'NaN'"):
        table.numbers(1, "a height")


def test_a_file_that_many_readers_try_is_read_once(written, monkeypatch):
    """Inside a block only: a file that changed is read anew."""
    path, opened = written("0 1\n1 2\n"), []
    real = Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda file: opened.append(file) or real(file))
    with files_read_once():
        assert read(path).numbers(1, "height").tolist() == [1.0, 2.0]
        first = len(opened)
        assert read(path).numbers(1, "height").tolist() == [1.0, 2.0]
        assert len(opened) == first
    assert read(written("0 3\n1 4\n")).numbers(1, "height").tolist() == [3.0, 4.0]
