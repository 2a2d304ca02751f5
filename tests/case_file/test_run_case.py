"""The chain of a case as a library solves it: objects back, nothing on the console."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import case_chain, read_case, read_case_file
from gripscale.core.errors import ExtrapolationError
from gripscale.core.status import Status
from tests.run_case import chain_of
from tests.samples import fail_waves


def test_answer_of_sine_waves_is_that_of_their_chain(case, capsys):
    alone = gs.solve_chain(
        gs.rubber.styrene_butadiene(),
        gs.SineStack([10e-3, 3e-3], [0.8e-3, 0.25e-3]),
        pressure=3e5,
        speed=0.3,
        footprint=0.1,
        columns=32,
        rows=8,
    )
    read = read_case(case)
    result = gs.answer(read)
    assert result.friction == float(result.chain.total_friction) == alone.friction
    assert result.contact_fraction == alone.contact_fraction
    assert "mesh_x" in result.chain
    assert not result.failure
    assert not result.reliable
    assert np.isnan(result.friction_interval).all()
    assert result.lines[0].endswith(" by the chain of waves, without an interval")
    rest = gs.answer(read.replace(speed=0.0))
    assert rest.contact_fraction > alone.contact_fraction
    assert [path.name for path in case.parent.iterdir()] == ["case.toml"]
    assert capsys.readouterr() == ("", "")


def test_pressure_classes_of_the_case_are_those_of_the_chain(case):
    case.write_text(case.read_text() + "[chain]\npressure_classes = 2\n")
    read = read_case(case)
    alone = case_chain(read_case_file(case)).predict(read.rubber, read.surface, read.load)
    assert chain_of(case).friction == alone.total_friction
    assert alone.sizes["pressure_class"] == 2


def test_what_was_solved_is_not_solved_again(case, tmp_path, monkeypatch):
    first = gs.answer(read_case(case), folder=tmp_path / "kept")
    fail_waves(monkeypatch, Status.FOLD, lambda problem: True)
    again = gs.answer(read_case(case), folder=tmp_path / "kept")
    assert again.friction == first.friction
    assert gs.answer(read_case(case)).failure


def test_wave_that_fails_is_named(case, monkeypatch):
    fail_waves(monkeypatch, Status.FOLD, lambda problem: problem.load.speed > 0.0)
    result = gs.answer(read_case(case))
    assert result.failure.startswith("wave 1 of 2")
    assert "fold in the load path" in result.failure


def test_refused_extrapolation_ends_before_anything_is_written(case, tmp_path, shell):
    """The named rubber is known from 0.01 rad/s; 10 mm at 1e-6 m/s is 6e-4 rad/s."""
    slow = case.read_text().replace("0.3 m/s", "0.000001 m/s")
    refused = slow.replace("[rubber]", '[rubber]\nextrapolate = "refuse"')
    case.write_text(refused)
    with pytest.raises(ExtrapolationError, match=r"wave 1 of 2 .* 0.000628 rad/s, below the measu"):
        chain_of(case)
    done = shell("run", case, "--output", tmp_path / "out")
    assert done.exit_code == 2
    assert "0.000628 rad/s, below the measured band" in done.stderr
    assert not (tmp_path / "out").exists()
    case.write_text(refused.replace("0.000001 m/s", "0.3 m/s"))
    assert chain_of(case).converged


def test_time_limit_of_the_case_reaches_the_solver(case):
    solver = case.read_text().replace("[solver]", '[solver]\ntime_limit = "0.001 us"')
    case.write_text(solver)
    assert case_chain(read_case_file(case)).solver.time_limit == pytest.approx(1e-9)
    with pytest.raises(gs.ConvergenceError, match=str(Status.TIME_LIMIT)):
        chain_of(case)
    case.write_text(solver.replace('"0.001 us"', "60"))
    assert chain_of(case).converged
