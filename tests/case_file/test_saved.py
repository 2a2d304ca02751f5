"""A case saved with its results runs from there, wherever the folder goes."""

import shutil
import tomllib

from gripscale.case_file import folder, read_case_file
from gripscale.case_file import folder as results_folder
from gripscale.case_file.folder import renamed, saved_case
from tests.run_case import run_case


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
