"""A run that was stopped goes on where it was, with the same results to the last bit."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
import xarray as xr

from gripscale.cli.run_case import run_case
from gripscale.io import netcdf
from gripscale.questions.chain.events import Event, ResultsReplaced, WaveSolved
from gripscale.theory import HalfPlane
from gripscale.wave import FiniteStrainBlock, ScaleResult, WaveProblem
from tests.samples import HALF_PLANE, THREE_WAVES, case_text

Count = Callable[[int | None], list[int]]
CASE = case_text(THREE_WAVES, solver="columns = 16\nrows = 4", static=True)
"""Sliding and at rest: six waves to solve."""


@pytest.fixture(scope="module")
def whole_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The case, with the results of its run in the folder `out` beside."""
    path = tmp_path_factory.mktemp("whole") / "case.toml"
    path.write_text(CASE)
    run_case(path, output=path.with_name("out"))
    return path


@pytest.fixture
def case_copy(whole_run: Path, tmp_path: Path) -> Path:
    """A copy of both elsewhere, to be changed."""
    shutil.copytree(whole_run.parent, tmp_path, dirs_exist_ok=True)
    return tmp_path / "case.toml"


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> Count:
    """Count the waves that are solved from now on, and stop before wave `last`, from 0."""
    solvers = {one: one.solve for one in (FiniteStrainBlock, HalfPlane)}

    def counting(last: int | None = None) -> list[int]:
        seen: list[int] = []
        for kind, solve in solvers.items():

            def look(
                self: FiniteStrainBlock,
                problem: WaveProblem,
                start: ScaleResult | None = None,
                solve: Callable[..., ScaleResult] = solve,
            ) -> ScaleResult:
                if len(seen) == last:
                    raise KeyboardInterrupt
                seen.append(len(seen))
                return solve(self, problem, start)

            monkeypatch.setattr(kind, "solve", look)
        return seen

    return counting


def same(first: Path, second: Path) -> None:
    """Assert that two folders hold the same predictions, to the last bit."""
    for name in sorted(path.name for path in first.glob("*.nc")):
        one, other = (netcdf.load_tree(folder / name) for folder in (first, second))
        for group in ("/", "inputs"):
            xr.testing.assert_identical(
                one[group].to_dataset(inherit=False), other[group].to_dataset(inherit=False)
            )


@pytest.mark.parametrize("last", [1, 2, 3, 5])
def test_a_stopped_run_solves_only_what_is_missing(
    whole_run: Path, tmp_path: Path, solved: Count, last: int
) -> None:
    solved(last)
    with pytest.raises(KeyboardInterrupt):
        run_case(whole_run, output=tmp_path / "stopped")
    seen, events = solved(None), list[Event]()
    results = run_case(whole_run, output=tmp_path / "stopped", on_event=events.append)
    assert len(seen) == 6 - last
    assert [event.stored for event in events if isinstance(event, WaveSolved)] == [
        number < last for number in range(6)
    ]
    assert results.converged
    same(whole_run.with_name("out"), tmp_path / "stopped")


def test_a_finished_run_solves_nothing_again_unless_told_to(
    case_copy: Path, tmp_path: Path, solved: Count
) -> None:
    first = netcdf.load_dataset(tmp_path / "out" / "dynamic.nc")
    seen, events = solved(None), list[Event]()
    results = run_case(case_copy, output=tmp_path / "out", on_event=events.append)
    assert not seen
    replaced = [event for event in events if isinstance(event, ResultsReplaced)]
    assert replaced[0].message.startswith("Replaces 1 file of an earlier run")  # the case itself
    assert results.dynamic is not None
    first = first.assign_attrs(case_file=str(case_copy))
    xr.testing.assert_identical(first, netcdf.load_dataset(tmp_path / "out" / "dynamic.nc"))
    run_case(case_copy, output=tmp_path / "out", fresh=True)
    assert len(seen) == 6


@pytest.mark.parametrize(("old", "new"), [('"3 bar"', '"2 bar"'), ("rows = 4", "rows = 5")])
def test_another_case_takes_nothing_up(
    case_copy: Path, tmp_path: Path, solved: Count, old: str, new: str
) -> None:
    assert old in CASE
    case_copy.write_text(CASE.replace(old, new))
    seen = solved(None)
    run_case(case_copy, output=tmp_path / "out")
    assert len(seen) == 6


def test_a_comment_solves_nothing_again(case_copy: Path, tmp_path: Path, solved: Count) -> None:
    case_copy.write_text(CASE.replace("[load]", "[load] # other"))
    seen = solved(None)
    run_case(case_copy, output=tmp_path / "out")
    assert not seen
    assert "# other" in netcdf.load_dataset(tmp_path / "out" / "dynamic.nc").attrs["case"]


@pytest.mark.parametrize(("new", "waves"), [("another digit", 6), ("a space", 0)])
def test_other_numbers_in_a_file_of_the_same_name_take_nothing_up(
    inputs: Path, tmp_path: Path, solved: Count, new: str, waves: int
) -> None:
    for path in inputs.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    run_case(tmp_path / "case.toml", output=tmp_path / "out")
    road = tmp_path / "road.txt"
    lines = road.read_text().splitlines()
    middle = len(lines) // 2
    changed = lines[middle].replace("\t", " \t") if new == "a space" else lines[middle] + "1"
    road.write_text("\n".join([*lines[:middle], changed, *lines[middle + 1 :], ""]))
    seen = solved(None)
    run_case(tmp_path / "case.toml", output=tmp_path / "out")
    assert len(seen) == waves


def test_other_software_takes_nothing_up(
    case_copy: Path, tmp_path: Path, solved: Count, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gripscale.experiment.task.software", lambda: "another")
    seen = solved(None)
    run_case(case_copy, output=tmp_path / "out")
    assert len(seen) == 6


SOFTENING = """\
[conditions.softening]
kind = "kraus"
storage_ratio = 0.8
loss_ratio = 0.8
critical_strain = 0.05
measured_at = 0.001
deformation = "tension"
"""


@pytest.mark.parametrize("more", ["[chain]\npressure_classes = 2\n", SOFTENING])
def test_where_waves_depend_on_more_only_finished_predictions_are_taken_up(
    tmp_path: Path, solved: Count, more: str
) -> None:
    three = tmp_path / "case.toml"
    three.write_text(case_text(THREE_WAVES, solver=HALF_PLANE) + more)
    count = solved(None)
    assert run_case(three, output=tmp_path / "whole").converged
    whole = len(count)
    assert whole > 3
    solved(whole - 1)
    with pytest.raises(KeyboardInterrupt):
        run_case(three, output=tmp_path / "stopped")
    seen = solved(None)
    run_case(three, output=tmp_path / "stopped")
    assert len(seen) == whole
    same(tmp_path / "whole", tmp_path / "stopped")
    seen.clear()
    run_case(three, output=tmp_path / "stopped")
    assert not seen
