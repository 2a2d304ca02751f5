"""Bad input: one sentence on stderr that says what is wrong and what to do, exit code 2.

What is wrong with files and with keys of a case is tested with their readers.
"""

import os
import subprocess
import sys

import openpyxl
import pytest

from gripscale.questions.compare.comparison import COMPARED_OVER
from gripscale.theory import HalfPlane


def refused(result, *words):
    (sentence,) = result.stderr.splitlines()
    assert sentence.startswith("error: ")
    for part in words:
        assert part in result.stderr
    assert "Traceback" not in result.output


@pytest.fixture
def never_solved(monkeypatch):
    """Let nothing get as far as a solver."""

    def solve(*_):
        raise AssertionError("solved with bad input")

    monkeypatch.setattr(HalfPlane, "solve", solve)


@pytest.mark.usefixtures("never_solved")
@pytest.mark.parametrize(
    ("old", "new", "table", "key"),
    [
        ("pressure =", "presure =", "load", "pressure"),
        ("[load]", "[lood]", "", "pressure"),
        ("[load]", "[conditions]\nheat = { density = -1 }\n[load]", "conditions.heat", "density"),
        ('"road.txt"', '"rod.txt"', "surface", "files"),
        ('"dma.txt"', '"dna.txt"', "rubber", "frequency_unit"),
        ("[load]", '[conditions]\ntemperature = "60 C"\n[load]', "rubber.shift", "kind"),
        ("[load]", '[measured]\nfriction = "no.csv"\n[load]', "measured", "friction"),
    ],
)
def test_a_refusal_ends_with_the_command_that_lists_the_keys(shell, changed, old, new, table, key):
    words, case = ["keys", *filter(None, [table])], changed(old, new)
    refused(shell("run", case, code=2), f"ee `{' '.join(['gripscale', *words])}`\n")
    assert key in shell(*words).stdout.split()
    assert sorted(p.name for p in case.parent.iterdir()) == ["case.toml", "dma.txt", "road.txt"]


@pytest.mark.usefixtures("never_solved")
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("road.txt", ""),
        ("road.txt", "x [mm]\tz [mm]\n" + "".join(f"{i}\tnan\n" for i in range(50))),
        ("dma.txt", "# Frequency (Hz) E' (MPa) E'' (MPa)\n1 2 x\n2 3 4\n"),
    ],
)
def test_bad_measurement_is_refused(shell, changed, name, text):
    case = changed()
    (case.parent / name).write_text(text)
    refused(shell("run", case, code=2), name)
    assert not (case.parent / "results").exists()


@pytest.mark.usefixtures("never_solved")
def test_file_in_place_of_the_output_folder(shell, changed):
    case = changed()
    blocked = case.parent / "results"
    blocked.write_text("in the way")
    refused(shell("run", case, code=2), "results cannot be made", "is not a folder")
    refused(shell("run", case, "--output", blocked / "deeper", code=2), "deeper cannot be made")
    assert blocked.read_text() == "in the way"


def two_sheets(folder):
    book = openpyxl.Workbook()
    for name in ("20 C", "40 C"):
        sheet = book.create_sheet(name)
        for row in (["f (Hz)", "E' (MPa)", "E'' (MPa)"], [1, 2, 0.2], [10, 3, 0.3]):
            sheet.append(row)
    book.save(folder / "dma.xlsx")
    return ["fit-rubber", folder / "dma.xlsx"]


