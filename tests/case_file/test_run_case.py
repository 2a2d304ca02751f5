"""The chain of a case as a library solves it, and the case saved with its results."""

import shutil
import tomllib

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file import case_chain, folder, read_case, read_case_file
from gripscale.case_file import folder as results_folder
from gripscale.case_file.folder import renamed, saved_case
from gripscale.core.errors import ExtrapolationError
from gripscale.core.status import Status
from tests.run_case import chain_of, run_case
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
    done = shell("run", case, "--output", tmp_path / "out", code=2)
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


def test_the_results_folder_alone_gives_the_same_result_elsewhere(inputs, tmp_path):
    there = tmp_path / "work"
    shutil.copytree(inputs, there)
    first = run_case(there / "case.toml", there / "results")
    moved = tmp_path / "elsewhere"
    shutil.move(there / "results", moved)
    shutil.rmtree(there)
    again = run_case(moved / "case.toml", tmp_path / "again")
    assert again.friction == first.friction
    # The copy of the copy is the copy.
    assert (tmp_path / "again" / "case.toml").read_text() == (moved / "case.toml").read_text()


def test_a_saved_case_run_into_its_own_folder_keeps_its_files(inputs, tmp_path):
    first = run_case(inputs / "case.toml", tmp_path / "results")
    case = tmp_path / "results" / "case.toml"
    text = case.read_text()
    again = run_case(case, tmp_path / "results")
    assert case.read_text() == text
    assert again.friction == first.friction


STRANGE = """\
# "a.txt" in a comment, and it's fine
[surface]
files = ["a.txt", 'b/a.txt', \"\"\"c"d.txt\"\"\"] # 'a.txt'
scales = 2
[rubber]
file = "a.txt"
source = "a.txt"
shift = '''e.txt'''
[load]
pressure = "3 bar"
speed = 1
footprint = 0.1
[measured]
friction = "m\\u00fc.csv"
"""


def test_only_names_of_files_are_changed():
    places = {"a.txt": "A", "b/a.txt": "B", 'c"d.txt': "C", "e.txt": "E", "mü.csv": 'M"'}
    text = renamed(STRANGE, places)
    tables = tomllib.loads(text)
    assert tables["surface"]["files"] == ["A", "B", "C"]
    assert tables["rubber"] == {"file": "A", "source": "a.txt", "shift": "E"}
    assert tables["measured"]["friction"] == 'M"'
    assert text.splitlines()[0] == STRANGE.splitlines()[0]
    assert text.splitlines()[2].endswith("# 'a.txt'")


def named(tmp_path, *names):
    """Write a case of files by these names, each with its name as its text."""
    for name in names:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(name)
    listed = ", ".join(f'"{name}"' for name in names)
    case = tmp_path / "case.toml"
    case.write_text(
        f'[surface]\nfiles = [{listed}]\nscales = 2\n[rubber]\nname = "styrene_butadiene"\n'
        '[load]\npressure = "3 bar"\nspeed = 1\nfootprint = 0.1\n'
    )
    return case


def test_files_of_one_name_and_files_of_others_keep_their_places(tmp_path):
    case = read_case_file(named(tmp_path, "a/road.txt", "b/road.txt"))
    target = tmp_path / "out"
    (target / "inputs").mkdir(parents=True)
    (target / "inputs" / "road.txt").write_text("somebody else's")
    results_folder.prepare(target, case)
    results_folder.prepare(target, case)  # the second time ours are known and written again
    assert {p.name: p.read_text() for p in (target / "inputs").iterdir()} == {
        "road.txt": "somebody else's",
        "road_2.txt": "a/road.txt",
        "road_3.txt": "b/road.txt",
    }
    results_folder.prepare(target, read_case_file(named(tmp_path, "c.txt")))
    assert sorted(p.name for p in (target / "inputs").iterdir()) == ["c.txt", "road.txt"]


def test_large_files_are_named_where_they_are(tmp_path, monkeypatch):
    monkeypatch.setattr(folder, "COPIED_AT_MOST", 8)
    kept = saved_case(read_case_file(named(tmp_path, "long name.txt")), tmp_path / "out")
    assert not kept.copies
    files = tomllib.loads(kept.text)["surface"]["files"]
    assert files == [str(tmp_path / "long name.txt")]
