"""Running a case as a library: objects back, files as the results come, nothing on the console."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

import gripscale as gs
from gripscale import netcdf
from gripscale.case import WaveSolved, case_chain, prepare_case, read_case, run_case
from gripscale.wave import FiniteStrainBlock, Status, WaveProblem, WaveResult


def test_case_gives_its_results_as_objects(case: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results = run_case(case)
    alone = gs.predict(
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
    assert results.surface.sines.wavelength.tolist() == [10e-3, 3e-3]
    assert [path.name for path in case.parent.iterdir()] == ["case.toml"]
    assert capsys.readouterr() == ("", "")


def test_pressure_classes_of_the_case_are_those_of_the_chain(case: Path) -> None:
    case.write_text(case.read_text() + "[chain]\npressure_classes = 2\n")
    results = run_case(case)
    alone = case_chain(read_case(case).case).predict(
        results.rubber.rubber, results.surface, results.load
    )
    assert results.dynamic is not None
    assert results.dynamic.friction == alone.total_friction
    assert results.dynamic.to_dataset().sizes["pressure_class"] == 2


def test_files_are_written_where_they_are_wanted(case: Path, tmp_path: Path) -> None:
    target = tmp_path / "out"
    seen: list[tuple[str, int, int]] = []

    def look(solved: WaveSolved) -> None:
        on_disk = netcdf.load(target / f"{solved.name}.nc").sizes["scale"]
        seen.append((solved.name, len(solved.so_far.scales), on_disk))

    results = run_case(prepare_case(case), output=target, on_wave=look)
    assert seen == [("dynamic", 1, 1), ("dynamic", 2, 2), ("static", 1, 1), ("static", 2, 2)]
    tree = netcdf.load_tree(target / "dynamic.nc")
    assert set(tree.children) == {"inputs"}
    again = gs.Prediction.from_dataset(tree.to_dataset())
    assert results.dynamic is not None
    assert again.friction == results.dynamic.friction
    assert (target / "case.toml").read_text() == case.read_text()


def test_wave_that_fails_is_named_and_the_rest_goes_on(
    case: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solve = FiniteStrainBlock.solve

    def lame(
        self: FiniteStrainBlock, problem: WaveProblem, start: WaveResult | None = None
    ) -> WaveResult:
        good = solve(self, problem, start)
        return replace(good, status=Status.FOLD) if problem.load.speed > 0.0 else good

    monkeypatch.setattr(FiniteStrainBlock, "solve", lame)
    results = run_case(case)
    assert set(results.failures) == {"dynamic"}
    assert "wave 1 of 2" in str(results.failures["dynamic"])
    assert "fold in the load path" in str(results.failures["dynamic"])
    assert results.static is not None
    assert results.static.converged
