"""Files as laboratories write them: each read right, or refused with what to add.

Made up here in the layouts instruments export, with the moduli of a Maxwell solid whose times shift
by WLF; every number is printed with six digits, so that reading is right to 1e-5.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

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
    def modulus(self) -> complex:
        """E* [Pa]."""
        return complex(SOLID.at(self.kelvin).complex_modulus(2 * np.pi * self.hertz))

    @property
    def celsius(self) -> float:
        return self.kelvin - 273.15

    @property
    def omega(self) -> float:
        return 2 * np.pi * self.hertz

    @property
    def tan(self) -> float:
        return self.modulus.imag / self.modulus.real


def rows(*kelvin: float) -> list[Row]:
    return [Row(one, hertz) for one in kelvin or KELVIN for hertz in HERTZ]


def lines(
    found: list[Row], cells: Callable[[int, Row], list[Any]], separator: str, decimal: str = "."
) -> Iterator[str]:
    for number, row in enumerate(found, start=1):
        texts = (f"{c:.6g}" if isinstance(c, float) else str(c) for c in cells(number, row))
        yield separator.join(text.replace(".", decimal) for text in texts)


def eplexor(path: Path) -> None:
    """Gabo Eplexor: titles with units behind a slash, E" with a quotation mark, semicolons."""
    titles = "No.;Temp./°C;Freq./Hz;|E*|/MPa;E'/MPa;E\"/MPa;tan d;Stat. strain/%;Dyn. strain/%"
    body = lines(rows(), lambda i, r: [i, r.celsius, r.hertz, abs(r.modulus) / 1e6,
        r.modulus.real / 1e6, r.modulus.imag / 1e6, r.tan, 1.0, 0.2], ";")  # fmt: skip
    head = ["EPLEXOR 500 N;Version 9.2", "Sample;tread 12;10x2x20 mm", "", titles]
    path.write_text("\r\n".join([*head, *body]), encoding="cp1252")


def trios(path: Path) -> None:
    """TA Instruments TRIOS (RSA-G2): a step for each temperature, units on the second line."""
    text = ["Filename\ttread.tri", "Instrument name\tRSA-G2", "Geometry name\tTension", ""]
    titles = "Angular frequency\tStorage modulus\tLoss modulus\tTan(delta)\tTemperature\tStep time"
    for number, kelvin in enumerate(KELVIN, start=1):
        text += ["[step]", f"Frequency sweep - {number}", titles, "rad/s\tMPa\tMPa\t\t°C\ts"]
        text += lines(rows(kelvin), lambda i, r: [r.omega, r.modulus.real / 1e6,
            r.modulus.imag / 1e6, r.tan, r.celsius, 12.0 * i], "\t")  # fmt: skip
    path.write_text("\n".join(text), encoding="utf-8")


def ares(path: Path) -> None:
    """Rheometrics ARES: shear, dyn/cm², a title and a unit line, blanks."""
    body = lines(rows(), lambda i, r: [r.omega, r.modulus.real / 0.3, r.modulus.imag / 0.3, r.tan,
        r.celsius, 0.1], "   ")  # fmt: skip
    head = ["Freq   G'   G\"   tan_delta   Temp   Strain", "rad/s   dyn/cm²   dyn/cm²   -   °C   %"]
    path.write_text("\n".join([*head, *body]), encoding="latin-1")


def metravib(path: Path) -> None:
    """Metravib: |E*| and tan delta, no E', decimal comma, tabs."""
    body = lines(rows(), lambda i, r: [r.celsius, r.hertz, 1e-5, abs(r.modulus), r.tan], "\t", ",")
    title = "Temperature (°C)\tFrequency (Hz)\tDisplacement (m)\t|E*| (Pa)\tTan delta"
    path.write_text("\n".join(["METRAVIB DMA+450", title, *body]), encoding="utf-8-sig")


