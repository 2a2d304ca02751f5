"""Quantiles in the other reports of a case: of the same inputs, or said to be of others."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from gripscale.cli import app
from gripscale.io import netcdf
from gripscale.questions import of_same_inputs, stored_uncertainty
from gripscale.questions.answer.reliance import headline
from gripscale.questions.page_of_folder import write_report
from gripscale.questions.uncertainty.page import OF_ANOTHER, uncertainty_lines


def called(*arguments: object) -> None:
    outcome = CliRunner().invoke(app, [str(one) for one in arguments])
    assert outcome.exit_code == 0, outcome.output


@pytest.fixture(scope="module")
def case(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A case with ten samples, then run and compared."""
    at = tmp_path_factory.mktemp("reported")
    for name in ("road.txt", "dma.txt", "case.toml"):
        (at / name).write_bytes((folder / name).read_bytes())
    called("uncertainty", at / "case.toml", "--samples", 10, "--without", "waves")
    called("run", at / "case.toml")
    called("compare", at / "case.toml", "--models", "direct")
    return at / "case.toml"


def test_the_same_inputs_whatever_is_done_with_them(case: Path) -> None:
    results = case.parent / "results"
    data, text = stored_uncertainty(results), case.read_text()
    assert data is not None
    digests = netcdf.load_tree(results / "answer.nc")["inputs"]["file_sha256"].values.tolist()
    assert of_same_inputs(data, text, digests)
    assert of_same_inputs(data, f"# said\n{text}[uncertainty]\nsamples = 50\n", digests)
    assert not of_same_inputs(data, text.replace("0.3 m/s", "0.4 m/s"), digests)
    assert not of_same_inputs(data, text, ["0" * 64, *digests[1:]])
    assert stored_uncertainty(case.parent) is None


@pytest.mark.parametrize("name", ["report.txt", "comparison/comparison.txt"])
def test_quantiles_stand_in_the_texts(case: Path, name: str) -> None:
    data = stored_uncertainty(case.parent / "results")
    assert data is not None
    answer, line = uncertainty_lines(data, case.read_text())
    friction = headline(data, "friction")
    assert answer.startswith(f"With the errors of the inputs, 10 samples: μ = {friction}")
    low, middle, high = (f"{v:#.2g}" for v in data.friction_quantile.values[0, [0, 2, 4]])
    assert line.startswith(
        f"Uncertainty, direct, 5, 50 and 95 % of 10 samples: μ = {low}, {middle}, {high}; A_r"
    )
    text = " ".join((case.parent / "results" / name).read_text().split())
    assert answer in text
    assert line in text


@pytest.mark.parametrize("name", [".", "comparison"])
def test_quantiles_stand_on_the_pages(case: Path, tmp_path: Path, name: str) -> None:
    page = write_report(case.parent / "results" / name, tmp_path / "page.html").read_text()
    assert "μ, inputs sampled" in page
    assert OF_ANOTHER.replace("`", "") not in page.replace("`", "")


def test_those_of_another_case_are_left_out_and_said(case: Path, tmp_path: Path) -> None:
    for path in case.parent.iterdir():
        if path.is_file():
            (tmp_path / path.name).write_bytes(path.read_bytes())
    other = tmp_path / "case.toml"
    other.write_text(case.read_text().replace("0.3 m/s", "0.4 m/s"))
    sampled = tmp_path / "results" / "uncertainty"
    sampled.mkdir(parents=True)
    there = case.parent / "results" / "uncertainty" / "uncertainty.nc"
    (sampled / "uncertainty.nc").write_bytes(there.read_bytes())
    called("run", other)
    text = " ".join((tmp_path / "results" / "report.txt").read_text().split())
    assert OF_ANOTHER in text
    page = write_report(tmp_path / "results").read_text()
    assert "The uncertainty in this folder belongs to another case" in page
    assert "μ, inputs sampled" not in page
