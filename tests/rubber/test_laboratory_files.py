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
from gripscale.core.errors import InputError
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


def test_two_names_for_a_loss_modulus_that_is_the_storage_modulus(tmp_path: Path) -> None:
    """The loss factor of the file tells."""
    path = tmp_path / "curve.txt"
    path.write_text("f [Hz],E'' [MPa],E' [MPa],tan delta\n1,2,0.2,0.1\n10,3,0.3,0.1\n")
    with pytest.raises(InputError, match="storage and loss modulus look exchanged, because the"):
        gs.read_master_curve(path)
