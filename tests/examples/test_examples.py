"""Every example runs from anywhere, without a warning, and finds what it should."""

import importlib.util
import re
import runpy
import subprocess
import sys

import numpy as np
import pytest

import gripscale as gs
from tests.samples import EXAMPLES, HALF_PLANE, case_text, write_short_road

COARSE = "64"
"""Columns of the mesh where an example takes them."""
TESTED_ELSEWHERE = {"finite_strain_rubber"}


@pytest.fixture
def start(tmp_path, monkeypatch, capfd):
    """Run an example in `tmp_path`, its warnings as errors; return what it prints."""

    def run(name, *arguments):
        path = str(EXAMPLES / f"{name}.py")
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", [path, *arguments])
        runpy.run_path(path, run_name="__main__")
        printed, complaints = capfd.readouterr()
        assert not complaints
        return printed

    return run


@pytest.fixture(scope="module")
def small_case(tmp_path_factory):
    """A road of 0.1 m and a rubber of two relaxations."""
    folder = tmp_path_factory.mktemp("small")
    write_short_road(folder)
    surface = 'files = ["road.txt"]\nscales = 2\nsmallest_wavelength = "2 mm"'
    text = case_text(surface, 'file = "dma.txt"\nterms = 4', HALF_PLANE)
    (folder / "case.toml").write_text(text, encoding="utf-8")
    return folder / "case.toml"


