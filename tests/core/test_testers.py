"""Testers of skid resistance: presets, their numbers, and a case under the load of one."""

from pathlib import Path

import pytest

import gripscale as gs
from gripscale.core.errors import GripscaleError, InputError
from gripscale.testers import TESTERS, friction_of_pendulum, pendulum_value
from tests.questions.answer.test_answer_object import CASE, END, WAVES, made

UNDER_PENDULUM = CASE.replace(
    'pressure = "3 bar"\nspeed = "0.3 m/s"\nfootprint = "100 mm"', 'tester = "pendulum"'
)


@pytest.mark.parametrize(("value", "friction"), [(31, 0.31), (36, 0.37), (50, 0.54), (82, 0.99)])
def test_pendulum_pairs(value, friction):
    """Published pairs, to the digit; 82 is published as 1.00, the formula has 0.992."""
    assert round(friction_of_pendulum(value), 2) == friction
    assert pendulum_value(friction_of_pendulum(value)) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("value", [-1.0, 330.0, float("nan")])
def test_values_beyond_the_scale_are_refused(value):
    with pytest.raises(InputError, match="PTV"):
        friction_of_pendulum(value)


def test_loads_are_forces_over_areas():
    """From the descriptions in the comments of the presets, to 3 %."""
    pendulum, wheel = TESTERS["pendulum"], TESTERS["locked_wheel"]
    assert pendulum.pressure == pytest.approx(22.2 / (76e-3 * 2.4e-3), rel=0.03)
    assert wheel.footprint == pytest.approx(4826.0 / (wheel.pressure * 0.149), rel=0.03)
    assert TESTERS["reference_tyre"].footprint == pytest.approx(
        0.75 * 730 * 9.81 / (1.8e5 * 0.17), rel=0.03
    )


@pytest.fixture(scope="module")
def answer():
    return gs.answer(made(pressure=None, speed=None, footprint=None, tester="pendulum"))


def test_answer_has_the_number_of_the_tester(answer):
    """With its interval, and that the rubber is not that of its slider."""
    value, *ends = (
        round(pendulum_value(mu)) for mu in (answer.friction, *answer.friction_interval)
    )
    assert any(f"PTV {value} ({ends[0]} to {ends[1]})" in line for line in answer.lines)
    assert float(answer.data.nominal_speed) == TESTERS["pendulum"].speed
    assert any("stands in for that of the slider 57 or 96" in str(f) for f in answer.findings)


def test_case_file_names_a_tester(answer, tmp_path):
    """Loaded, saved and loaded again it has one answer; a key beside the tester goes before it."""
    path = tmp_path / "case.toml"
    path.write_text(UNDER_PENDULUM, encoding="utf-8")
    case = gs.read_case(path)
    assert case.tester == "pendulum"
    assert gs.answer(case).lines == answer.lines
    saved = case.save(tmp_path / "saved.toml")
    assert gs.read_case(saved).attributes["tester"] == "pendulum"
    path.write_text(UNDER_PENDULUM + 'speed = "1 m/s"\n', encoding="utf-8")
    faster = gs.read_case(path).load
    assert faster.speed == 1.0
    assert faster.pressure == TESTERS["pendulum"].pressure


def test_unknown_testers_and_missing_loads_are_refused(tmp_path, shell):
    with pytest.raises(InputError, match="tester must be one of pendulum"):
        made(tester="srt")
    profile = gs.read_profile(Path(made().surface.source.split(", ")[0]))
    with pytest.raises(GripscaleError, match="pressure must be given, or tester"):
        gs.Case(profile, made().rubber, speed=1.0, smallest_wavelength=END, waves=WAVES)
    path = tmp_path / "case.toml"
    path.write_text(UNDER_PENDULUM.replace("pendulum", "srt"), encoding="utf-8")
    ended = shell("run", path, code=2)
    assert "tester" in ended.output
