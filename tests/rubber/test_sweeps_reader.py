"""Sweeps as instruments write them: titles, units, separators, several tables, Excel, RepTate."""

import numpy as np
import openpyxl
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.rubber import Sweeps, read_strain_sweeps, sweeps_from_ramps
from gripscale.rubber.columns import quantity, stated_in, with_primes
from gripscale.rubber.sweeps import holds_sweeps
from tests.samples import EXAMPLES

DATA = EXAMPLES / "data/rubber"
POLYMER = DATA / "multi_temperature_polymer" / "freq_user_raw.csv"
CELSIUS = (19.9, 20.1, 40.0, 40.2)
HERTZ = (1.0, 10.0, 1.0, 10.0)
STORAGE = (8.0, 9.0, 6.0, 7.0)
LOSS = (1.0, 1.5, 0.5, 0.75)
"""Two sweeps of two rows [C, Hz, MPa, MPa]."""


def rows(separator=",", decimal=".", order="TfEL"):
    columns = dict(zip("TfEL", (CELSIUS, HERTZ, STORAGE, LOSS), strict=True))
    cells = zip(*(columns[letter] for letter in order), strict=True)
    return [separator.join(str(v).replace(".", decimal) for v in row) for row in cells]


def expect(sweeps, factor=1.0, hertz=1.0):
    assert len(sweeps) == 2
    assert sweeps.temperatures == pytest.approx([293.15, 313.25])
    assert sweeps.frequency == pytest.approx(hertz * np.array(HERTZ))
    assert sweeps.storage == pytest.approx(factor * 1e6 * np.array(STORAGE))
    assert sweeps.loss == pytest.approx(factor * 1e6 * np.array(LOSS))


PLAIN = "temperature (C), frequency (Hz), storage modulus E' (MPa), loss modulus E'' (MPa)"


def test_rows_in_any_order_are_grouped(written):
    shuffled = [rows()[i] for i in (3, 0, 2, 1)]
    expect(gs.read_sweeps(written([PLAIN, *shuffled])))


def test_fahrenheit_and_kelvin(written):
    for unit, values in (("F", [68.0, 104.0]), ("K", [293.15, 313.15])):
        text = [f"T ({unit}),f (Hz),E' (Pa),E'' (Pa)", *(f"{v},1,2,1" for v in values)]
        sweeps = gs.read_sweeps(written(text))
        assert sweeps.temperatures == pytest.approx([293.15, 313.15])


@pytest.mark.parametrize("known", ["E' (MPa)", "E'' (MPa)", "|E*| (MPa)"])
def test_loss_factor_with_one_modulus(written, known):
    storage, loss = np.array(STORAGE), np.array(LOSS)
    value = {"E' (MPa)": storage, "E'' (MPa)": loss}.get(known, np.hypot(storage, loss))
    columns = (CELSIUS, HERTZ, value, loss / storage)
    lines = [",".join(repr(float(v)) for v in row) for row in zip(*columns, strict=True)]
    title = f"T (C),f (Hz),{known},tan delta (-)"
    expect(gs.read_sweeps(written([title, *lines])))


def test_a_row_with_a_fault_between_tables_is_no_new_table(written):
    title, half = "f (Hz);E' (MPa);E'' (MPa)", rows(";", order="fEL")
    parts = [f"T = 20 °C\n{title}", half[0], "1.0;8.O;1.0", "\nT [°C]: 40.1", *half[2:]]
    with pytest.raises(FileError, match=r"line 4: expected a number in column E'; got '8\.O'"):
        gs.read_sweeps(written(parts))


def test_several_files_with_given_temperatures(written):
    title, half = "f (Hz),E' (MPa),E'' (MPa)", rows(order="fEL")
    one = written(["T = 20 C", title, *half[:2]], "a.csv")
    other = written(["T = 40.1 C", title, *half[2:]], "b.csv")
    expect(gs.read_sweeps([one, other]))


