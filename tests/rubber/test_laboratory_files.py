"""Files as laboratories write them: each read right, or refused with what to add.

Made up here in the layouts instruments export, with the moduli of a Maxwell solid whose times shift
by WLF; every number is printed with six digits, so that reading is right to 1e-5.
"""

from dataclasses import dataclass

import numpy as np
import openpyxl
import pytest

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.rubber import WLF
from gripscale.rubber.sweeps import holds_sweeps

SOLID = gs.Rubber(3e6, [2e6, 20e6, 200e6], [1e-1, 1e-3, 1e-5], reference_temperature=293.15,
                  shift=WLF(8.86, 101.6))  # fmt: skip
HERTZ = np.geomspace(0.5, 50.0, 7)
KELVIN = np.array([263.15, 283.15, 303.15])
DIGITS = 1e-5
"""Half a digit of six, and what quotients of two such numbers make of it."""


@dataclass(frozen=True)
class Row:
    """What an instrument measured at one frequency and temperature."""

    kelvin: float
    hertz: float

    @property
    def modulus(self):
        """E* [Pa]."""
        return complex(SOLID.at(self.kelvin).complex_modulus(2 * np.pi * self.hertz))

    @property
    def celsius(self):
        return self.kelvin - 273.15

    @property
    def omega(self):
        return 2 * np.pi * self.hertz

    @property
    def tan(self):
        return self.modulus.imag / self.modulus.real


def rows(*kelvin):
    return [Row(one, hertz) for one in kelvin or KELVIN for hertz in HERTZ]


def lines(found, cells, separator, decimal="."):
    for number, row in enumerate(found, start=1):
        texts = (f"{c:.6g}" if isinstance(c, float) else str(c) for c in cells(number, row))
        yield separator.join(text.replace(".", decimal) for text in texts)


def below(head, cells, separator, decimal=".", kelvin=()):
    return "\n".join([head, *lines(rows(*kelvin), cells, separator, decimal)])


def steps(head, before, cells):
    """TRIOS of TA Instruments: a step for each temperature, units below the titles."""
    text = [head]
    for number, kelvin in enumerate(KELVIN, start=1):
        above = before.format(number=number, celsius=f"{kelvin - 273.15:.1f}")
        text.append(below(above, cells, "\t", kelvin=[kelvin]) + "\n")
    return "\n".join(text)


def book_of(*sheets):
    """Return a workbook of sheets of lists, by their titles."""
    book = openpyxl.Workbook()
    del book["Sheet"]
    for title, content in sheets:
        sheet = book.create_sheet(title)
        for line in content:
            sheet.append(line)
    return book


def moduli_in(size):
    return lambda _, r: [r.hertz, r.modulus.real / size, r.modulus.imag / size]


