"""`gripscale run` from files to tables, figures and results."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from gripscale.case_file.folder import AT_TIMES, CASE_NOTE, NOTE, RESULT_FILES
from gripscale.charts.figure_folder import FigureFolder
from gripscale.cli import app
from gripscale.core.status import Status
from gripscale.io import netcdf
from gripscale.questions.terminal import time_left
from gripscale.theory import HalfPlane
from gripscale.wave import ScaleResult, WaveProblem
from tests.samples import Shell


@pytest.fixture(scope="module")
def done(inputs: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Result, Path]:
    """The small case, run once."""
    target = tmp_path_factory.mktemp("done") / "deep" / "results"
    arguments = ["run", str(inputs / "case.toml"), "--output", str(target)]
    return CliRunner().invoke(app, arguments, env={"COLUMNS": "100"}), target


def test_run_ends_well_and_writes_everything(done: tuple[Result, Path]) -> None:
    result, target = done
    assert result.exit_code == 0, result.output
    assert result.stderr == ""
    written = {str(p.relative_to(target)) for p in target.rglob("*") if p.is_file()}
    of_others = {"cut_off.nc"} | {
        name for name in RESULT_FILES if any(f"/{figure}." in name for figure in AT_TIMES)
    }
    of_others |= {name for name in RESULT_FILES if name.endswith((".pdf", ".svg"))}
    assert written == {*RESULT_FILES, CASE_NOTE, "inputs/road.txt", "inputs/dma.txt"} - of_others


def test_output_fits_its_width_without_colour_codes(done: tuple[Result, Path]) -> None:
    result, target = done
    assert "\x1b" not in result.output
    lines = [line for line in result.output.splitlines() if str(target) not in line]
    assert max(len(line) for line in lines if "case.toml" not in line) <= 100
    assert "…" not in result.output


def test_output_says_what_was_read_fitted_and_solved(done: tuple[Result, Path]) -> None:
    output = done[0].output
    for words in (
        "dma on road",
        "3 sine waves from",
        "Maxwell elements",
        "A_r/A_0",
        "spikes",
    ):
        assert words in output
    assert "wave 3 of 3" not in output  # progress is for terminals


def test_the_chain_is_printed_where_it_is_asked_for(
    done: tuple[Result, Path], inputs: Path, shell: Shell
) -> None:
    result, target = done
    _, opening, last = result.output.split("Answer: ")
    assert last.strip(), "the answer is the last thing"
    assert opening.startswith(last.strip())
    chain = (target / "chain.txt").read_text(encoding="utf-8")
    again = shell("run", inputs / "case.toml", "--output", target, "--chain").output
    for words in ("Dynamic, 0.3 m/s", "Static", "stretch"):
        assert words in chain
        assert words in again
        assert words not in result.output


def test_results_file_holds_the_chain_and_its_inputs(
    done: tuple[Result, Path], inputs: Path
) -> None:
    data = netcdf.load_dataset(done[1] / "dynamic.nc")
    assert data.sizes["scale"] == 3
    np.testing.assert_allclose(
        data.pressure_received[1:],
        (data.pressure_received / data.contact_fraction)[:-1],
        rtol=1e-12,
    )
    assert data.total_friction == pytest.approx(float(data.friction.sum()), rel=1e-12)
    assert data.total_friction > 0.0
    assert data.attrs["case"] == (inputs / "case.toml").read_text()
    assert data.attrs["surface_source"].endswith("road.txt")
    rest = netcdf.load_dataset(done[1] / "static.nc")
    assert np.isinf(rest.load_time).all()
    assert rest.total_contact_fraction > data.total_contact_fraction


def test_case_is_copied_but_for_the_names_of_its_files(
    done: tuple[Result, Path], inputs: Path
) -> None:
    text = (inputs / "case.toml").read_text()
    for name in ("road.txt", "dma.txt"):
        text = text.replace(name, f"inputs/{name}")
        assert (done[1] / "inputs" / name).read_bytes() == (inputs / name).read_bytes()
    assert (done[1] / "case.toml").read_text() == text


def test_report_holds_the_tables(done: tuple[Result, Path]) -> None:
    text = (done[1] / "report.txt").read_text(encoding="utf-8")
    assert (done[1] / "chain.txt").read_text(encoding="utf-8").count("converged") == 6
    assert "s_wavelength = 3.000" in text


def lame(wave: int) -> Any:
    """Return the half-plane's `solve`, whose given wave (counted from 1) does not converge."""
    count, solve = 0, HalfPlane.solve

    def lamed(
        self: HalfPlane, problem: WaveProblem, start: ScaleResult | None = None
    ) -> ScaleResult:
        nonlocal count
        count += 1
        good = solve(self, problem, start)
        return replace(good, status=Status.ITERATION_LIMIT) if count == wave else good

    return lamed


