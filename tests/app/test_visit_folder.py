"""Nothing outside the folder of a visit can be reached; what is dropped gets a harmless name."""

from pathlib import Path

import pytest

from gripscale.app.case import MAX_UPLOAD, CaseState, VisitFolder, safe_name
from gripscale.app.runs import Runs
from gripscale.core.errors import InputError

from .conftest import CASE, validation_message

ROLES = {
    "profile": ('files = ["../elsewhere/road.txt"]', "files = ['NAME']"),
    "map": ('files = ["../elsewhere/road.txt"]', "map = 'NAME'"),
    "rubber": ('file = "dma.txt"', "file = 'NAME'"),
    "shift": ('file = "dma.txt"', "file = 'road.txt'\nshift = 'NAME'"),
    "softening": (
        "[solver]",
        "[conditions]\nsoftening = { kind = 'table', files = ['NAME'], measured_at = 0.001 }\n"
        "[solver]",
    ),
    "friction": ("[solver]", "[measured]\nfriction = 'NAME'\n[solver]"),
}
"""Every key of a case that names a file: what stands for it in the case, and with a name in it."""


@pytest.fixture
def state(tmp_path):
    (tmp_path / "secret.txt").write_text("x [mm]\tz [mm]\n0 0\n")
    return CaseState(VisitFolder.new(tmp_path / "visits"))


def inside(text):
    return text.replace("../elsewhere/", "")


@pytest.mark.parametrize("role", ROLES)
@pytest.mark.parametrize(
    "name",
    ["../../secret.txt", "/etc/passwd", "~/secret.txt", "inputs/../../../secret.txt", "link.txt"],
)
def test_a_case_that_names_a_file_outside_is_refused(state, role, name, tmp_path):
    (state.visit.path / "link.txt").symlink_to(tmp_path / "secret.txt")
    old, new = ROLES[role]
    state.set_text(inside(CASE.replace(old, new.replace("NAME", name))))
    assert f'file "{name}" lies outside the folder of this page' in validation_message(state)
    with pytest.raises(InputError, match="lies outside"):
        state.file()
    runs = Runs(state)
    with pytest.raises(InputError, match="lies outside"):
        runs.start()
    assert runs.all == []


@pytest.mark.parametrize("role", ROLES)
def test_a_case_that_names_a_file_inside_is_taken(state, role):
    old, new = ROLES[role]
    state.set_text(inside(CASE.replace(old, new.replace("NAME", "inputs/other.txt"))))
    assert validation_message(state) == ""


def test_the_folder_of_another_visit_is_outside(state):
    """Its name begins like that of this one: a comparison of texts would let it pass."""
    other = Path(f"{state.visit.path}0")
    other.mkdir()
    (other / "road.txt").write_text("0 0\n")
    state.set_text(CASE.replace("../elsewhere", f"../{other.name}"))
    assert "lies outside" in validation_message(state)


@pytest.mark.parametrize(
    ("given", "kept"),
    [
        ("road.txt", "road.txt"),
        ("../../etc/passwd", "passwd"),
        ("C:\\Users\\me\\road 1.csv", "road_1.csv"),
        (".bashrc", "bashrc"),
        ("a\x00b\n.txt", "a_b_.txt"),
        ("Straße.dat", "Straße.dat"),
        (f"{'x' * 300}.csv", f"{'x' * 96}.csv"),
    ],
)
def test_names_of_dropped_files_are_harmless(given, kept, tmp_path):
    assert safe_name(given) == kept
    place = VisitFolder.new(tmp_path)
    stored = place.path / place.store(given, b"1")
    assert stored.parent == place.path / "inputs"
    assert stored.read_bytes() == b"1"


@pytest.mark.parametrize("name", ["", "..", "/", "...", "///"])
def test_a_name_without_letters_is_refused(name):
    with pytest.raises(InputError, match="expected letters or digits"):
        safe_name(name)


def test_a_file_too_large_is_refused_with_its_size(tmp_path):
    place = VisitFolder.new(tmp_path)
    with pytest.raises(InputError, match=r"big.dat has 50 MB; expected at most 50 MB"):
        place.store("big.dat", bytes(MAX_UPLOAD + 1))
    assert list((place.path / "inputs").iterdir()) == []


def test_another_file_of_the_same_name_does_not_replace_the_first(tmp_path):
    place = VisitFolder.new(tmp_path)
    names = [place.store("road.txt", content) for content in (b"1", b"2", b"1")]
    assert names == ["inputs/road.txt", "inputs/road_2.txt", "inputs/road.txt"]
    assert (place.path / names[0]).read_bytes() == b"1"


def test_visits_are_apart_and_leave_nothing_if_nothing_was_run(tmp_path):
    one, other = VisitFolder.new(tmp_path), VisitFolder.new(tmp_path)
    assert one.path != other.path
    (other.path / "runs").mkdir()
    for place in (one, other):
        place.remove_if_unused()
    assert list(tmp_path.iterdir()) == [other.path]
