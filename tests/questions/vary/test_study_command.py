"""`gripscale study` from the command line to table, figures and result file."""

from __future__ import annotations

from pathlib import Path

import pytest

from gripscale.core.status import Status
from gripscale.io import netcdf
from gripscale.questions.terminal import PROGRESS_LINES
from tests.samples import Shell, fail_waves


def test_command_solves_prints_draws_and_resumes(
    shell: Shell, case: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(PROGRESS_LINES, "1")
    asked = ("study", case, "--vary", "speed=0.01:1:log3", "--vary", "pressure=1 bar,3 bar")
    result = shell(*asked)
    assert result.exit_code == 0, result.output
    target = case.parent / "results" / "study"
    written = {
        str(p.relative_to(target)) for p in target.rglob("*.*") if "predictions" not in p.parts
    }
    files = {"case.toml", "study.nc"}
    assert written == files | {".case", "report.html", "figures/totals.png"}
    assert "[6/6] speed" in result.stdout
    data = netcdf.load_dataset(target / "study.nc")
    assert f"{float(data.total_friction[2, 1]):.3f}" in result.stdout
    assert result.stdout.count("converged") == 6
    assert max(len(line) for line in result.stdout.splitlines() if "in /" not in line) <= 100
    again = shell(*asked)
    assert again.stdout.partition("Answer")[2] == result.stdout.partition("Answer")[2]


def test_names_are_drawn_as_points(shell: Shell, case: Path, tmp_path: Path) -> None:
    vary = ("--vary", "rubber=case", "--vary", "surface=case,synthetic_dense_asphalt")
    result = shell("study", case, *vary, "--output", tmp_path)
    assert result.exit_code == 0, result.output
    names = {path.stem for path in (tmp_path / "figures").glob("*.png")}
    assert names == {"totals", "wavelength"}


def test_failed_chain_ends_with_its_own_code(
    shell: Shell, case: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fail_waves(
        monkeypatch,
        Status.ITERATION_LIMIT,
        lambda problem: problem.load.speed > 0.5 and problem.profile.wavelength < 2e-3,
    )
    result = shell("study", case, "--vary", "speed=0.1,1")
    assert result.exit_code == 3
    assert len(result.stderr.splitlines()) == 1
    assert "1 of 2 predictions failed; the first: wave 3" in result.stderr
    assert (case.parent / "results" / "study" / "study.nc").exists()
