"""`gripscale report`, and what `gripscale run` records for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from typer.testing import CliRunner

from gripscale import dataset
from gripscale.cli import app


def test_command_writes_the_page_and_says_where(study_file: Path, tmp_path: Path) -> None:
    target = tmp_path / "page.html"
    done = CliRunner().invoke(app, ["report", str(study_file), "--output", str(target)])
    assert done.exit_code == 0, done.output
    assert "page.html" in done.stdout
    assert target.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_page_goes_into_the_results_folder_by_default(study_file: Path) -> None:
    done = CliRunner().invoke(app, ["report", str(study_file)])
    assert done.exit_code == 0, done.output
    page = study_file.parent / "report.html"
    assert page.is_file()
    page.unlink()


def test_missing_result_is_one_sentence(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["report", str(tmp_path / "none")])
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert "does not exist" in done.stderr


def test_place_that_cannot_be_written_is_named(run_folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "nowhere" / "page.html"
    done = CliRunner().invoke(app, ["report", str(run_folder), "--output", str(target)])
    assert done.exit_code == 2
    assert "cannot be written" in done.stderr


def test_run_records_inputs_and_meshes_beside_the_chain(run_folder: Path) -> None:
    groups = dataset.load_groups(run_folder / "dynamic.nc")
    inputs, solver = groups["inputs"], groups["solver"]
    assert inputs.sizes["wave"] == 3
    assert inputs.sizes["profile"] == 2
    np.testing.assert_allclose(inputs.attrs["sines_s_wavelength"], 3.0, rtol=1e-12)
    assert inputs.sizes["row"] == 60
    lowest, highest = inputs["read_lowest"].values, inputs["read_highest"].values
    known = np.isfinite(lowest)
    assert (lowest[known] <= highest[known]).all()
    heights = np.loadtxt(run_folder.parent / "road.txt", skiprows=1)[:, 1] * 1e-3
    np.testing.assert_allclose(np.nanmax(highest[0]), heights.max(), rtol=1e-12)
    np.testing.assert_allclose(np.nanmin(lowest[0]), heights.min(), rtol=1e-12)
    assert solver["mesh_x"].shape == (3, 9, 33)
    assert (solver["columns"] == 32).all()
    assert "mesh_x" not in dataset.load(run_folder / "dynamic.nc")
