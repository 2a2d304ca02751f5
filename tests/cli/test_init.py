"""`gripscale init` writes examples that run; nothing is overwritten."""

import pytest

import gripscale
from gripscale.case_file import EXAMPLES, read_case, read_case_file, write_example
from gripscale.case_file.keys import SCHEMA_FILE, SCHEMA_LINE
from gripscale.core.errors import FileError, InputError
from tests.samples import ROOT


def tree(folder):
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def test_the_command_offers_every_example(shell):
    words = shell("init", "--help").output
    assert all(f"{name}:" in words for name in EXAMPLES)


def test_the_road_is_the_shipped_case_with_its_data(tmp_path):
    written = write_example(tmp_path / "new" / "road")
    assert written[0].name == "case.toml"
    names = {path.relative_to(tmp_path / "new" / "road").as_posix() for path in written}
    assert names | {SCHEMA_FILE} == set(tree(tmp_path / "new" / "road"))
    shipped = read_case_file(ROOT / "examples" / "road_and_tread" / "case.toml")
    own = read_case_file(written[0])
    assert own.text == SCHEMA_LINE + shipped.text.replace("../data", "data")
    for (_, name), (_, other) in zip(
        own.case.named_files(), shipped.case.named_files(), strict=True
    ):
        assert own.resolve(name).read_bytes() == shipped.resolve(other).read_bytes()


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_is_commented_has_its_sources_and_can_be_prepared(name, tmp_path):
    if EXAMPLES[name].needs:
        pytest.importorskip("SurfaceTopography", reason="needs gripscale[formats]")
    written = write_example(tmp_path, name)
    for folder in {path.parent for path in written if "data" in path.parts}:
        there = {path.name.partition(".")[0] for path in folder.iterdir()}
        assert "SOURCE" in there, folder
    text = written[0].read_text()
    assert text.startswith(f"{SCHEMA_LINE}# ")
    results = read_case(written[0])
    assert results.doubts() == []  # else its answer is none to rely on
    assert len(results.surface.sines) == read_case_file(written[0]).case.surface.scales
    assert {"footprint", "keys`"} <= set(text.split())


@pytest.mark.parametrize("name", EXAMPLES)
def test_nothing_is_overwritten(name, tmp_path):
    last = write_example(tmp_path / "first", name)[-1]
    target = tmp_path / "second"
    mine = target / last.relative_to(tmp_path / "first")
    mine.parent.mkdir(parents=True)
    mine.write_text("mine")
    with pytest.raises(FileError, match=f"{mine.name} is there already"):
        write_example(target, name)
    assert list(tree(target).values()) == [b"mine"]


def test_other_words_are_refused_in_one_sentence(shell, tmp_path):
    with pytest.raises(InputError, match="example must be one of road, synthetic, sweeps, map"):
        write_example(tmp_path, "tyre")
    (tmp_path / "file").write_text("")
    result = shell("init", tmp_path / "file" / "new", code=2)
    assert result.stderr.endswith("file is not a folder\n")


def test_what_it_says_comes_next_is_what_the_tutorial_does(shell, tmp_path):
    folder = tmp_path / "start here"
    said = shell("init", folder, "--example", "synthetic", columns=400)
    lines = [line.strip() for line in said.output.splitlines()]
    named = f"'{folder}/"
    assert [line for line in lines if line.startswith("gripscale")] == [
        f"gripscale run {named}case.toml'",
        f"gripscale report {named}results'",
        f"gripscale compare {named}case.toml'",
    ]


def test_version_and_first_step_are_said(shell):
    assert shell("--version").stdout == f"gripscale {gripscale.__version__}\n"
    assert "gripscale init FOLDER" in " ".join(shell(code=2).output.split())
