"""The finite-strain fit: known rubbers come back, measured loops as the page says, bad files."""

import re
import runpy

import numpy as np
import openpyxl
import pytest

from gripscale.core.errors import FileError, InputError
from gripscale.rubber import (
    MooneyRivlin,
    NeoHookean,
    Rubber,
    UniaxialTest,
    Yeoh,
    fit_finite_strain,
    read_uniaxial_test,
    rms_error,
    uniaxial_stress,
    work_error,
)
from tests.samples import ROOT

LOOPS = ROOT / "examples/data/rubber/finite_strain_vhb"
TIMES = np.geomspace(0.5, 500.0, 4)


def loop(rubber, peak, rate, name="made up"):
    up = np.linspace(1.0, peak, 60)
    stretch = np.concatenate([up, up[-2:10:-1]])
    time = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(stretch))) / rate])
    return UniaxialTest(name, time, stretch, uniaxial_stress(rubber, time, stretch))


@pytest.mark.parametrize(
    ("energy", "law"),
    [
        ("neo_hookean", NeoHookean()),
        ("mooney_rivlin", MooneyRivlin(0.3)),
        ("yeoh", Yeoh(-0.06, 0.005)),
    ],
)
def test_a_known_rubber_comes_back(energy, law):
    """Data made by the model on the fitted times: a consistent linear system, solved to rounding.

    Its condition number, a few thousand, times 1e-16 stays far below the 1e-6 asked.
    """
    true = Rubber(30e3, [60e3, 0.5e3, 40e3, 20e3], TIMES, strain_energy=law)
    tests = [loop(true, 1.5, 0.01), loop(true, 3.0, 0.01), loop(true, 3.0, 0.05)]
    fit = fit_finite_strain(tests, energy=energy, terms=4, band=(0.5, 500.0))
    assert fit.rubber.equilibrium_modulus == pytest.approx(30e3, rel=1e-6)
    assert fit.rubber.relaxation_times == pytest.approx(TIMES, rel=1e-12)
    assert fit.rubber.moduli == pytest.approx(true.moduli, rel=1e-6)
    found, expected = fit.rubber.strain_energy, law
    assert found.kind == energy
    assert found.parameters() == pytest.approx(expected.parameters(), rel=1e-6)
    assert fit.rms_errors == pytest.approx([0.0] * 3, abs=1e-10)
    assert fit.work_errors == pytest.approx([0.0] * 3, abs=1e-9)


def test_no_change_of_one_modulus_fits_better():
    """The minimum is one: 1 % more or less of any fitted coefficient raises the sum of squares."""
    tests = [read_uniaxial_test(path, stress_unit="kPa") for path in sorted(LOOPS.glob("*.xlsx"))]
    fit = fit_finite_strain(tests, energy="mooney_rivlin")
    best, rubber = float((fit.rms_errors**2).sum()), fit.rubber

    def squares(equilibrium, moduli):
        changed = Rubber(
            equilibrium, moduli, rubber.relaxation_times, strain_energy=rubber.strain_energy
        )
        return sum(rms_error(changed, test) ** 2 for test in tests)

    for factor in (0.99, 1.01):
        assert squares(factor * rubber.equilibrium_modulus, rubber.moduli) > best
        for place in range(len(rubber.moduli)):
            moduli = rubber.moduli.copy()
            moduli[place] *= factor
            assert squares(rubber.equilibrium_modulus, moduli) > best


def test_errors_are_relative_to_the_peak():
    """Stress 10 % too high throughout: rms is 10 % of the rms stress, work 10 %."""
    rubber = Rubber(30e3, [60e3], [10.0])
    made = loop(rubber, 2.0, 0.05)
    high = UniaxialTest("high", made.time, made.stretch, made.stress / 1.1)
    rms_stress = np.sqrt(np.mean(high.stress**2)) / high.stress.max()
    assert rms_error(rubber, high) == pytest.approx(0.1 * rms_stress, rel=1e-9)
    assert work_error(rubber, high) == pytest.approx(0.1, rel=1e-9)


def test_measured_loops_are_read_in_pascal():
    test = read_uniaxial_test(LOOPS / "loading_3d0_unloading_0d05.xlsx", stress_unit="kPa")
    assert len(test.time) == 91
    assert test.peak == pytest.approx(69663.9135)
    assert test.stretch.max() == pytest.approx(2.98100526)
    assert test.duration == pytest.approx(72.7588014)