def test_excel(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.title = "data"
    sheet.append(["Operator", "N. N."])
    sheet.append(["Temp.", "Freq.", "Speichermodul E'", "Verlustmodul E''"])
    sheet.append(["°C", "Hz", "MPa", "MPa"])
    for row in zip(CELSIUS, HERTZ, STORAGE, LOSS, strict=True):
        sheet.append(list(row))
    book.create_sheet("notes").append(["nothing"])
    path = tmp_path / "dma.xlsx"
    book.save(path)
    expect(gs.read_sweeps(path))
    expect(gs.read_sweeps(path, sheet="data"))
    with pytest.raises(InputError, match="sheet must be one of data, notes; got 'other'"):
        gs.read_sweeps(path, sheet="other")
    book["notes"].append([1.0, 2.0])
    book.save(path)
    expect(gs.read_sweeps(path))  # the only sheet with moduli
    book.copy_worksheet(sheet).title = "again"
    del book["notes"]
    book.save(path)
    expect(gs.read_sweeps(path, sheet="again"))
    for row in (*sheet.rows, *book["again"].rows):
        row[0].value = None
    book.save(path)
    with pytest.raises(InputError, match=r"sheet must be given, .* \(data, again\)"):
        gs.read_sweeps(path)


def test_reptate(written):
    shifted = "T=20;Mw=13.5;chem=PI;\n 1.0E0  2.0E6  1.0E6  -10.0\n 6.283185307E0 3.0E6 1.5E6 -20\n"
    sweeps = gs.read_sweeps(written(shifted, "PI.tts"))
    assert sweeps.temperatures == pytest.approx([293.15])
    assert sweeps.frequency == pytest.approx([0.5 / np.pi, 1.0])
    assert sweeps.storage == pytest.approx([6e6, 9e6])
    assert sweeps.loss == pytest.approx([3e6, 4.5e6])
    titles = "T=0;label=PI;\nFreq\tG'\tG\"\tTemp\tStrain\nrad/s\tPa\tPa\t°C\t%\n"
    one = titles + "  100  3.4801E5  70871 -0.0079 0.967\n"
    sweeps = gs.read_sweeps(written(one, "PI.osc"))
    assert sweeps.temperatures == pytest.approx([273.15])
    assert sweeps.loss == pytest.approx([3 * 70871.0])


def test_reptate_with_too_few_columns(written):
    with pytest.raises(InputError, match=r"must give the modulus .* the header has frequency, G'$"):
        gs.read_sweeps(written("T=20;\n1.0 2.0\n", "PI.tts"))


def test_measured_polymer():
    sweeps = gs.read_sweeps(POLYMER)
    assert len(sweeps) == 21
    assert np.diff(sweeps.temperatures) == pytest.approx(np.full(20, 7.5), abs=0.5)
    assert sweeps.storage[0] == pytest.approx(8097.175545e6)
    assert {len(one) for one in sweeps} == {10}


@pytest.mark.parametrize(
    ("old", "new", "error", "words"),
    [
        ("(C)", "", InputError, "temperature_unit must be given"),
        ("temperature (C)", "time (s)", InputError, "of the rows must stand in a column"),
        ("frequency (Hz)", "log t (s)", InputError, "columns must give the frequency"),
        ("20.1", "", FileError, r"line 3: expected a temperature in every row; .* 1 of 4"),
        ("0.75", "-0.75", FileError, r"line 5: expected a loss above zero.* got -0.75"),
        ("19.9", "-300", FileError, "line 2: expected a temperature above absolute zero"),
    ],
)
def test_what_is_missing_is_asked_for_and_what_is_bad_is_named(written, old, new, error, words):
    path = written("\n".join([PLAIN, *rows()]).replace(old, new))
    with pytest.raises(error, match=words):
        gs.read_sweeps(path)


def test_what_is_given_goes_before_the_file(written):
    path = written(["a,b,c,d", *rows()])
    named = {"temperature": "a", "frequency": 2, "storage": "c", "loss": "d"}
    units = {"temperature_unit": "C", "frequency_unit": "rad/s", "modulus_unit": "kPa"}
    expect(gs.read_sweeps(path, columns=named, modulus="G", **units), 3e-3, 0.5 / np.pi)
    with pytest.raises(InputError, match="unknown quantity in columns storag; did you mean"):
        gs.read_sweeps(path, columns={"storag": "c"})


def test_two_columns_that_mean_the_same_are_asked_about(written):
    lines = [f"{row},{row.split(',')[2]}1" for row in rows()]
    path = written([f"{PLAIN}, E' corrected (MPa)", *lines])
    with pytest.raises(InputError, match="columns must say which is the storage, because 2 titles"):
        gs.read_sweeps(path)
    assert gs.read_sweeps(path, columns={"storage": 3}).storage[0] == 8e6


def moduli_at(celsius, scale=1.0):
    """Rows of one sweep, softer by a decade in 20 K."""
    size = scale * 10.0 ** (-celsius / 20.0)
    return [f"{f:g},{size * f**0.2:.6g},{0.3 * size * f**0.2:.6g}" for f in (0.1, 1, 10, 100)]


@pytest.mark.parametrize("titles", ["f [Hz],E' [MPa],E'' [MPa]", ""])
def test_sweeps_without_their_temperatures_are_no_master_curve(written, titles):
    units = {} if titles else {"frequency_unit": "Hz", "modulus_unit": "MPa", "modulus": "E"}
    table = [*moduli_at(-20.0), *moduli_at(0.0), *moduli_at(20.0)]
    words = (
        "the same frequencies again with moduli 1e\\+02 times apart.* add a column with the temp"
    )
    with pytest.raises(FileError, match=words):
        gs.read_master_curve(written([titles, *table]), **units)


def test_two_specimens_of_one_master_curve_are_no_sweeps(written):
    table = [*moduli_at(20.0), *moduli_at(20.0, 1.3)]
    path = written(["f [Hz],E' [MPa],E'' [MPa]", *table])
    assert len(gs.read_master_curve(path)) == 8


def test_moduli_far_apart_at_one_frequency_and_temperature_are_refused(written):
    lines = [f"{t},{row}" for t in (0, 20) for s in (1.0, 3.0) for row in moduli_at(t, s)]
    path = written(["T [C],f [Hz],E' [MPa],E'' [MPa]", *lines])
    assert holds_sweeps(path)
    with pytest.raises(FileError, match=r"one measurement at each .* got moduli 3 times apart"):
        gs.read_sweeps(path)


def test_missing_values_are_left_out(written):
    text = "\n".join([PLAIN, *rows()]).replace("8.0", "n/a")
    assert len(gs.read_sweeps(written(text)).storage) == 3


def ramp(frequency, offset):
    """E' and E'' whose logarithms are straight in temperature; rows every kelvin."""
    kelvin = 273.15 + offset + np.arange(0.0, 41.0)
    storage = 1e7 * frequency**0.1 * np.exp(-0.02 * (kelvin - 273.15))
    return np.array([kelvin, np.full(41, frequency), storage, 0.2 * storage])


def test_ramps_become_sweeps_at_nominal_temperatures():
    measured = np.hstack([ramp(1.0, 0.0), ramp(10.0, 0.3), ramp(100.0, 0.7)])
    with pytest.raises(InputError, match=r"without a gap; a ramp needs .* \(temperature_step\)"):
        Sweeps(*measured)
    sweeps = sweeps_from_ramps(*measured, step=5.0)
    assert sweeps.temperatures - 273.15 == pytest.approx(np.arange(0.0, 41.0, 5.0))
    expected = 1e7 * sweeps.frequency**0.1 * np.exp(-0.02 * (sweeps.temperature - 273.15))
    assert sweeps.storage == pytest.approx(expected, rel=1e-9)
    # Nothing beyond what was measured: the second and third frequency begin above 0 °C.
    assert [len(one) for one in sweeps] == [1, 3, 3, 3, 3, 3, 3, 3, 3]


def test_no_row_across_a_gap_of_a_ramp():
    measured = ramp(1.0, 0.0)[:, [*range(6), *range(30, 41)]]
    found = sweeps_from_ramps(*measured, step=5.0).temperatures - 273.15
    assert found == pytest.approx([0.0, 5.0, 30.0, 35.0, 40.0])


def test_master_curves_and_sweeps_are_told_apart(written):
    assert holds_sweeps(POLYMER)
    assert not holds_sweeps(DATA / "measured_dma.txt")
    shifted = [f"{t},{10.0**i},{8 + i},1" for i, t in enumerate([40, 40, 20, 20, 0, 0])]
    assert not holds_sweeps(written([PLAIN, *shifted]))


@pytest.mark.parametrize(
    ("title", "meant"),
    [("t", None), ("T", "temperature"), ("F", None), ("f", "frequency"), ("log E'", None),
     ("Eta'", None), ("E'", "storage"), ("E''", "loss"), ("tan(δ)", "loss_factor"),
     ("Verlustfaktor", "loss_factor"), ("Probentemperatur", "temperature"), ("|G*|", "magnitude"),
     ("Kreisfrequenz", "frequency"), ("shear rate", None), ("Dehnung", "strain"), ("F dyn", None)],
)  # fmt: skip
def test_what_titles_mean(title, meant):
    assert quantity(title) == meant


def test_temperatures_stated_above_a_table():
    assert stated_in("# Temperature: 20 °C") == ("20", "°C")
    assert stated_in("Temperatur [°C];20,5") == ("20,5", "°C")
    assert stated_in("Title: tread 12") is None
    assert with_primes('f;E";"Modul E"') == "f;E'';\"Modul E\""


def test_strain_sweep(written):
    title = "Strain p-p (%), G' (MPa), G'' (MPa), Frequency (Hz), T (C)"
    lines = [title, "2.0,2.0,0.3,10,60.1", "0.2,3.0,0.2,10.05,59.9"]
    (sweep,) = read_strain_sweeps(written(lines, "dma.csv"))
    assert sweep.strain == pytest.approx([0.001, 0.01])
    assert sweep.storage == pytest.approx([9e6, 6e6])
    assert (sweep.deformation, sweep.name) == ("shear", "dma")
    assert sweep.temperature == pytest.approx(333.15)
    assert sweep.frequency == pytest.approx(10.0, rel=0.01)
    unknown = written([title, "2,2,1,n/a,-", "1,3,1,n/a,-"])
    (bare,) = read_strain_sweeps(unknown)
    assert bare.frequency is None
    assert bare.temperature is None