def rheocompass(path: Path) -> None:
    """Anton Paar RheoCompass in German: UTF-16, decimal comma, an empty first column, G."""
    head = ["Projekt:\tReifen", "Ergebnis:\tFrequenzsweep 1", "Intervall und Datenpunkte:\t1\t21"]
    titles = ["Intervalldaten:\tMesspunkt\tKreisfrequenz\tSpeichermodul\tVerlustmodul"
              "\tVerlustfaktor\tTemperatur", "\t\t[rad/s]\t[Pa]\t[Pa]\t[1]\t[°C]"]  # fmt: skip
    body = lines(rows(), lambda i, r: ["", i, r.omega, r.modulus.real / 3, r.modulus.imag / 3,
        r.tan, r.celsius], "\t", ",")  # fmt: skip
    path.write_bytes("\r\n".join([*head, "", *titles, *body]).encode("utf-16"))


def trios_steps(path: Path) -> None:
    """TRIOS with steps that condition the sample, whose tables have no moduli."""
    text = ["Filename\ttread.tri", "Instrument name\tRSA-G2", "", "[step]",
            "Conditioning Options - 1", "Step time\tTemperature\tGap", "s\t°C\tmm",
            "1\t20.0\t10.0", "2\t20.0\t10.0", ""]  # fmt: skip
    for number, kelvin in enumerate(KELVIN, start=1):
        text += ["[step]", f"Conditioning Sample - {number}", "Time\tTemperature\tAxial force\tGap",
                 "s\t°C\tN\tmm", f"60\t{kelvin - 273.15:.1f}\t0.1\t10.0", "", "[step]",
                 f"Frequency sweep - {number}",
                 "Angular frequency\tStorage modulus E'\tLoss modulus E''\tTemperature",
                 "rad/s\tMPa\tMPa\t°C"]  # fmt: skip
        text += lines(rows(kelvin), lambda i, r: [r.omega, r.modulus.real / 1e6,
            r.modulus.imag / 1e6, r.celsius], "\t")  # fmt: skip
        text.append("")
    path.write_text("\n".join(text), encoding="utf-8")


def workbook(path: Path) -> None:
    """Excel with a cover sheet, a remark beside the table, two lines of titles, K."""
    book = openpyxl.Workbook()
    cover = book.active
    cover.title = "Cover"
    for line in (["Laboratory", "N. N."], ["Order", 4711], [None, "natural rubber, filled"]):
        cover.append(line)
    sheet = book.create_sheet("Frequency sweeps")
    sheet.append([None, "Customer", "N. N."])
    sheet.append([None])
    sheet.append([None, "Temperature", "Frequency", "Storage modulus E'", "Loss modulus E''"])
    sheet.append([None, "K", "Hz", "MPa", "MPa", None, "dried at 40 °C"])
    for row in rows():
        e = row.modulus / 1e6
        sheet.append([None, row.kelvin, row.hertz, round(e.real, 6), round(e.imag, 6)])
    book.save(path)


def one_table_each(path: Path) -> None:
    """A table for each temperature, which stands above it; storage modulus and tan delta, GPa."""
    text = ["DMA Q800 V21.3"]
    for kelvin in KELVIN:
        text += ["", f"Temperature: {kelvin - 273.15:g} °C", "Frequency (Hz),E' (GPa),tan delta"]
        text += lines(rows(kelvin), lambda i, r: [r.hertz, r.modulus.real / 1e9, r.tan], ",")
    path.write_text("\n".join(text), encoding="utf-8")


def master(path: Path) -> None:
    """A master curve with its reference temperature above it, G' and G'' in psi over rad/s."""
    body = lines(rows(293.15), lambda i, r: [r.omega, r.modulus.real / 3 / 6894.757293168361,
        r.modulus.imag / 3 / 6894.757293168361], ",")  # fmt: skip
    head = ["Mastercurve, Tref = 20 °C", "omega [rad/s],G' [psi],G'' [psi]"]
    path.write_text("\n".join([*head, *body]), encoding="utf-8")


