"""Mistakes of daily use: each one sentence that says what is wrong and what to do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import openpyxl
import pytest

from tests.samples import Shell

pytestmark = pytest.mark.usefixtures("undrawn")


@dataclass(frozen=True)
class Place:
    """A folder with a case, its road and its rubber, where mistakes are made."""

    folder: Path

    @property
    def case(self) -> Path:
        return self.folder / "case.toml"

    def say(self, old: str, new: str) -> list[str]:
        """Change the case; return the command that runs it."""
        text = self.case.read_text()
        assert old in text
        self.case.write_text(text.replace(old, new))
        return ["run", str(self.case)]

    def put(self, name: str, text: str) -> list[str]:
        """Write a file in place of one of the case; return the command that runs it."""
        (self.folder / name).write_text(text, encoding="utf-8")
        return ["run", str(self.case)]

    def fit(self, *options: str, name: str = "dma.txt") -> list[str]:
        return ["fit-rubber", str(self.folder / name), *options]

    def retitled(self, name: str, old: str, new: str) -> list[str]:
        """Write other titles over the numbers of a file; return the command that runs the case."""
        text = (self.folder / name).read_text()
        assert old in text
        return self.put(name, text.replace(old, new))


def two_sheets(at: Place) -> list[str]:
    book = openpyxl.Workbook()
    for name in ("20 C", "40 C"):
        sheet = book.create_sheet(name)
        for row in (["f (Hz)", "E' (MPa)", "E'' (MPa)"], [1, 2, 0.2], [10, 3, 0.3]):
            sheet.append(row)
    book.save(at.folder / "dma.xlsx")
    return at.fit(name="dma.xlsx")


def folder_for_a_file(at: Place) -> list[str]:
    (at.folder / "rubbers").mkdir()
    return at.say('"dma.txt"', '"rubbers"')


def old_excel(at: Place) -> list[str]:
    (at.folder / "dma.xls").write_bytes(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600))
    return at.fit(name="dma.xls")


DMA = "# Frequency (Hz) E' (MPa) E'' (MPa)"
ROAD = "x [mm]\tz [mm]"
SWEEPS = "T (C) f (Hz) E' (MPa) E'' (MPa)\n" + "".join(
    f"{celsius} {hertz} {5 - celsius / 20 + hertz / 50} {0.5 - celsius / 100}\n"
    for celsius in (0, 20)
    for hertz in (1, 3, 10, 30)
)
SEMICOLONS = "f (Hz);E' (MPa);E'' (MPa)\n"
UNITS = "expected one of Pa, kPa, psi, bar"

MISTAKES: list[tuple[Callable[[Place], list[str]], str]] = [
    # files
    (lambda at: at.fit(name="dmo.txt"), "dmo.txt: cannot be read (no such file)"),
    (lambda at: ["run", str(at.folder / "case")], "case does not exist"),
    (lambda at: at.say('"road.txt"', '"dma.txt"'), "dma.txt, line 2: expected two columns, distan"),
    (lambda at: at.say('file = "dma.txt"', 'file = "road.txt"'), "at least 3 columns (frequency,"),
    (folder_for_a_file, "rubbers: expected a file or a list of files; got a folder"),
    (lambda at: ["run", str(at.folder)], "cannot be read: Is a directory"),
    (lambda at: ["run", str(at.folder / "dma.txt")], "dma.txt is no case file (TOML); `gripscale"),
    (lambda at: ["report", str(at.case)], "case.toml is a case, not a result: `gripscale run` sol"),
    (lambda at: ["report", str(at.folder / "dma.txt")], "netCDF result: it is of another format"),
    (old_excel, "expected a text file; got an old Office file (.xls), to be saved as .xlsx"),
    (two_sheets, "--reference-temperature must be given, such as \"20 C\", for sweeps at 2 te"),
    # the case
    (lambda at: at.put("case.toml", ""), "an empty case; expected at least [surface], [rubber] an"),
    (lambda at: at.say("scales = 3", "scale = 3"), "unknown key [surface] scale; did you mean sca"),
    (lambda at: at.say('"dma.txt"', r'"C:\users\dma.txt"'), "a path is written with / or in 'sing"),
    (lambda at: at.say('"dma.txt"', r'"data\dma.txt"'), "a path is written with / or in 'single"),
    (lambda at: at.say('"0.3 m/s"', "0.3 m/s"), 'a number with its unit stands in "quotation mark'),
    (lambda at: at.say('"0.3 m/s"', "0,3"), "the decimal sign is the point"),
    (lambda at: at.say('"3 bar"', '"3"'), f"the unit is missing; {UNITS}"),
    (lambda at: at.say('"3 bar"', '"300 N"'), f"unknown unit 'N'; {UNITS}"),
    (lambda at: at.say('"0.3 m/s"', '"-0.3 m/s"'), "speed = '-0.3 m/s': expected zero or a positi"),
    (lambda at: at.say('"100 mm"', '"100"'), "footprint = '100': the unit is missing; expected on"),
    (lambda at: at.say("terms = 6", "reference_temperature = 20"), "the unit is missing; expected"),
    (lambda at: at.say("terms = 6", "columns = [0, 1, 2]"), "channels and sheets are counted from"),
    (lambda at: at.say("terms = 6", 'strain_energy = { kind = "yeoh", second = "2 %", third = 1 }'),
     "strain_energy: second = '2 %': expected a number"),
    # units and columns of files
    (lambda at: at.retitled("dma.txt", DMA, "# Frequency E' E''"), "frequency_unit must be given"),
    (lambda at: at.retitled("dma.txt", DMA, "# Frequency (Hz) E'' (MPa) E' (MPa)"),
     "dma.txt: storage and loss modulus look exchanged"),
    (lambda at: at.retitled("dma.txt", DMA, "# log f (Hz) E' (MPa) E'' (MPa)"),
     "line 32: expected a frequency between 1e-100 and 1e+100"),
    (lambda at: at.retitled("dma.txt", DMA, "f (Hz);E' (MPa);E''"), "no unit of E''"),
    (lambda at: at.retitled("dma.txt", DMA, "# f (Hz) E' (GPa) E'' (GPa)"), "is the unit of the m"),
    (lambda at: at.retitled("road.txt", ROAD, "x\tz"), "column 1 names no unit of length; write i"),
    (lambda at: at.retitled("road.txt", ROAD, "x [m]\tz [m]"), "leaves 3 of a profile from 0 mm"),
    (lambda at: at.put("dma.txt", SEMICOLONS + "1,5;2,0;0,2\n2.5;3,0;0,3\n"),
     "line 3: expected one decimal sign throughout; got '2.5' after '1,5' in line 2"),
    (lambda at: at.put("dma.txt", SEMICOLONS + "1;2;0,2\n3;4\n"), "line 3: expected 3 columns as"),
    (lambda at: at.put("dma.txt", f"{DMA}\n1 2 0.2\n10 3 0.3\n"), "dma.txt: master must have at l"),
    (lambda at: at.put("dma.txt", SWEEPS), "reference_temperature must be given, such as \"20 C\""),
    # options
    (lambda at: at.fit("--reference-temperature", "20"), "reference_temperature = '20': the unit"),
    (lambda at: at.fit("--columns", "0,1,2"), "columns, channels and sheets are counted from 1"),
    (lambda at: at.fit("--columns", "1,3,2"), "dma.txt: storage and loss modulus look exchanged"),
    (lambda at: at.fit("--columns", "f,E',E''"), "among the header's names (Frequency, E', E'');"),
    (lambda at: at.fit("--columns", "los=2"), "unknown quantity in columns los; did you mean loss"),
    (lambda at: at.fit("--header", "-1"), "header = -1: expected a whole number, at least 0"),
    (lambda at: ["compare-rubbers", "a.txt", "b.txt"], "--case must be given: the surface and"),
    (lambda at: ["compare-rubbers", str(at.case)], "rubbers must be 2 to 6 compounds to"),
    (lambda at: ["compare-rubbers", str(at.case), "styrene_butadiene", "--temperature", "20"],
     "temperature = '20': the unit is missing; expected one of K, C, F"),
    (lambda at: ["new", str(at.folder), "--temperature", "20"],
     "temperature = '20': the unit is missing; expected one of K, C, F"),
    (lambda at: ["study", str(at.case), "--vary", "temperature=0,20"], "must have a unit, such as"),
    (lambda at: ["study", str(at.case), "--vary", "rubber=case,dmo.txt"], "rubber dmo.txt is neit"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("make", "words"), MISTAKES, ids=[f"{i}: {words[:30]}" for i, (_, words) in enumerate(MISTAKES)]
)
def test_a_mistake_is_one_sentence(
    shell: Shell, changed: Callable[..., Path], make: Callable[[Place], list[str]], words: str
) -> None:
    result = shell(*make(Place(changed().parent)))
    assert result.exit_code == 2, result.output
    (sentence,) = result.stderr.splitlines()
    assert sentence.startswith("error: ")
    assert words in sentence


GOOD: list[tuple[Callable[[Place], list[str]], str]] = [
    (lambda at: at.say('"3 bar"', '"32 psi"'), "Results and report are in"),
    (lambda at: at.say('"100 mm"', '"1 mm"'), "  The footprint, 1 mm, is shorter than the"),
    (lambda at: at.fit("--columns", "frequency=1,storage=2,loss=3", "--outlier-threshold", "inf"),
     "Maxwell elements"),
    (lambda at: at.fit("--header", "1", "--terms", "6"), "Maxwell elements"),
]  # fmt: skip


@pytest.mark.parametrize(("make", "words"), GOOD, ids=["psi", "footprint", "columns", "header"])
def test_what_is_no_mistake_runs(
    shell: Shell, changed: Callable[..., Path], make: Callable[[Place], list[str]], words: str
) -> None:
    result = shell(*make(Place(changed().parent)), columns=400)
    assert result.exit_code == 0, result.output
    assert words in result.stdout