PSI = 6894.757293168361
WORKBOOK = book_of(
    ("Cover", [["Laboratory", "N. N."], ["Order", 4711], [None, "natural rubber, filled"]]),
    ("Frequency sweeps", [
        [None, "Customer", "N. N."],
        [None],
        [None, "Temperature", "Frequency", "Storage modulus E'", "Loss modulus E''"],
        [None, "K", "Hz", "MPa", "MPa", None, "dried at 40 °C"],
        *([None, r.kelvin, r.hertz, round(r.modulus.real / 1e6, 6), round(r.modulus.imag / 1e6, 6)]
          for r in rows()),
    ]),
)  # fmt: skip
"""A cover sheet, a remark beside the table, two lines of titles, K."""
SWEEPS = {
    "Eplexor": (below(
        "EPLEXOR 500 N;Version 9.2\nSample;tread 12;10x2x20 mm\n\n"
        "No.;Temp./°C;Freq./Hz;|E*|/MPa;E'/MPa;E\"/MPa;tan d;Stat. strain/%;Dyn. strain/%",
        lambda i, r: [i, r.celsius, r.hertz, abs(r.modulus) / 1e6, r.modulus.real / 1e6,
                      r.modulus.imag / 1e6, r.tan, 1.0, 0.2], ";").replace("\n", "\r\n"),
        "cp1252"),
    "TRIOS": (steps(
        "Filename\tread.tri\nInstrument name\tRSA-G2\nGeometry name\tTension\n",
        "[step]\nFrequency sweep - {number}\nAngular frequency\tStorage modulus\tLoss modulus\t"
        "Tan(delta)\tTemperature\tStep time\nrad/s\tMPa\tMPa\t\t°C\ts",
        lambda i, r: [r.omega, r.modulus.real / 1e6, r.modulus.imag / 1e6, r.tan, r.celsius,
                      12.0 * i]), "utf-8"),
    "TRIOS, steps that condition the sample": (steps(
        "Filename\tread.tri\nInstrument name\tRSA-G2\n\n[step]\nConditioning Options - 1\n"
        "Step time\tTemperature\tGap\ns\t°C\tmm\n1\t20.0\t10.0\n2\t20.0\t10.0\n",
        "[step]\nConditioning Sample - {number}\nTime\tTemperature\tAxial force\tGap\n"
        "s\t°C\tN\tmm\n60\t{celsius}\t0.1\t10.0\n\n[step]\nFrequency sweep - {number}\n"
        "Angular frequency\tStorage modulus E'\tLoss modulus E''\tTemperature\n"
        "rad/s\tMPa\tMPa\t°C",
        lambda i, r: [r.omega, r.modulus.real / 1e6, r.modulus.imag / 1e6, r.celsius]), "utf-8"),
    "ARES": (below(
        "Freq   G'   G\"   tan_delta   Temp   Strain\nrad/s   dyn/cm²   dyn/cm²   -   °C   %",
        lambda i, r: [r.omega, r.modulus.real / 0.3, r.modulus.imag / 0.3, r.tan, r.celsius, 0.1],
        "   "), "latin-1"),
    "Metravib": (below(
        "METRAVIB DMA+450\n"
        "Temperature (°C)\tFrequency (Hz)\tDisplacement (m)\t|E*| (Pa)\tTan delta",
        lambda i, r: [r.celsius, r.hertz, 1e-5, abs(r.modulus), r.tan], "\t", ","), "utf-8-sig"),
    "RheoCompass in German": (below(
        "Projekt:\tReifen\nErgebnis:\tFrequenzsweep 1\nIntervall und Datenpunkte:\t1\t21\n\n"
        "Intervalldaten:\tMesspunkt\tKreisfrequenz\tSpeichermodul\tVerlustmodul\tVerlustfaktor"
        "\tTemperatur\n\t\t[rad/s]\t[Pa]\t[Pa]\t[1]\t[°C]",
        lambda i, r: ["", i, r.omega, r.modulus.real / 3, r.modulus.imag / 3, r.tan, r.celsius],
        "\t", ",").replace("\n", "\r\n"), "utf-16"),
    "one table each": ("DMA Q800 V21.3\n" + "\n".join(
        below(f"\nTemperature: {kelvin - 273.15:g} °C\nFrequency (Hz),E' (GPa),tan delta",
              lambda i, r: [r.hertz, r.modulus.real / 1e9, r.tan], ",", kelvin=[kelvin])
        for kelvin in KELVIN), "utf-8"),
    "a workbook": (WORKBOOK, ""),
}  # fmt: skip
"""Texts with their encodings, and a workbook."""
ROOM = [293.15]
MASTERS = {
    "reference above": (below(
        "Mastercurve, Tref = 20 °C\nomega [rad/s],G' [psi],G'' [psi]",
        lambda _, r: [r.omega, r.modulus.real / 3 / PSI, r.modulus.imag / 3 / PSI], ",",
        kelvin=ROOM), "utf-8"),
    "a workbook of texts": (book_of(("Masterkurve", [
        ["Masterkurve"],
        ["Frequenz [Hz]", "Speichermodul E' [N/mm²]", "Verlustmodul E'' [N/mm²]"],
        *(line.split("\t") for line in lines(rows(*ROOM), moduli_in(1e6), "\t", ",")),
    ])), ""),
    "counts above": (
        below("7 3\n2024 11 22\nf/Hz E'/Pa E''/Pa", moduli_in(1.0), " ", kelvin=ROOM), "utf-8"),
    "logarithms": (below(
        "log f [Hz]\tlog E' [Pa]\tlog E'' [Pa]",
        lambda _, r: [*map(np.log10, (r.hertz, r.modulus.real, r.modulus.imag))], "\t", ",",
        kelvin=ROOM), "utf-8"),
    "logarithms of shifted frequencies": (below(
        "log(aT*omega [rad/s]);E' [MPa];E'' [MPa]",
        lambda _, r: [np.log10(r.omega), r.modulus.real / 1e6, r.modulus.imag / 1e6], ";",
        kelvin=ROOM), "utf-8"),
}  # fmt: skip
ADDED = {
    "TRIOS": ({"modulus": "E"}, "modulus must be given (E for Young's or G for shear)"),
    "RheoCompass in German": ({"modulus": "G"}, "modulus must be given"),
    "counts above": ({"header": 2}, "line 2: expected 2 columns as in line 1; got 3"),
}
"""What a file leaves out, and what the refusal without it says."""