def master_in_german(path: Path) -> None:
    """A master curve in a sheet of Excel whose cells are texts with decimal commas."""
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["Masterkurve"])
    sheet.append(["Frequenz [Hz]", "Speichermodul E' [N/mm²]", "Verlustmodul E'' [N/mm²]"])
    for line in lines(rows(293.15), lambda i, r: [r.hertz, r.modulus.real / 1e6,
            r.modulus.imag / 1e6], "\t", ","):  # fmt: skip
        sheet.append(line.split("\t"))
    book.save(path)


def counted(path: Path) -> None:
    """Numbers above the rows that look like rows: the count of rows and columns, a date."""
    body = lines(rows(293.15), lambda i, r: [r.hertz, r.modulus.real, r.modulus.imag], " ")
    head = ["7 3", "2024 11 22", "f/Hz E'/Pa E''/Pa"]
    path.write_text("\n".join([*head, *body]), encoding="utf-8")


def logarithms(path: Path) -> None:
    """A master curve over log f, the moduli as logarithms, too."""
    body = lines(rows(293.15), lambda i, r: [np.log10(r.hertz), np.log10(r.modulus.real),
        np.log10(r.modulus.imag)], "\t", ",")  # fmt: skip
    path.write_text("\n".join(["log f [Hz]\tlog E' [Pa]\tlog E'' [Pa]", *body]), encoding="utf-8")


def shifted_logarithms(path: Path) -> None:
    """A master curve over log(aT omega) in brackets, the moduli as they are."""
    body = lines(rows(293.15), lambda i, r: [np.log10(r.omega), r.modulus.real / 1e6,
        r.modulus.imag / 1e6], ";")  # fmt: skip
    titles = "log(aT*omega [rad/s]);E' [MPa];E'' [MPa]"
    path.write_text("\n".join([titles, *body]), encoding="utf-8")


@dataclass(frozen=True)
class Format:
    """How a laboratory writes, and what it leaves out."""

    write: Callable[[Path], None]
    suffix: str
    add: dict[str, Any] = field(default_factory=dict)
    refused: str = ""
    """What the refusal without the addition says."""


SWEEPS = [
    Format(eplexor, ".csv"),
    Format(trios, ".txt", {"modulus": "E"}, "modulus must be given (E for Young's or G for shear)"),
    Format(ares, ".dat"),
    Format(metravib, ".txt"),
    Format(rheocompass, ".csv", {"modulus": "G"}, "modulus must be given"),
    Format(workbook, ".xlsx"),
    Format(one_table_each, ".csv"),
    Format(trios_steps, ".txt"),
]
MASTERS = [
    Format(master, ".csv", {"reference_temperature": 293.15}),
    Format(master_in_german, ".xlsx"),
    Format(counted, ".txt", {"header": 2}, "line 2: expected 2 columns as in line 1; got 3"),
    Format(logarithms, ".txt"),
    Format(shifted_logarithms, ".csv"),
]


def written(one: Format, folder: Path) -> Path:
    path = folder / f"{one.write.__name__}{one.suffix}"
    one.write(path)
    return path


def refuse(one: Format, path: Path, read: Callable[..., Any]) -> None:
    if one.refused:
        with pytest.raises((InputError, OSError)) as caught:
            read(path)
        assert one.refused in str(caught.value)
        assert str(path) in str(caught.value)


@pytest.mark.parametrize("one", SWEEPS, ids=lambda one: one.write.__name__)
def test_sweeps_of_a_laboratory(tmp_path: Path, one: Format) -> None:
    path = written(one, tmp_path)
    assert holds_sweeps(path)
    refuse(one, path, gs.read_sweeps)
    found = gs.read_sweeps(path, **one.add)
    assert found.temperatures == pytest.approx(KELVIN)
    expected = np.array([row.modulus for row in rows()])
    np.testing.assert_allclose(found.frequency, [row.hertz for row in rows()], rtol=DIGITS)
    np.testing.assert_allclose(found.storage, expected.real, rtol=DIGITS)
    np.testing.assert_allclose(found.loss, expected.imag, rtol=2 * DIGITS)