OF_A_CASE = [
    (["compare", "--vary", "rubber=case"], f"vary must be one of {', '.join(COMPARED_OVER)};"),
    (["compare", "--vary", "speed=0.3"], "speed must have at least two values; got 0.3"),
    (["compare", "--models", "persion"], "unknown model persion; did you mean persson?"),
    (["compare", "--seeds", "0"], "seeds must be a whole number from 1 to 1000; got 0"),
    (["compare", "--measured", "none.csv"], "none.csv: cannot be read (no such file)"),
    (["compare", "--models", "klueppel_heinrich"],
     "no model of klueppel_heinrich applies to this case"),
    (["study", "--vary", "speed=1", "--vary", "speed=2"], "vary must name different inputs"),
    (["study", "--vary", "speed=1", "--workers", "0"], "workers must be a whole number from 1"),
    (["study", "--vary", "surface=none.txt"], "surface none.txt is neither a file"),
    (["study", "--vary", "speed=1", "--cluster", "here"], 'cluster must be "local" or the address'),
    (["uncertainty", "--range", "cut_off"], "range must be such as"),
    (["uncertainty", "--model", "all"], "model must be one of"),
    (["uncertainty", "--without", "weather"], "unknown source weather"),
    (["cut-off", "--down-to", "soon"], "--down-to = 'soon'"),
    (["calibrate"], "[measured] friction must name a table of measured friction; got none"),
]  # fmt: skip
OF_THE_FIT = [
    (["--law", "bell"], "law must be one of constant, gaussian, le_gal_klueppel; got 'bell'"),
    (["--model", "wave"], "model must be one of direct, chain; got 'wave'"),
    (["--hold-out", "p"], "hold_out must be one of temperature, speed; got 'p'"),
    (["--fixed", "widt=1"], "unknown parameter widt; did you mean width?"),
    (["--fixed", "width"], 'fixed must be such as "width=0.1"; got'),
    (["--fixed", "width=a"], "fixed width = 'a': expected a number"),
    (["--fixed", "stress_0=3"], "fixed stress_0 = '3': the unit is missing; expected one of"),
]
MISTAKES = [
    (lambda at: ["run", at / "case"], "case does not exist"),
    (lambda at: ["run", at / "dma.txt"], "dma.txt is no case file (TOML); `gripscale"),
    (lambda at: ["report", at / "case.toml"], "case.toml is a case, not a result: `gripscale run`"),
    (lambda at: ["report", at / "dma.txt"], "netCDF result: it is of another format"),
    (two_sheets, "--reference-temperature must be given, such as \"20 C\", for sweeps at 2 te"),
    (lambda at: ["fit-rubber", at / "none.txt"], "none.txt: cannot be read (no such file)"),
    (lambda at: ["fit-rubber", at / "dma.txt", "--terms", "0"], "options: terms = 0: expected a w"),
    (lambda at: ["fit-rubber", at / "dma.txt", "--bulk-modulus", "soft"], "bulk_modulus = 'soft'"),
    (lambda at: ["fit-rubber", at / "dma.txt", "--bulk-modulus", "1 Pa"], "bulk_modulus"),
    (lambda at: ["fit-rubber", at / "dma.txt", "--reference-temperature", "20"],
     "reference_temperature = '20': the unit"),
    (lambda at: ["fit-rubber", at / "dma.txt", "--columns", "f,E',E''"],
     "among the header's names (Frequency, E', E'');"),
    (lambda at: ["fit-surface", at / "road.txt", "--scales", "0"], "options: scales = 0: expected"),
    (lambda at: ["fit-surface", at / "road.txt", "--crop", "1 mm", "1 ell"],
     "options: crop[1] = '1 ell': unknown unit"),
    (lambda at: ["compare-rubbers", "a.txt", "b.txt"], "--case must be given: the surface and"),
    (lambda at: ["compare-rubbers", at / "case.toml"], "rubbers must be 2 to 6 compounds to"),
    (lambda at: ["compare-rubbers", at / "case.toml", "styrene_butadiene", "--temperature", "20"],
     "temperature = '20': the unit is missing; expected one of K, C, F"),
    (lambda at: ["new", at, "--temperature", "20"], "temperature = '20': the unit is missing; exp"),
    (lambda at: ["study", at / "case.toml", "--vary", "temperature=0,20"],
     "must have a unit, such as"),
    (lambda at: ["study", at / "case.toml", "--vary", "rubber=case,dmo.txt"],
     "rubber dmo.txt is neit"),
    (lambda at: ["docs", "limit"], "unknown page limit; did you mean limits?"),
    *((lambda at, words=words: [words[0], at / "case.toml", *words[1:]], sentence)
      for words, sentence in OF_A_CASE),
    *((lambda at, options=options:
       ["calibrate", at / "case.toml", "--measured", at / "mu.csv", *options], sentence)
      for options, sentence in OF_THE_FIT),
]  # fmt: skip


@pytest.mark.usefixtures("never_solved")
@pytest.mark.parametrize(
    ("command", "words"),
    MISTAKES,
    ids=[f"{i}: {words[:30]}" for i, (_, words) in enumerate(MISTAKES)],
)
def test_a_mistake_is_one_sentence(shell, changed, command, words):
    folder = changed().parent
    (folder / "mu.csv").write_text("speed [m/s],friction\n" + "0.1,0.7\n1,0.8\n2,0.9\n" * 2)
    refused(shell(*command(folder), code=2), words)


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"3 bar"', '"32 psi"', "Results are in"),
        ('"100 mm"', '"1 mm"', "  The footprint, 1 mm, is shorter than the"),
    ],
)
def test_what_is_no_mistake_runs(shell, changed, old, new, words):
    result = shell("run", changed(old, new), columns=400)
    assert words in result.stdout


@pytest.mark.parametrize(
    "options",
    [
        ("--columns", "frequency=1,storage=2,loss=3", "--outlier-threshold", "inf"),
        ("--header", "1", "--terms", "6"),
    ],
)
def test_options_of_a_file_are_taken(shell, inputs, options):
    result = shell("fit-rubber", inputs / "dma.txt", *options)
    assert "Maxwell elements" in result.stdout


def test_a_shell_sees_the_sentence_and_the_code(changed):
    case = changed("scales = 3", "scale = 3")
    program = "from gripscale.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", program, "run", str(case)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        check=False,
    )
    see = " See `gripscale keys surface`\n"
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == f"error: {case}: unknown key [surface] scale; did you mean scales?" + see
