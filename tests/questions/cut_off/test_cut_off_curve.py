"""Contact and friction against the cut-off: command, page, run, answer and rule."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.case import BelowMeasurement
from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.prepare import case_surface
from gripscale.continuation import HurstExponent, contact_by_cut_off
from gripscale.core.errors import InputError
from gripscale.io import netcdf
from gripscale.questions.cut_off.curve import AREA, FRICTION, at_cut_off, continuation_doubts
from gripscale.questions.cut_off.question import cut_off
from tests.half_space.rough_cases import isotropic_heights
from tests.samples import HALF_PLANE, case_text, write_short_road
from tests.verification.families import tread
from tests.verification.line_families import family_line
from tests.verification.withheld_octaves import coarser

SURFACE = 'files = ["road.txt"]\nscales = 3\ncut_off = "0.5 mm"'
RUBBER = 'file = "dma.txt"\nterms = 6'
BELOW = '\n[below_measurement]\ndown_to = "0.15 mm"\nhurst = 0.8\n'


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A case on 0.1 m of road with points every 0.1 mm."""
    folder = tmp_path_factory.mktemp("cut_off")
    write_short_road(folder)
    text = case_text(SURFACE, RUBBER, HALF_PLANE)
    (folder / "case.toml").write_text(text)
    (folder / "below.toml").write_text(text + BELOW)
    return folder


@pytest.fixture(scope="module")
def data(folder):
    return cut_off(read_case(folder / "below.toml"), folder=folder / "result").data


def test_the_curves_are_those_of_the_lines(folder, data):
    file = read_case_file(folder / "below.toml")
    surface = case_surface(file)
    case = read_case(folder / "below.toml")
    direct = contact_by_cut_off(
        case.rubber,
        surface.measured.cleaned,
        pressure=3e5,
        speed=0.3,
        down_to=0.15e-3,
        roughness=HurstExponent(0.8),
    )
    assert data.cut_off.values == pytest.approx(direct.wavelength)
    assert data[FRICTION].values == pytest.approx(direct.values("friction_from_dissipation"))
    assert data.total_friction_from_dissipation == pytest.approx(float(data[FRICTION][-1]))
    assert float(data.resolved) == pytest.approx(0.4e-3)
    assert len(list((folder / "result").rglob("*.nc"))) == 1  # what a second call finds
    assert data.curve_measured.values.tolist() == (data.cut_off.values > 0.39e-3).tolist()


def test_rules_lie_on_the_curve(data):
    rules = dict(zip(data.rule.values.tolist(), data.rule_cut_off.values.tolist(), strict=True))
    assert rules["cut-off of the case"] == pytest.approx(0.5e-3)
    assert rules["shortest wavelength measured"] == pytest.approx(0.4e-3)
    at = data.sel(rule="shortest wavelength measured")
    assert float(at.rule_friction) == pytest.approx(at_cut_off(data, FRICTION, 0.4e-3))
    assert math.isnan(at_cut_off(data, FRICTION, 1e-6))


def test_the_command_shows_numbers_as_they_are_solved(folder, shell):
    out = folder / "command"
    options = ("--down-to", "0.2 mm", "--hurst", 0.8, "--output", out)
    lines = shell("cut-off", folder / "case.toml", *options).stdout.split("\n")
    answer = next(i for i, line in enumerate(lines) if line.startswith("Answer: μ = "))
    assert any(line.startswith("roughness down to ") for line in lines[:answer])
    assert (out / "figures" / "cut_off.png").is_file()