@pytest.mark.parametrize("one", MASTERS, ids=lambda one: one.write.__name__)
def test_master_curves_of_a_laboratory(tmp_path: Path, one: Format) -> None:
    path = written(one, tmp_path)
    refuse(one, path, gs.read_master_curve)
    found = gs.read_master_curve(path, **one.add)
    expected = np.array([row.modulus for row in rows(293.15)])
    # a logarithm of six digits is right to half of 1e-5 times ln 10
    digits = 1.2 * DIGITS
    np.testing.assert_allclose(found.frequency, HERTZ, rtol=digits)
    np.testing.assert_allclose(found.storage, expected.real, rtol=digits)
    np.testing.assert_allclose(found.loss, expected.imag, rtol=digits)


def test_temperature_above_a_master_curve_is_its_reference(tmp_path: Path) -> None:
    path = tmp_path / "curve.txt"
    text = "T = 20 °C\nf [Hz],E' [MPa],E'' [MPa]\n1,2,0.2\n10,3,0.3\n"
    path.write_text(text, encoding="utf-8")
    assert gs.read_master_curve(path).reference_temperature == pytest.approx(293.15)
    other = gs.read_master_curve(path, reference_temperature=300.0)
    assert other.reference_temperature == 300.0
    path.write_text(text.replace(" °C", ""), encoding="utf-8")
    with pytest.raises(InputError, match=r"temperature_unit must be given \(K, C, F\)"):
        gs.read_master_curve(path)
    found = gs.read_master_curve(path, temperature_unit="C")
    assert found.reference_temperature == pytest.approx(293.15)


MARKED = [f"{kelvin - 273.15:g} °C" for kelvin in KELVIN]
"""Temperatures over the blocks of a table."""


def printed(number: float, decimal: str = ".") -> str:
    return f"{number:.6g}".replace(".", decimal)


def moduli(hertz: float, *parts: str, decimal: str = ".", kelvin: Any = KELVIN) -> list[str]:
    """The moduli of one frequency in MPa, by default E' and E'' of each temperature in turn."""
    cells = []
    for part in parts or ("both",):
        for row in (Row(one, hertz) for one in kelvin):
            e = row.modulus / 1e6
            numbers = {"real": [e.real], "imag": [e.imag], "both": [e.real, e.imag]}[part]
            cells += [printed(number, decimal) for number in numbers]
    return cells


def merged(path: Path) -> None:
    """A temperature over each block, as of merged cells; German."""
    head = ["Labor N. N.;;", ";" + ";;".join(MARKED) + ";",
            "Frequenz [Hz]" + ";Speichermodul E' [MPa];Verlustmodul E'' [MPa]" * 3]  # fmt: skip
    body = [";".join([printed(f, ","), *moduli(f, decimal=",")]) for f in HERTZ]
    path.write_text("\r\n".join([*head, *body]), encoding="cp1252")


def centred(path: Path) -> None:
    """The temperature over the second column of its block, the unit below the titles, tan delta."""
    head = ["\t\t" + "\t\t\t".join(MARKED) + "\t", "f" + "\tE'\tE''\ttan d" * 3,
            "Hz" + "\tMPa\tMPa\t-" * 3]  # fmt: skip
    body = []
    for f in HERTZ:
        cells = moduli(f)
        for at in (4, 2, 0):
            cells.insert(at + 2, printed(float(cells[at + 1]) / float(cells[at])))
        body.append("\t".join([printed(f), *cells]))
    path.write_text("\n".join([*head, *body]), encoding="utf-8")


def in_titles(path: Path) -> None:
    """The temperature in each title, of one line."""
    pairs = [f"E' ({mark}) / MPa,E'' ({mark}) / MPa" for mark in MARKED]
    body = [",".join([printed(f), *moduli(f)]) for f in HERTZ]
    path.write_text("\n".join([",".join(["f / Hz", *pairs]), *body]), encoding="utf-8")


def modulus_by_modulus(path: Path) -> None:
    """E' of all temperatures, then E'' of all."""
    head = [";E' [MPa];;;E'' [MPa];;", "f [Hz];" + ";".join(MARKED * 2)]
    body = [";".join([printed(f), *moduli(f, "real", "imag")]) for f in HERTZ]
    path.write_text("\n".join([*head, *body]), encoding="utf-8")


