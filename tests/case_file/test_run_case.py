"""Running a case as a library: objects back, files as the results come, nothing on the console."""

from __future__ import annotations

from pathlib import Path

import pytest

import gripscale as gs
from gripscale.case_file import case_chain, read_case_file
from gripscale.core.errors import ExtrapolationError
from gripscale.core.status import Status
from gripscale.io import netcdf
from tests.run_case import run_case
from tests.samples import fail_waves


def test_case_gives_its_results_as_objects(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results = run_case(case)
    alone = gs.solve_chain(
        gs.rubber.styrene_butadiene(),
        gs.SineStack([10e-3, 3e-3], [0.8e-3, 0.25e-3]),
        pressure=3e5,
        speed=0.3,
        footprint=0.1,
        columns=32,
        rows=8,
    )
    assert results.dynamic is not None
    assert results.static is not None
    assert results.dynamic.friction == alone.friction
    assert results.static.contact_fraction > alone.contact_fraction
    assert results.converged
    assert results.case.surface.sines.wavelength.tolist() == [10e-3, 3e-3]
    assert [path.name for path in case.parent.iterdir()] == ["case.toml"]
    assert capsys.readouterr() == ("", "")


def test_pressure_classes_of_the_case_are_those_of_the_chain(case: Path) -> None:
    case.write_text(case.read_text() + "[chain]\npressure_classes = 2\n")
    results = run_case(case)
    alone = case_chain(read_case_file(case)).predict(
        results.case.rubber, results.case.surface, results.case.load
    )
    assert results.dynamic is not None
    assert results.dynamic.friction == alone.total_friction
    assert results.dynamic.to_dataset().sizes["pressure_class"] == 2


def test_files_are_written_where_they_are_wanted(case: Path, tmp_path: Path) -> None:
    target = tmp_path / "out"
    results = run_case(case, output=target)
    tree = netcdf.load_tree(target / "dynamic.nc")
    assert set(tree.children) == {"inputs"}
    again = gs.ChainResult.from_dataset(tree.to_dataset())
    assert results.dynamic is not None
    assert again.friction == results.dynamic.friction
    assert (target / "case.toml").read_text() == case.read_text()


def test_wave_that_fails_is_named_and_the_rest_goes_on(
    case: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fail_waves(monkeypatch, Status.FOLD, lambda problem: problem.load.speed > 0.0)
    results = run_case(case)
    assert set(results.failures) == {"dynamic"}
    assert "wave 1 of 2" in str(results.failures["dynamic"])
    assert "fold in the load path" in str(results.failures["dynamic"])
    assert results.static is not None
    assert results.static.converged


def test_refused_extrapolation_ends_before_anything_is_written(case: Path, tmp_path: Path) -> None:
    """The named rubber is known from 0.01 rad/s; 10 mm at 1e-6 m/s is 6e-4 rad/s."""
    slow = case.read_text().replace("0.3 m/s", "0.000001 m/s")
    refused = slow.replace("[rubber]", '[rubber]\nextrapolate = "refuse"')
    case.write_text(refused)
    with pytest.raises(ExtrapolationError, match=r"wave 1 of 2 .* 0.000628 rad/s, below the measu"):
        run_case(case, output=tmp_path / "out")
    assert not (tmp_path / "out").exists()
    case.write_text(refused.replace("0.000001 m/s", "0.3 m/s"))
    assert run_case(case).converged


def test_time_limit_of_the_case_reaches_the_solver(case: Path) -> None:
    solver = case.read_text().replace("[solver]", '[solver]\ntime_limit = "0.001 us"')
    case.write_text(solver)
    results = run_case(case)
    assert case_chain(read_case_file(case)).solver.time_limit == pytest.approx(1e-9)
    assert results.dynamic is not None
    assert results.dynamic.status == Status.TIME_LIMIT
    case.write_text(solver.replace('"0.001 us"', "60"))
    assert run_case(case).converged
