"""Master curves: sorting, checks, and reading files of many shapes without guessing."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.rubber import MasterCurve, blocks, read_master_curve
from gripscale.rubber.sweeps import MOST_ROWS, ROWS_PER_DECADE, thinned
from tests.samples import MEASURED_DMA as TREAD


def test_rows_are_sorted_by_frequency():
    curve = MasterCurve([10.0, 1.0, 10.0], [3e6, 1e6, 4e6], [3e5, 1e5, 4e5])
    assert curve.frequency.tolist() == [1.0, 10.0, 10.0]
    assert curve.storage.tolist() == [1e6, 3e6, 4e6]
    assert curve.loss_factor == pytest.approx([0.1, 0.1, 0.1])
    assert curve.angular_frequency[0] == pytest.approx(2 * np.pi)
    assert curve.decades == pytest.approx(1.0)
    assert len(curve) == 3


@pytest.mark.parametrize(
    ("frequency", "storage", "loss", "temperature", "message"),
    [
        ([1.0, 2.0], [1e6], [1e5, 1e5], None, "same length, at least 2; got 2, 1 and 2"),
        ([1.0], [1e6], [1e5], None, "at least 2; got 1, 1 and 1"),
        ([1.0, 0.0], [1e6, 1e6], [1e5, 1e5], None, r"frequency must be greater .* index 1"),
        ([1.0, 2.0], [1e6, np.nan], [1e5, 1e5], None, "storage must be a list of finite"),
        ([1.0, 2.0], [1e6, 1e6], [1e5, -1e5], None, "loss must be greater than zero"),
        ([1.0, 2.0], [1e6, 1e6], [1e5, 1e5], -20.0, "reference_temperature must be greater"),
        ([1.0, 1e308], [1e6] * 2, [1e5] * 2, None, "frequency .* 1e.308 at index 1"),
        ([1e-101, 1.0], [1e6] * 2, [1e5] * 2, None, "frequency .* 1e-101 at index 0"),
        ([1.0, 2.0], [1e6, 1e308], [1e5] * 2, None, "storage .* 1e.308"),
        ([1.0, 2.0], [1e6] * 2, [1e-310, 1.0], None, "loss .* 1e-310"),
    ],
)
def test_bad_curves(frequency, storage, loss, temperature, message):
    with pytest.raises(InputError, match=message):
        MasterCurve(frequency, storage, loss, temperature)


def test_the_measured_tread_curve_reads_with_no_arguments():
    curve = read_master_curve(TREAD)
    assert len(curve) == 105
    assert curve.name == "measured_dma"
    assert curve.frequency[[0, -1]] == pytest.approx([4.18e-3, 9.89e12])
    assert curve.storage[[0, -1]] == pytest.approx([6.68e6, 5.03e9])
    assert curve.loss[[0, -1]] == pytest.approx([7.37e5, 1.41e9])


def test_what_the_header_omits_is_given(written):
    path = written("9 1 2 0.2\n9 10 3 0.3\n")
    curve = read_master_curve(
        path,
        frequency_unit="kHz",
        modulus_unit="GPa",
        modulus="G",
        reference_temperature=293.15,
        columns=(2, 3, 4),
        name="mine",
        source="bench",
    )
    assert curve.frequency == pytest.approx([1e3, 1e4])
    assert curve.storage == pytest.approx([6e9, 9e9])
    assert curve.loss == pytest.approx([6e8, 9e8])
    assert (curve.reference_temperature, curve.name, curve.source) == (293.15, "mine", "bench")


def test_columns_by_header_name(written):
    path = written("speed (Hz),A (MPa),B (MPa)\n1,2,0.2\n10,3,0.3\n")
    curve = read_master_curve(path, columns=("speed", "A", "B"), modulus="E")
    assert curve.storage == pytest.approx([2e6, 3e6])
    bare = written("a b c\n1 2 0.2\n10 3 0.3\n")
    units = {"frequency_unit": "Hz", "modulus_unit": "MPa", "modulus": "E"}
    assert read_master_curve(bare, columns=("a", "b", "c"), **units).loss[0] == pytest.approx(2e5)


ROWS = "1,2,0.2\n10,3,0.3\n"


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        (ROWS, {}, "frequency_unit must be given .* no unit"),
        (ROWS, {"frequency_unit": "Hz"}, "modulus_unit must be given"),
        (ROWS, {"frequency_unit": "Hz", "modulus_unit": "MPa"}, "modulus must be given"),
        (ROWS, {"frequency_unit": "ell"}, "frequency_unit must be one of Hz.* got 'ell'"),
        ("f [Hz],E' [MPa],E''\n" + ROWS, {}, "modulus_unit must be given .* states no unit of E''"),
        ("f [Hz],E' [ell],E'' [ell]\n" + ROWS, {}, "modulus_unit must be given .* 'ell'"),
        ("f [Hz],storage [MPa],loss [MPa]\n" + ROWS, {}, "modulus must be given"),
        ("f [Hz],E' [MPa],G'' [MPa]\n" + ROWS, {}, "modulus must be given"),
        ("f [Hz],E' [MPa],force [N]\n" + ROWS, {}, "columns must give the modulus as two of .* E'"),
        ("1,2,3,4\n1,2,3,4\n", {}, "columns must give the frequency; no header"),
        (ROWS, {"columns": (0, 1, 2)}, "a column is counted from 1, up to 3; got 0"),
        (ROWS, {"columns": (1, 2, 7), "frequency_unit": "Hz"}, "from 1 to 3; got 7"),
        (ROWS, {"columns": (1, 2)}, "columns must be three different"),
        (ROWS, {"columns": ("f", "a", "b")}, "columns must be among .* got 'f'"),
    ],
)
def test_nothing_is_guessed(written, text, options, message):
    """And the error says which key is missing, where one helps."""
    with pytest.raises(InputError, match=message) as caught:
        read_master_curve(written(text), **options)
    helps = ("given" in message or "must give" in message) and "ell" not in message
    assert caught.value.missing == (message.split()[0] if helps else "")


@pytest.mark.parametrize(
    ("titles", "loss"),
    [
        ("E' [MPa],E'' [kPa]", 200.0),
        ("E' [MPa],tan delta [%]", 10.0),
        ("E' [MPa],delta [°]", math.degrees(math.atan(0.1))),
        ("|E*| [kPa],Phase angle (rad)", math.atan(0.1)),
    ],
)
def test_each_column_has_the_unit_of_its_own_title(written, titles, loss):
    first = 2.0 if titles.startswith("E'") else 2000.0 * math.sqrt(1.01)
    rows = [f"{10.0**at:g},{first!r},{loss!r}" for at in range(4)]
    curve = read_master_curve(written([f"f [Hz],{titles}", *rows]))
    assert curve.storage == pytest.approx(np.full(4, 2e6))
    assert curve.loss == pytest.approx(np.full(4, 2e5))


def test_a_phase_angle_without_its_unit_or_beyond_a_right_angle_is_refused(written):
    rows = "\n1,2,91\n10,3,40\n"
    with pytest.raises(InputError, match=r"phase angle must state its unit .* delta \(deg\)"):
        read_master_curve(written(f"f [Hz],E' [MPa],delta{rows}"))
    with pytest.raises(FileError, match=r"line 2: expected a phase angle below 90 degrees .* 91"):
        read_master_curve(written(f"f [Hz],E' [MPa],delta (deg){rows}"))


SWEEPS = "T [C],f [Hz],E' [MPa],E'' [MPa]\n"
SHIFTED = SWEEPS + "-20,100,4,0.4\n0,10,3,0.3\n20,1,2,0.2\n"
REPEATED = SWEEPS + "0,1,3,0.3\n0,10,4,0.4\n20,1,2,0.2\n20,10,3,0.3\n"


@pytest.mark.parametrize("text", [SHIFTED, REPEATED])
def test_sweeps_at_several_temperatures_are_no_master_curve(written, text):
    path = written(text)
    with pytest.raises(FileError, match=r"from -?\d+ to 20 in column T; shift the sweeps .* first"):
        read_master_curve(path)


def test_a_shifted_curve_may_tell_its_temperatures(written):
    columns = ("f", "E'", "E''")
    assert len(read_master_curve(written(SHIFTED), columns=columns)) == 3
    with pytest.raises(FileError, match="shift the sweeps"):
        read_master_curve(written(REPEATED), columns=columns)
    jitter = SWEEPS.replace("T", "Temperature") + "19.9,1,2,0.2\n20.3,10,3,0.3\n"
    assert len(read_master_curve(written(jitter))) == 2


HEADER = "f [Hz],E' [MPa],E'' [MPa]\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "expected rows of frequency, storage and loss; got 0 in an empty file"),
        (HEADER + "1,2,0.2\n", "expected at least 2 rows .* got 1"),
        (HEADER + "1,2,0.2\n10,abc,0.3\n",
         "line 3: expected a number in column E'; got 'abc'; an empty cell, NaN, n/a, - or #NV"),
        (HEADER + "1,2,0.2\n10,nan,0.3\n",
         "expected at least 2 rows of frequency, storage and loss; got 1 without missing values"),
        (HEADER + "1,2,0.2\n10,3\n", "line 3: expected 3 columns as in line 2; got 2"),
        (HEADER + "1,2,0.2\n10,-3,0.3\n",
         "line 3: expected a storage above zero in column E'; got -3"),
        (HEADER + "0,2,0.2\n10,3,0.3\n",
         "line 2: expected a frequency above zero in column f; got 0"),
        ("1 2\n3 4\n", "line 1: expected at least 3 columns"),
        ("log f [Hz],E' [MPa],E'' [MPa]\n1,2,0.2\n200,3,0.3\n",
         r"line 3: expected a frequency between 1e-100 and 1e\+100"),
        *((f"{HEADER}{frequency},2,0.2\n10,3,0.3\n", "line 2: expected a frequency between 1e-100")
          for frequency in ("1e308", "1e-101", "1" + "0" * 400)),
        (HEADER + "1,1e305,0.2\n10,3,0.3\n", "line 2: expected a storage between"),
    ],
)  # fmt: skip
def test_bad_files_name_path_line_and_value(written, text, message):
    path = written(text)
    with pytest.raises(FileError, match=message) as caught:
        read_master_curve(path)
    assert str(path) in str(caught.value)


def test_missing_and_binary_files(written, tmp_path):
    with pytest.raises(FileError, match=r"none\.txt: cannot be read"):
        read_master_curve(tmp_path / "none.txt")
    binary = written(b"\xd0\xcf\x11\xe0\x00\x00", "sheet.xls")
    with pytest.raises(FileError, match=r"got an old Office file \(\.xls\), to be saved as \.xlsx"):
        read_master_curve(binary)


# Of very many rows some of each decade are kept, and read alike.


def moduli(hertz):
    return 5e6 * hertz**0.1, 1e6 * hertz**0.12


def write_parts(path, parts):
    text = []
    for above, hertz in parts:
        rows = zip(hertz, *moduli(hertz), strict=True)
        text += [*above, *("\t".join(f"{value:.7g}" for value in row) for row in rows)]
    path.write_text("\n".join([*text, ""]))
    return path


TITLES = "f [Hz]\tE' [Pa]\tE'' [Pa]"


def test_of_many_rows_some_of_each_decade_are_kept_as_measured(tmp_path):
    hertz = np.geomspace(1e-2, 1e2, 3 * MOST_ROWS)
    master = gs.read_master_curve(write_parts(tmp_path / "log.txt", [([TITLES], hertz)]))
    assert len(master) == 4 * ROWS_PER_DECADE + 1
    assert master.storage == pytest.approx(moduli(master.frequency)[0], rel=1e-5)
    assert np.diff(np.log10(master.frequency)) == pytest.approx(0.01, abs=0.006)
    assert master.notes == (
        f"401 of {hertz.size} rows kept, at most 100 of a decade of frequency at one temperature",
    )


def test_few_rows_are_all_kept():
    rows = np.ones((4, MOST_ROWS))
    assert thinned(rows)[0] is rows


def test_temperatures_are_thinned_apart():
    hertz, kelvin = np.geomspace(1.0, 10.0, MOST_ROWS), np.repeat([280.0, 300.0], MOST_ROWS)
    rows = np.array([kelvin, np.tile(hertz, 2), *np.ones((2, 2 * MOST_ROWS))])
    (kept, *_), _ = thinned(rows)
    assert [np.sum(kept == each) for each in (280.0, 300.0)] == [101, 101]


@pytest.mark.parametrize("remark", ["", "-----", "measured by night"])
def test_the_rows_at_the_end_of_a_long_file_are_read_as_all_others(tmp_path, monkeypatch, remark):
    rows = np.geomspace(0.1, 50.0, 1000)
    parts = [([f"T = {degrees} C", TITLES, remark], rows) for degrees in (0, 20)]
    path = write_parts(tmp_path / "sweeps.txt", parts)
    short = gs.read_sweeps(path)
    monkeypatch.setattr(blocks, "_ENOUGH", 10**9)
    assert short == gs.read_sweeps(path)
    assert (len(short), len(short.frequency)) == (2, 2000)