def frequency_each(path: Path) -> None:
    """A column of frequencies in each block, one of them a row longer and with a missing value."""
    head = ["\t\t\t".join(MARKED) + "\t\t", "\t".join(["Frequency\tE'\tE''"] * 3),
            "\t".join(["Hz\tMPa\tMPa"] * 3)]  # fmt: skip
    body = []
    for f in HERTZ:
        cells = moduli(f)
        body.append("\t".join(t for at in (0, 2, 4) for t in (printed(f), *cells[at : at + 2])))
    body.append(f"60\t#N/A\t1.0{6 * chr(9)}")
    path.write_text("\n".join([*head, *body]), encoding="utf-8")


def numbers_in_excel(path: Path) -> None:
    """Temperatures as plain numbers of cells, with their unit in the first."""
    book = openpyxl.Workbook()
    sheet = book.active
    celsius = [value for kelvin in KELVIN for value in (kelvin - 273.15, None)]
    sheet.append(["Temperature [°C]", *celsius])
    sheet.append(["Frequency", *["E'", "E''"] * 3])
    sheet.append(["Hz", *["MPa"] * 6])
    for f in HERTZ:
        sheet.append([float(f), *map(float, moduli(f))])
    book.save(path)


def sheet_each(path: Path) -> None:
    """A sheet for each temperature, named by it, behind a cover."""
    book = openpyxl.Workbook()
    book.active.append(["Order", 4711])
    for mark, kelvin in zip(MARKED, KELVIN, strict=True):
        sheet = book.create_sheet(mark)
        sheet.append(["f [Hz]", "E' [MPa]", "E'' [MPa]"])
        for f in HERTZ:
            sheet.append([float(f), *map(float, moduli(f, kelvin=[kelvin]))])
    book.save(path)


BLOCKS = [
    (merged, ".csv"),
    (centred, ".txt"),
    (in_titles, ".csv"),
    (modulus_by_modulus, ".csv"),
    (frequency_each, ".txt"),
    (numbers_in_excel, ".xlsx"),
    (sheet_each, ".xlsx"),
]


@pytest.mark.parametrize(("write", "suffix"), BLOCKS, ids=lambda one: getattr(one, "__name__", one))
def test_blocks_of_temperatures_side_by_side(
    tmp_path: Path, write: Callable[[Path], None], suffix: str
) -> None:
    path = written(Format(write, suffix), tmp_path)
    assert holds_sweeps(path)
    found = gs.read_sweeps(path)
    assert found.temperatures == pytest.approx(KELVIN)
    expected = np.array([row.modulus for row in rows()])
    np.testing.assert_allclose(found.frequency, [row.hertz for row in rows()], rtol=DIGITS)
    np.testing.assert_allclose(found.storage, expected.real, rtol=DIGITS)
    np.testing.assert_allclose(found.loss, expected.imag, rtol=DIGITS)


def test_each_block_has_its_own_frequencies(tmp_path: Path) -> None:
    path = tmp_path / "dma.csv"
    titles = ["0 °C;;;20 °C;;", "f [Hz];E' [MPa];E'' [MPa];f [Hz];E' [MPa];E'' [MPa]"]
    body = ["1;9;1;2;8;1", "10;10;1;20;9;1", ";;;200;10;1"]
    path.write_text("\n".join([*titles, *body]), encoding="utf-8")
    assert gs.read_sweeps(path).frequency == pytest.approx([1.0, 10.0, 2.0, 20.0, 200.0])


def test_a_fault_in_a_block_names_its_line(tmp_path: Path) -> None:
    path = written(Format(in_titles, ".csv"), tmp_path)
    text = path.read_text(encoding="utf-8").splitlines()
    text[4] = text[4].replace(text[4].split(",")[3], "broken")
    path.write_text("\n".join(text), encoding="utf-8")
    with pytest.raises(FileError, match=r"line 5: expected a number in column E'; got 'broken'"):
        gs.read_sweeps(path)