def test_a_run_takes_the_roughness_below_as_a_factor(folder, shell, data):
    """Its answer is that without it, times the ratio of the curve."""
    result = shell("run", folder / "below.toml", "--output", folder / "below", "--figures")
    with_it = netcdf.load_dataset(folder / "below" / "answer.nc")
    without = gs.answer(read_case(folder / "case.toml")).data
    for quantity, curve in (("friction", FRICTION), ("contact_fraction", AREA)):
        ratio = float(with_it[f"answer_{quantity}"] / without[f"answer_{quantity}"])
        expected = float(data[curve][-1]) / at_cut_off(data, curve, 0.5e-3)
        assert ratio == pytest.approx(expected, rel=1e-9)
    wider = with_it.answer_friction_half_width > without.answer_friction_half_width
    assert bool(wider) or not math.isfinite(float(without.answer_friction_half_width))
    assert "roughness continued from 0.5 mm to 0.15 mm" in " ".join(result.stdout.split())
    assert (folder / "below" / "cut_off.nc").is_file()
    assert (folder / "below" / "figures" / "cut_off.png").is_file()


def test_an_answer_on_roughness_that_is_not_foretold_says_so():
    """Fine roughness has just begun where the measurement ends."""
    line = coarser(family_line("two_scales", 0), 2)
    case = gs.Case(
        line,
        tread(),
        pressure=3e5,
        speed=0.3,
        smallest_wavelength=0.8e-3,
        below_measurement=BelowMeasurement(0.2e-3),
    )
    curve = cut_off(case)
    assert curve.failure == ""
    assert "roughness down to 0.8 mm, where the measurement ends: it foretells" in curve.lines[0]
    assert "The roughness is not continued below 0.8 mm" in curve.findings[0].sentence
    answer = gs.answer(case)
    assert not answer.reliable
    assert "none to rely on. The roughness is not continued below 0.8 mm" in answer.lines[0]
    assert "continued" not in answer.basis[1]


def test_a_road_that_is_measured_coarsely_hides_its_microtexture(data):
    assert not list(continuation_doubts(data))
    coarse = data.assign(resolved=1.2e-3)
    assert ["below 0.5 mm" in doubt.sentence for doubt in continuation_doubts(coarse)] == [True]


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ('down_to = "0.1 mm"\nhurst = 1.3', "above 0, at most 1"),
        ('down_to = "0.1 mm"\nhurst = 0.8\nfiner = { file = "road.txt" }', "either hurst"),
        ('down_to = "0.1 mm"\nfiner = { x_unit = "mm" }', "either file"),
        ('down_to = "-1 mm"', "greater than zero"),
    ],
)
def test_tables_that_cannot_be_used_are_refused(folder, table, message):
    path = folder / "bad.toml"
    path.write_text((folder / "case.toml").read_text() + f"\n[below_measurement]\n{table}\n")
    with pytest.raises(InputError, match=message):
        read_case_file(path)


def test_a_finer_measurement_is_read_and_named_as_a_file(folder):
    path = folder / "finer.toml"
    finer = '\n[below_measurement]\ndown_to = "0.4 mm"\nfiner = { file = "road.txt" }\n'
    path.write_text((folder / "case.toml").read_text() + finer)
    assert ("below_measurement", "road.txt") in read_case_file(path).case.named_files()
    result = cut_off(read_case(path), folder=folder / "finer", down_to=0.4e-3).data
    assert bool(result.curve_measured[-1])


MAP = 'map = "map.txt"\nstep = ["0.2 mm", "0.2 mm"]\nz_unit = "mm"\nscales = 3\ncut_off = "1 mm"'


def test_a_map_is_refused(tmp_path):
    np.savetxt(tmp_path / "map.txt", 1e3 * isotropic_heights(128, length=0.0256, rms=2e-4).T)
    text = case_text(MAP, 'name = "styrene_butadiene"', HALF_PLANE)
    path = tmp_path / "case.toml"
    path.write_text(text)
    with pytest.raises(InputError, match="from measured profiles; got a map"):
        cut_off(read_case(path), folder=tmp_path / "result", down_to=1e-6)
    path.write_text(text + BELOW)
    with pytest.raises(InputError, match=r"measurement\] needs measured profiles; got a map"):
        read_case(path)