def module_of(name):
    """Import an example."""
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def start_alone(name, folder, *arguments):
    """Run an example in `folder` in a process of its own; return what it prints."""
    command = [sys.executable, "-W", "error", str(EXAMPLES / f"{name}.py"), *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    return done.stdout


@pytest.fixture
def run(start, tmp_path):
    """Run an example in a folder of its own; return what it prints and the figures it saves."""

    def run(name, *arguments):
        figures = tmp_path / "figures"
        printed = start(name, str(figures), *arguments)
        assert [path.name for path in tmp_path.iterdir()] == ["figures"]
        saved = list(figures.glob(f"{name}*.png"))
        assert saved
        assert min(path.stat().st_size for path in saved) > 10_000
        return printed

    return run


def numbers(pattern, text):
    """Return the numbers a pattern catches in its first match."""
    found = re.search(pattern, text)
    assert found, text
    return [float(value) for value in found.groups()]


def test_every_example_is_tested():
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {path.stem for path in EXAMPLES.glob("*.py")} <= tested | TESTED_ELSEWHERE


def test_one_wave(run):
    printed = run("one_wave", "96")
    rows = [[float(v) for v in line.split()[:6]] for line in printed.splitlines()[1:5]]
    slope, block, plane, block_friction, plane_friction, stretch = zip(*rows, strict=True)
    assert slope == (0.05, 0.3, 0.6, 0.9)
    # Small strain scales with the slope, whatever it is; at small slope the models agree.
    assert plane_friction[-1] / plane_friction[0] == pytest.approx(18.0, rel=0.01)
    assert block[0] == pytest.approx(plane[0], abs=0.01)
    assert block_friction[0] == pytest.approx(plane_friction[0], rel=0.01)
    # At large slope they part: 0.311 against 0.3215 on 192 columns, contact 0.533 against 0.551.
    assert block_friction[-1] / plane_friction[-1] == pytest.approx(0.968, abs=0.015)
    assert plane[-1] - block[-1] == pytest.approx(0.018, abs=0.008)
    assert stretch[-1] > 1.5


def test_speed_sweep(run):
    printed = run("speed_sweep", COARSE)
    largest, speed = numbers(r"largest, ([\d.]+), at ([\d.e+-]+) m/s", printed)
    assert largest == pytest.approx(0.193, abs=0.01)
    assert 10.0 < speed < 100.0
    slow, fast = numbers(r"contact ([\d.]+) slow, ([\d.]+) fast", printed)
    assert slow == pytest.approx(1.0, abs=0.01)
    assert fast < 0.1
    (iterations,) = numbers(r"([\d.]+) Newton iterations", printed)
    assert iterations < 15.0  # on all meshes together; cold starts take about 40


def test_start_stop_reversal(run):
    printed = run("start_stop_reversal", COARSE)
    forth, back, largest = numbers(r"forth ([\d.-]+), back ([\d.-]+), largest ([\d.]+)", printed)
    (steady,) = numbers(r"steady state ([\d.]+)", printed)
    assert forth == pytest.approx(steady, rel=0.03)
    assert back == pytest.approx(-steady, rel=0.03)
    assert largest > 1.05 * steady
    before, after = numbers(r"grows from ([\d.]+) to ([\d.]+)", printed)
    assert after > before + 0.1


def test_own_rubber(run):
    printed = run("own_rubber")
    assert numbers(r"E' ([\d.]+)%, E'' ([\d.]+)%", printed) == pytest.approx([9.0, 8.7], abs=0.5)
    lost = [float(value) for value in re.findall(r", ([\d.]+) MJ/m\^3 lost", printed)]
    # The permanent network loses nothing, and the temporary ones are the same in all three.
    assert lost == pytest.approx([0.89] * 3, abs=0.02)


def test_master_curve_from_sweeps(run):
    printed = run("master_curve_from_sweeps")
    hot, published = numbers(r"at 100 °C: (-[\d.]+), published (-[\d.]+)", printed)
    assert published == pytest.approx(-19.0, abs=0.05)
    assert hot == pytest.approx(published, abs=0.5)  # two standard errors of the sum of 14 steps
    own, theirs = (float(v) for v in re.findall(r"up to ([\d.]+) decades, \w+ shift", printed))
    assert own < 0.5 * theirs
    (cold, _), (warm, _) = re.findall(r"E' (\d+) MPa, E'' (\d+) MPa", printed)
    # As measured at 1 Hz and 40 °C, 4049 MPa, and at -5 °C, 7475 MPa.
    assert float(warm) == pytest.approx(4049.0, rel=0.05)
    assert float(cold) == pytest.approx(7475.0, rel=0.1)


def test_measured_surface(run):
    printed = run("measured_surface")
    (hurst,) = numbers(r"Hurst exponent ([\d.]+)", printed)
    assert hurst == pytest.approx(0.87, abs=0.02)
    residuals = [float(value) for value in re.findall(r"residual ([\d.]+)", printed)]
    assert residuals[0] > residuals[1] > 0.0
    assert residuals[2] < 0.06


def test_toy_model(tmp_path):
    printed = start_alone("toy_model", tmp_path, "out")
    rows = [line.split() for line in printed.splitlines() if "converged" in line]
    assert [row[:4] for row in rows] == [
        [speed, "m/s", pressure, "bar"] for speed in ("0.01", "10") for pressure in ("1", "3")
    ]
    area = [float(row[5]) for row in rows]  # behind the friction
    # In proportion to the load, and the less the faster: the rubber is stiffer.
    assert area[1] / area[0] == pytest.approx(3.0, rel=0.01)
    assert area[3] / area[2] == pytest.approx(3.0, rel=0.01)
    assert area[2] < area[0]
    assert len(list((tmp_path / "out" / "toy_model" / "predictions").glob("*.nc"))) == 4


def test_toy_condition(start):
    printed = start("toy_condition", "out")
    pairs = re.findall(r"mm: friction ([\d.]+), ([\d.]+)", printed)
    plain, warm = np.array(pairs, dtype=float).T
    # Warmed by the waves above only; below its loss peak a warmer rubber has less friction.
    assert len(plain) == 3
    assert warm[0] == plain[0]
    assert (warm[1:] < 0.9 * plain[1:]).all()
    # The study solves the same chain again.
    slow, fast = (float(value) for value in re.findall(r"m/s: friction ([\d.]+)", printed))
    assert fast == pytest.approx(warm.sum(), abs=2e-4)
    assert slow < fast


@pytest.fixture(scope="module")
def area_term(tmp_path_factory):
    """What the example prints, and its folder."""
    folder = tmp_path_factory.mktemp("area_term")
    return start_alone("area_term", folder, "out"), folder / "out" / "area_term"


def test_area_term(area_term):
    printed, folder = area_term
    rows = re.findall(r"(\S+) to ([\d.e+-]+); true (\S+)", printed)
    held = [float(low) <= float(true) <= float(high) for low, high, true in rows]
    # four intervals of 90 %: three or all of them, with probability 0.95
    assert len(held) == 4
    assert sum(held) >= 3
    errors = [float(value) for value in re.findall(r"from the others: rms ([\d.]+)", printed)]
    assert len(errors) == 3
    assert max(errors) < 1.5 * 0.02  # the noise, and what the others leave open
    (wrong,) = numbers(r"constant stress: rms up to ([\d.]+)", printed)
    assert wrong > 5.0 * 0.02
    assert len(list((folder / "predictions").glob("*.nc"))) == 24


def test_the_synthetic_friction_is_what_its_source_says(area_term):
    """From the predictions of the example, which are at the points of the measurement."""
    module = module_of("area_term")
    friction = EXAMPLES / "measured_friction" / "synthetic_friction.csv"
    titles, *shipped = friction.read_text().splitlines()
    made_titles, *made = module.measure(area_term[1])
    assert made_titles == titles
    numbers_of = [
        [[float(cell) for cell in row.split(",")] for row in rows] for rows in (made, shipped)
    ]
    np.testing.assert_allclose(*numbers_of, rtol=0.0, atol=1.1e-3)  # the last digit of the friction
    stated = (EXAMPLES / "measured_friction" / "SOURCE.txt").read_text()
    for number in ("0.35 MPa", "-0.15 log10", "5 mm/s", "0.95 eV", "293.15 K", "deviation 0.02"):
        assert number in stated


def test_toy_question(small_case, tmp_path):
    """Its command, in a process of its own; the file it saves is one more kind of result."""
    command = [sys.executable, "-W", "error", "toy_question.py", small_case, "--output", tmp_path]
    printed = subprocess.run(
        command, cwd=EXAMPLES, capture_output=True, text=True, check=True
    ).stdout
    pressure, low, high = numbers(r"p = ([\d.]+) MPa \(([\d.]+) to ([\d.]+)\)", printed)
    assert low < pressure < high
    case = gs.read_case(small_case)
    nominal = case.load.pressure / 1e6
    assert pressure == pytest.approx(nominal / gs.answer(case).contact_fraction, rel=5e-3)
    assert "A point with its interval" in (tmp_path / "report.html").read_text()
    code = (
        f"import toy_question, gripscale as gs; gs.load({str(tmp_path / 'contact_pressure.nc')!r})"
    )
    subprocess.run([sys.executable, "-c", code], cwd=EXAMPLES, check=True)


def test_run_case(start, small_case, tmp_path):
    printed = start("run_case", str(small_case), "out")
    friction, area = numbers(r"μ = ([\d.]+) .*A_r/A_0 = ([\d.]+) ", printed)
    answer = gs.load(tmp_path / "out" / "answer.nc")
    assert area == pytest.approx(answer.contact_fraction, rel=5e-3)
    assert friction == pytest.approx(answer.friction, rel=5e-3)
    low, high = answer.friction_interval
    assert low < friction < high


def test_seal_leak(run):
    printed = run("seal_leak")
    leaks = [float(v) for v in re.findall(r"MPa +[\d.]+ +[\d.]+ um +(\S+)", printed)]
    assert len(leaks) == 6
    assert leaks == sorted(leaks, reverse=True)
    assert leaks[0] > 1e3 * leaks[4] > leaks[5] == 0.0
    assert "critical junction" in printed


@pytest.mark.verification
def test_wet_road(run):
    """Trapped water and the film that stays have nearly the same friction: two models."""
    printed = run("wet_road")
    (share,) = numbers(r"carries ([\d.]+)% of the load", printed)
    assert 10.0 < share < 35.0
    dry, wet = (
        *numbers(r"the friction ([\d.]+)\.", printed),
        *numbers(r"is ([\d.]+)\.\n", printed),
    )
    assert 0.6 < wet / dry < 0.85
    assert "Inertia of the water" in printed