def test_loading_at_one_rate_repeats():
    """Two specimens pulled at 0.01 /s agree to 0.6 % of the peak: the scatter a model may blame."""
    first, second = (
        read_uniaxial_test(LOOPS / f"loading_{peak}_unloading_0d01.xlsx", stress_unit="kPa")
        for peak in ("1d5", "3d0")
    )
    stretch = np.linspace(1.05, 1.49, 30)

    def loading(test):
        top = int(test.stretch.argmax()) + 1
        return np.interp(stretch, test.stretch[:top], test.stress[:top])

    scatter = np.sqrt(np.mean((loading(first) - loading(second)) ** 2)) / first.peak
    assert scatter == pytest.approx(0.006, abs=0.002)


NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?")


def test_the_page_states_what_the_example_prints(tmp_path, capsys):
    """Words exactly, numbers within one unit of the last digit shown."""
    runpy.run_path(str(ROOT / "examples/finite_strain_rubber.py"))["main"](str(tmp_path))
    printed = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| ")]
    page = (ROOT / "docs/material.md").read_text(encoding="utf-8").splitlines()
    start = page.index(printed[0])
    stated = [page[start], *page[start + 2 : start + 1 + len(printed)]]
    assert len(printed) == 13
    for line, expected in zip(printed, stated, strict=True):
        assert NUMBER.sub("#", line) == NUMBER.sub("#", expected)
        for got, said in zip(NUMBER.findall(line), NUMBER.findall(expected), strict=True):
            assert float(got) == pytest.approx(float(said), abs=1.01 if said[0] in "+-" else 0.101)
    assert (tmp_path / "finite_strain_vhb.png").stat().st_size > 10_000


GOOD = {"name": "x", "time": [0.0, 1.0], "stretch": [1.0, 2.0], "stress": [0.0, 1e4]}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time": [0.0]}, "same length, at least 2; got 1, 2 and 2"),
        ({"time": [0.0, 0.0]}, r"x: time must rise \[s\]; got 0 at index 1"),
        ({"stretch": [1.0, 0.0]}, "stretch must be greater than zero"),
        ({"stress": [0.0, np.nan]}, r"stress .*\[Pa\]; got nan at index 1"),
        ({"stress": [0.0, -1.0]}, r"x: stress must be above zero \[Pa\] somewhere"),
    ],
)
def test_bad_tests_are_named(change, message):
    with pytest.raises(InputError, match=message):
        UniaxialTest(**{**GOOD, **change})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tests": []}, "at least one UniaxialTest"),
        ({"energy": "ogden"}, "energy must be one of neo_hookean, mooney_rivlin, yeoh, isihara"),
        ({"terms": 0}, "terms must be a whole number from 1 to 40; got 0"),
        ({"band": (2.0, 1.0)}, r"band \[s\] must be a lower and a higher value; got \(2"),
        ({"band": (0.0, 1.0)}, "band must be greater than zero"),
    ],
)
def test_bad_arguments_are_named(change, message):
    arguments = {"tests": [UniaxialTest(**GOOD)], **change}
    with pytest.raises(InputError, match=message):
        fit_finite_strain(arguments.pop("tests"), **arguments)


def test_one_term_sits_in_the_middle_of_the_band():
    rubber = Rubber(30e3, [60e3], [10.0])
    fit = fit_finite_strain([loop(rubber, 2.0, 0.05)], terms=1, band=(1.0, 100.0))
    assert fit.rubber == Rubber(
        fit.rubber.equilibrium_modulus, fit.rubber.moduli, fit.rubber.relaxation_times
    )
    assert fit.rubber.relaxation_times == pytest.approx([10.0])
    assert fit.rubber.moduli == pytest.approx([60e3], rel=1e-6)


def write(path, rows):
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.save(path)
    return path


def test_bad_files_are_named(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        read_uniaxial_test(tmp_path / "none.xlsx")
    text = tmp_path / "text.xlsx"
    text.write_text("0 1 0\n")
    with pytest.raises(FileError, match=r"text\.xlsx: expected an xlsx file; got a damaged"):
        read_uniaxial_test(text)
    with pytest.raises(FileError, match="expected rows of time, stretch, stress"):
        read_uniaxial_test(write(tmp_path / "words.xlsx", [["time", "stretch", "stress"]]))
    with pytest.raises(FileError, match="expected rows of time, stretch, stress"):
        read_uniaxial_test(write(tmp_path / "narrow.xlsx", [[0, 1], [1, 2], [2, 3]]))
    with pytest.raises(FileError, match="at least 2; got 0"):
        read_uniaxial_test(write(tmp_path / "empty.xlsx", []))
    with pytest.raises(InputError, match="stress_unit must be one of"):
        read_uniaxial_test(text, stress_unit="torr")