@pytest.mark.usefixtures("undrawn")
def test_wave_that_fails_keeps_what_was_solved(
    shell: Shell, changed: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(HalfPlane, "solve", lame(2))
    case = changed()
    result = shell("run", case)
    assert result.exit_code == 3
    assert "wave 2 of 3" in result.stderr
    assert "iteration limit" in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert "No totals: wave 2 did not converge" in (
        case.parent / "results" / "chain.txt"
    ).read_text(encoding="utf-8")
    data = netcdf.load_dataset(case.parent / "results" / "dynamic.nc")
    assert data.status.values.tolist() == ["converged", "iteration limit"]
    assert np.isfinite(data.running_friction.values).tolist() == [True, False]
    assert str(data.prediction_status.item()).startswith("wave 2 of 3")
    rest = netcdf.load_dataset(case.parent / "results" / "static.nc")
    assert rest.sizes["scale"] == 3


@pytest.mark.usefixtures("undrawn")
def test_waves_solved_before_an_interrupt_are_on_disk(
    shell: Shell, changed: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    case, count, solve = changed("static = true", "static = false"), 0, HalfPlane.solve

    def stopping(
        self: HalfPlane, problem: WaveProblem, start: ScaleResult | None = None
    ) -> ScaleResult:
        nonlocal count
        count += 1
        if count == 3:
            raise KeyboardInterrupt
        return solve(self, problem, start)

    monkeypatch.setattr(HalfPlane, "solve", stopping)
    result = shell("run", case)
    assert result.exit_code == 130
    assert netcdf.load_dataset(case.parent / "results" / "dynamic.nc").sizes["scale"] == 2


@pytest.mark.usefixtures("undrawn")
def test_an_earlier_run_leaves_nothing_behind_and_other_files_stay(
    shell: Shell, changed: Callable[..., Path]
) -> None:
    case = changed("static = true", "static = false")
    figures = case.parent / "results" / "figures"
    figures.mkdir(parents=True)
    for name in ("static.nc", "notes.txt", "figures/heat.png", "figures/mine.png"):
        (case.parent / "results" / name).write_text("old")
    assert shell("run", case).exit_code == 0
    left = {p.name for p in (case.parent / "results").rglob("*") if p.is_file()}
    texts = {"case.toml", "report.txt", "chain.txt", "road.txt", "dma.txt", NOTE}
    texts |= {CASE_NOTE, "report.html"}
    assert left == texts | {"dynamic.nc", "answer.nc", "notes.txt", "mine.png"}


def test_a_finished_run_is_shown_again_and_not_made_again(
    shell: Shell, inputs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(FigureFolder, "rendered", lambda *_: {"png": b"a picture"})
    case = tmp_path / "case.toml"
    case.write_text((inputs / "case.toml").read_text())
    for path in inputs.iterdir():
        if path.is_file() and path.name != case.name:
            shutil.copy(path, tmp_path)
    figure = tmp_path / "results" / "figures" / "profile.png"

    def drawn(*options: str) -> bool:
        """Run the case; return whether its figures were drawn."""
        before = figure.stat().st_mtime_ns if figure.is_file() else 0
        result = shell("run", case, *options)
        assert result.exit_code == 0, result.output
        assert "Answer" in result.stdout
        new = figure.stat().st_mtime_ns != before
        assert ("nothing was solved again" in " ".join(result.stdout.split())) != new
        return new

    assert drawn()
    assert not drawn()
    assert drawn("--fresh")
    assert not drawn()
    figure.unlink()
    assert drawn()
    case.write_text(case.read_text() + "# a remark\n")
    assert drawn()
    (tmp_path / "results" / "uncertainty").mkdir()
    (tmp_path / "results" / "uncertainty" / "uncertainty.nc").write_text("none")
    assert drawn()


@pytest.mark.usefixtures("undrawn")
def test_waves_by_hand_and_a_named_rubber_need_no_files(shell: Shell, tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text(
        '[[surface.sines]]\nwavelength = "10 mm"\namplitude = "1 mm"\n'
        '[rubber]\nname = "styrene_butadiene"\n'
        '[load]\npressure = "3 bar"\nspeed = 0\nfootprint = "100 mm"\n'
        '[solver]\nmodel = "half_plane"\npoints = 64\n'
    )
    result = shell("run", case)
    assert result.exit_code == 0, result.output
    assert "1 wave: real contact area" in result.stdout
    assert "Dynamic" not in result.stdout
    assert (tmp_path / "results" / "static.nc").exists()


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (1.9, ""),
        (2.0, "; about 2 s left"),
        (89.4, "; about 89 s left"),
        (600.0, "; about 10 min left"),
    ],
)
def test_a_line_says_how_long_the_others_may_take(seconds: float, words: str) -> None:
    assert time_left(seconds) == words


def test_ctrl_c_says_that_results_are_kept_only_where_there_are_some(
    shell: Shell, changed: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    case = changed("static = true", "static = false")

    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("gripscale.case_file.prepare_surface", stop)
    monkeypatch.setattr("gripscale.case_file.read_case", stop)
    for command in (["fit-surface", case.with_name("road.txt")], ["run", case]):
        stopped = shell(*command)
        assert stopped.exit_code == 130
        assert stopped.stderr == "Stopped; nothing was finished.\n"
    monkeypatch.undo()
    assert shell("run", case).exit_code == 0
    monkeypatch.setattr("gripscale.case_file.read_case", stop)
    kept = shell("run", case, "--fresh")
    assert f"what was finished is kept in {case.parent / 'results'}" in kept.stderr