def read_with(read, path, name):
    """Read a file with what it leaves out, without which it is refused."""
    options, refused = ADDED.get(name, ({}, ""))
    if refused:
        with pytest.raises((InputError, OSError)) as caught:
            read(path)
        assert refused in str(caught.value)
        assert str(path) in str(caught.value)
    return read(path, **options)


def as_file(folder, content, encoding):
    if not encoding:
        content.save(folder / "dma.xlsx")
        return folder / "dma.xlsx"
    path = folder / "dma.csv"
    path.write_bytes(content.encode(encoding))
    return path


def expect_sweeps(found):
    assert found.temperatures == pytest.approx(KELVIN)
    expected = np.array([row.modulus for row in rows()])
    np.testing.assert_allclose(found.frequency, [row.hertz for row in rows()], rtol=DIGITS)
    np.testing.assert_allclose(found.storage, expected.real, rtol=DIGITS)
    np.testing.assert_allclose(found.loss, expected.imag, rtol=2 * DIGITS)


@pytest.mark.parametrize("name", SWEEPS)
def test_sweeps_of_a_laboratory(tmp_path, name):
    path = as_file(tmp_path, *SWEEPS[name])
    assert holds_sweeps(path)
    expect_sweeps(read_with(gs.read_sweeps, path, name))


@pytest.mark.parametrize("name", MASTERS)
def test_master_curves_of_a_laboratory(tmp_path, name):
    found = read_with(gs.read_master_curve, as_file(tmp_path, *MASTERS[name]), name)
    expected = np.array([row.modulus for row in rows(293.15)])
    # a logarithm of six digits is right to half of 1e-5 times ln 10
    digits = 1.2 * DIGITS
    np.testing.assert_allclose(found.frequency, HERTZ, rtol=digits)
    np.testing.assert_allclose(found.storage, expected.real, rtol=digits)
    np.testing.assert_allclose(found.loss, expected.imag, rtol=digits)


MARKED = [f"{kelvin - 273.15:g} °C" for kelvin in KELVIN]
"""Temperatures over the blocks of a table."""


def printed(number, decimal="."):
    return f"{number:.6g}".replace(".", decimal)


def moduli(hertz, *parts, decimal=".", kelvin=KELVIN):
    """The moduli of one frequency in MPa, by default E' and E'' of each temperature in turn."""
    cells = []
    for part in parts or ("both",):
        for e in (Row(one, hertz).modulus / 1e6 for one in kelvin):
            numbers = {"real": [e.real], "imag": [e.imag], "both": [e.real, e.imag]}
            numbers["tan"] = [*numbers["both"], e.imag / e.real]
            cells += [printed(number, decimal) for number in numbers[part]]
    return cells


def blocks(head, separator, *parts, decimal="."):
    """Return titles above the moduli of all temperatures, line by line of one frequency."""
    body = ([printed(f, decimal), *moduli(f, *parts, decimal=decimal)] for f in HERTZ)
    return "\n".join([head, *map(separator.join, body)])


TITLES = "Frequency\tE'\tE''"
BLOCKS = {
    "merged cells, in German": (blocks(
        f"Labor N. N.;;\n;{';;'.join(MARKED)};\n"
        f"Frequenz [Hz]{3 * ';Speichermodul E´ [MPa];Verlustmodul E´´ [MPa]'}".replace("´", "'"),
        ";", decimal=",").replace("\n", "\r\n"), "cp1252"),
    "centred, units below the titles, tan delta": (blocks(
        "\t\t" + "\t\t\t".join(MARKED) + "\t\nf" + 3 * "\tE'\tE''\ttan d"
        + "\nHz" + 3 * "\tMPa\tMPa\t-", "\t", "tan"), "utf-8"),
    "in titles of one line": (blocks(
        ",".join(["f / Hz", *(f"E' ({mark}) / MPa,E'' ({mark}) / MPa" for mark in MARKED)]), ","),
        "utf-8"),
    "modulus by modulus": (blocks(
        ";E' [MPa];;;E'' [MPa];;\nf [Hz];" + ";".join(MARKED * 2), ";", "real", "imag"), "utf-8"),
    "a column of frequencies each, one a row longer and with a missing value": ("\n".join([
        "\t\t\t".join(MARKED) + "\t\t", "\t".join([TITLES] * 3), "\t".join(["Hz\tMPa\tMPa"] * 3),
        *("\t".join("\t".join([printed(f), *moduli(f, kelvin=[one])]) for one in KELVIN)
          for f in HERTZ),
        f"60\t#N/A\t1.0{6 * chr(9)}"]), "utf-8"),
    "temperatures as numbers of a workbook": (book_of(("data", [
        ["Temperature [°C]", *(part for one in KELVIN for part in (one - 273.15, None))],
        ["Frequency", *["E'", "E''"] * 3],
        ["Hz", *["MPa"] * 6],
        *([float(f), *map(float, moduli(f))] for f in HERTZ),
    ])), ""),
    "a sheet each behind a cover": (book_of(("Cover", [["Order", 4711]]), *(
        (mark, [["f [Hz]", "E' [MPa]", "E'' [MPa]"],
                *([float(f), *map(float, moduli(f, kelvin=[one]))] for f in HERTZ)])
        for mark, one in zip(MARKED, KELVIN, strict=True))), ""),
}  # fmt: skip


