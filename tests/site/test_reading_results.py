"""The variables, units, columns, statuses and figures the docs list are those the code writes."""

import re

import pytest

from gripscale.core.status import Status
from gripscale.io import netcdf
from gripscale.questions.chain import page as waves
from tests.samples import ROOT, blank_figures, case_text, write_short_road

PAGE = "".join(
    (ROOT / "docs" / name).read_text(encoding="utf-8")
    for name in ("reading-results.md", "reference/result-files.md")
)

CASE = case_text(
    'files = ["road.txt"]\nscales = 2\nsmallest_wavelength = "2 mm"', 'file = "dma.txt"\nterms = 4'
)

OF_OTHER_CASES = {"cut_off", "superposition", "superposition_tests", "shift"}
"""Figures of a rubber in sweeps, and of a case that goes on below the measurement."""


def section(title):
    """Return the text below a heading, up to the next one."""
    found = re.search(rf"^#+ {re.escape(title)}\n(.*?)(?=^#|\Z)", PAGE, re.DOTALL | re.MULTILINE)
    assert found, title
    return found[1]


def first_cells(title):
    """Return the names in the first column of the tables of a section."""
    text = re.sub(r"</?code>", "`", section(title)).replace("&#124;", "\0")
    cells = re.findall(r"^\| (`.*?) \|", text, re.MULTILINE)
    return [name.replace("\0", "|") for cell in cells for name in re.findall(r"`(.*?)`", cell)]


def units(title):
    """Return name and unit of the variables a section lists."""
    rows = re.findall(r"^\| `(\w+)` \| (.*?) ?\|", section(title), re.MULTILINE)
    assert len(rows) == len(dict(rows)), f"listed twice: {title}"
    return dict(rows)


def written(data):
    return {str(name): variable.attrs.get("units", "") for name, variable in data.variables.items()}


@pytest.fixture(scope="module")
def folder(shell, tmp_path_factory):
    """A run and a study of a made-up road and rubber."""
    folder = tmp_path_factory.mktemp("case")
    write_short_road(folder)
    (folder / "case.toml").write_text(CASE)
    (folder / "mu.csv").write_text("speed,friction\n0.1,0.3\n1,0.4\n")
    for arguments in (
        ["run", "--figures"],
        ["study", "--vary", "speed=0.3,0.6", "--workers", "1"],
        [
            *("study", "--vary", "speed=0.3,0.6", "--workers", "1"),
            *("--model", "chain", "--output", str(folder / "results" / "chain")),
        ],
        ["compare", "--models", "chain_half_plane,direct", "--measured", str(folder / "mu.csv")],
        ["compare", "--models", "chain_half_plane", "--vary", "speed=0.3,0.6"],
    ):
        with blank_figures():
            shell(arguments[0], folder / "case.toml", *arguments[1:])
    return folder / "results"


def test_the_variables_of_a_run_are_listed_with_their_units(folder):
    assert units("Totals") | units("Waves") == written(netcdf.load_dataset(folder / "chain.nc"))
    tree = netcdf.load_tree(folder / "answer.nc")
    assert set(tree.children) == {"inputs"}
    assert units("Group `inputs`") == written(tree["inputs"].to_dataset(inherit=False))


def test_the_variables_of_a_study_are_listed_with_their_units(folder):
    both = (netcdf.load_dataset(folder / name / "study.nc") for name in ("study", "chain"))
    study = {name: unit for data in both for name, unit in written(data).items()}
    known = units("Totals") | units("Waves")
    own = {name: unit for name, unit in study.items() if name not in {"speed", *known}}
    parts = (
        "answer_hysteresis_friction",
        "answer_interface_friction",
    )  # where there is an interface
    assert units("The file of a study") == own | dict.fromkeys(parts, "1")
    assert {name: known[name] for name in study if name in known}.items() <= study.items()


def test_the_variables_of_a_comparison_are_listed_with_their_units(folder):
    data = written(netcdf.load_dataset(folder / "comparison" / "comparison.nc"))
    assert units("The files of a comparison") == {n: u for n, u in data.items() if n != "model"}


def test_the_figures_of_a_comparison_are_listed(folder):
    drawn = {path.stem for path in (folder / "comparison").glob("*.png")}
    assert set(first_cells("The figures of a comparison")) == drawn


def test_the_figures_are_listed(folder):
    listed = set(first_cells("The figures of a run"))
    of_run = {path.stem for path in (folder / "figures").iterdir()}
    of_study = {
        path.stem for name in ("study", "chain") for path in (folder / name / "figures").iterdir()
    }
    assert listed == of_run | of_study | OF_OTHER_CASES


def test_the_columns_of_the_table_are_listed():
    names = ["#"]
    for column in waves.OF_WAVES:
        several = column.head in {"area", "μ"}
        names.append(f"{column.head} {column.unit}" if several else column.head)
    names += ["stretch", waves.ITERATIONS.head, "status"]
    assert first_cells("The table") == names


def test_every_status_is_listed():
    assert first_cells("Statuses, and what to do about them") == [str(status) for status in Status]