def test_blocks_of_frequencies_are_ramps(tmp_path: Path) -> None:
    """Netzsch: E'(1.000 Hz)/MPa over temperature."""
    path, frequencies = tmp_path / "ramp.csv", (1.0, 10.0)
    celsius = np.arange(-10.0, 31.0, 2.0)
    titles = (f"E'({f:.3f} Hz)/MPa;E''({f:.3f} Hz)/MPa" for f in frequencies)
    text = [";".join(["Temp./°C", *titles])]
    for t in celsius:
        cells = [c for f in frequencies for c in moduli(f, kelvin=[t + 273.15])]
        text.append(";".join([f"{t:g}", *cells]))
    path.write_text("\n".join(text), encoding="utf-8")
    found = gs.read_sweeps(path, temperature_step=10.0)
    assert found.temperatures == pytest.approx([263.15, 273.15, 283.15, 293.15, 303.15])
    expected = [
        Row(kelvin, hertz).modulus.real for kelvin in found.temperatures for hertz in (1, 10)
    ]
    np.testing.assert_allclose(found.storage, expected, rtol=DIGITS)


RAMP = ["T [°C];E' [MPa];E'' [MPa]", "-10;20;4", "0;10;2", "10;5;1"]


@pytest.mark.parametrize("line", ["Frequency: 10 Hz", "Messfrequenz [Hz];10,0", "f = 0.01 kHz"])
def test_one_frequency_of_a_ramp_stands_above_it(tmp_path: Path, line: str) -> None:
    path = tmp_path / "ramp.csv"
    path.write_text("\n".join([line, *RAMP]), encoding="utf-8")
    assert holds_sweeps(path)
    found = gs.read_sweeps(path, tolerance=0.0)
    assert found.frequency == pytest.approx(np.full(3, 10.0))
    assert found.is_ramp


@pytest.mark.parametrize("frequency", [10.0, "10 Hz", "0.01 kHz"])
def test_one_frequency_of_a_ramp_may_be_stated(tmp_path: Path, frequency: Any) -> None:
    path = tmp_path / "ramp.csv"
    path.write_text("\n".join(RAMP), encoding="utf-8")
    with pytest.raises(InputError, match=r'frequency states it, such as "10 Hz"'):
        gs.read_sweeps(path)
    found = gs.read_sweeps(path, frequency=frequency, tolerance=0.0)
    assert found.frequency == pytest.approx(np.full(3, 10.0))
    assert found.storage == pytest.approx([20e6, 10e6, 5e6])


def test_a_frequency_beside_a_column_of_frequencies_is_refused(tmp_path: Path) -> None:
    path = written(Format(eplexor, ".csv"), tmp_path)
    with pytest.raises(InputError, match="frequency must be left out, because a column holds"):
        gs.read_sweeps(path, frequency=10.0)
    with pytest.raises(InputError, match="frequency = '10 N': unknown unit 'N'; expected one of"):
        gs.read_sweeps(path, frequency="10 N")


def test_frequency_and_angular_frequency_may_stand_in_one_table(tmp_path: Path) -> None:
    path = tmp_path / "dma.csv"
    titles = "omega [rad/s],f [Hz],E' [MPa],E'' [MPa],T [°C]"
    path.write_text(f"{titles}\n6.28,1,2,0.2,20\n62.8,10,3,0.3,20\n", encoding="utf-8")
    assert gs.read_sweeps(path).frequency == pytest.approx([1.0, 10.0], rel=1e-3)
    path.write_text(f"{titles}\n6.28,2,2,0.2,20\n62.8,10,3,0.3,20\n", encoding="utf-8")
    with pytest.raises(InputError, match="columns must say which is the frequency"):
        gs.read_sweeps(path)


def test_compliances_of_creep_are_named(tmp_path: Path) -> None:
    path = tmp_path / "creep.csv"
    path.write_text("T [°C],f [Hz],J [1/MPa],compliance [1/MPa]\n20,1,2,3\n", encoding="utf-8")
    with pytest.raises(InputError, match="of compliances J' and J''"):
        gs.read_sweeps(path)