@pytest.mark.parametrize("name", BLOCKS)
def test_blocks_of_temperatures_side_by_side(tmp_path, name):
    path = as_file(tmp_path, *BLOCKS[name])
    assert holds_sweeps(path)
    expect_sweeps(gs.read_sweeps(path))


def test_a_fault_in_a_block_names_its_line(written):
    text = BLOCKS["in titles of one line"][0].splitlines()
    text[4] = text[4].replace(text[4].split(",")[3], "broken")
    with pytest.raises(FileError, match=r"line 5: expected a number in column E'; got 'broken'"):
        gs.read_sweeps(written(text))


def test_blocks_of_frequencies_are_ramps(written):
    """Netzsch: E'(1.000 Hz)/MPa over temperature."""
    frequencies, celsius = (1.0, 10.0), np.arange(-10.0, 31.0, 2.0)
    titles = (f"E'({f:.3f} Hz)/MPa;E''({f:.3f} Hz)/MPa" for f in frequencies)
    text = [";".join(["Temp./°C", *titles])]
    for t in celsius:
        cells = [c for f in frequencies for c in moduli(f, kelvin=[t + 273.15])]
        text.append(";".join([f"{t:g}", *cells]))
    found = gs.read_sweeps(written(text), temperature_step=10.0)
    assert found.temperatures == pytest.approx([263.15, 273.15, 283.15, 293.15, 303.15])
    expected = [
        Row(kelvin, hertz).modulus.real for kelvin in found.temperatures for hertz in (1, 10)
    ]
    np.testing.assert_allclose(found.storage, expected, rtol=DIGITS)


RAMP = ["T [°C];E' [MPa];E'' [MPa]", "-10;20;4", "0;10;2", "10;5;1"]


@pytest.mark.parametrize("line", ["Frequency: 10 Hz", "Messfrequenz [Hz];10,0", "f = 0.01 kHz"])
def test_one_frequency_of_a_ramp_stands_above_it(written, line):
    path = written([line, *RAMP])
    assert holds_sweeps(path)
    found = gs.read_sweeps(path, tolerance=0.0)
    assert found.frequency == pytest.approx(np.full(3, 10.0))
    assert found.is_ramp


@pytest.mark.parametrize("frequency", [10.0, "10 Hz", "0.01 kHz"])
def test_one_frequency_of_a_ramp_may_be_stated(written, frequency):
    path = written(RAMP)
    with pytest.raises(InputError, match=r'frequency states it, such as "10 Hz"'):
        gs.read_sweeps(path)
    found = gs.read_sweeps(path, frequency=frequency, tolerance=0.0)
    assert found.frequency == pytest.approx(np.full(3, 10.0))
    assert found.storage == pytest.approx([20e6, 10e6, 5e6])


def test_a_frequency_beside_a_column_of_frequencies_is_refused(tmp_path):
    path = as_file(tmp_path, *SWEEPS["Eplexor"])
    with pytest.raises(InputError, match="frequency must be left out, because a column holds"):
        gs.read_sweeps(path, frequency=10.0)
    with pytest.raises(InputError, match="frequency = '10 N': unknown unit 'N'; expected one of"):
        gs.read_sweeps(path, frequency="10 N")


def test_frequency_and_angular_frequency_may_stand_in_one_table(written):
    titles, row = "omega [rad/s],f [Hz],E' [MPa],E'' [MPa],T [°C]", "62.8,10,3,0.3,20"
    path = written([titles, "6.28,1,2,0.2,20", row])
    assert gs.read_sweeps(path).frequency == pytest.approx([1.0, 10.0], rel=1e-3)
    with pytest.raises(InputError, match="columns must say which is the frequency"):
        gs.read_sweeps(written([titles, "6.28,2,2,0.2,20", row]))
