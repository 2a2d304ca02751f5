"""`gripscale run` from files to tables, figures and results."""

import os
import subprocess
import sys
import threading
from dataclasses import replace

import numpy as np
import pytest

from gripscale.case_file.folder import AT_TIMES, CASE_NOTE, RESULT_FILES
from gripscale.core import ConvergenceError
from gripscale.core.status import Status
from gripscale.experiment import Task
from gripscale.io import netcdf
from gripscale.questions.answer.answer import answer_by
from gripscale.questions.terminal import time_left
from gripscale.surface import self_affine_profile
from gripscale.theory import HalfPlane
from tests.report.reading import Page
from tests.samples import (
    HALF_PLANE,
    TWO_WAVES,
    case_text,
    write_master_curve,
    write_maxwell,
    write_road,
)

WAVES_BY_HAND = case_text(
    '[[surface.sines]]\nwavelength = "10 mm"\namplitude = "1 mm"', solver=HALF_PLANE
)


@pytest.fixture(scope="module")
def done(shell, inputs, tmp_path_factory):
    """The small case, run once."""
    target = tmp_path_factory.mktemp("done") / "deep" / "results"
    return shell("run", inputs / "case.toml", "--output", target), target


def test_run_ends_well_and_writes_everything(done):
    result, target = done
    assert result.stderr == ""
    written = {str(p.relative_to(target)) for p in target.rglob("*") if p.is_file()}
    kept = {name for name in written if name.startswith("predictions/")}
    assert len(kept) == 2, "the direct contact and the chain"
    of_others = {"cut_off.nc"} | {name for name in RESULT_FILES if name.startswith("figures/")}
    assert (
        written
        == {*RESULT_FILES, CASE_NOTE, "inputs/road.txt", "inputs/dma.txt"} - of_others | kept
    )


def test_figures_are_files_where_the_case_asks_for_them(shell, changed):
    case = changed("[output]", '[output]\nfigures = ["svg"]')
    result = shell("run", case)
    assert "Results and figures are in" in result.output
    written = {f"figures/{path.name}" for path in (case.parent / "results/figures").iterdir()}
    of_others = {name for name in RESULT_FILES if any(f"/{figure}." in name for figure in AT_TIMES)}
    assert written == {name for name in RESULT_FILES if name.endswith(".svg")} - of_others


def test_output_fits_its_width_without_colour_codes(done):
    result, target = done
    assert "wave 3 of 3" not in result.output  # progress is for terminals
    assert "\x1b" not in result.output
    lines = [line for line in result.output.splitlines() if str(target) not in line]
    assert max(len(line) for line in lines if "case.toml" not in line) <= 100
    assert "…" not in result.output


def test_a_run_prints_one_screen_and_the_rest_where_it_is_asked_for(done, inputs, shell):
    result, target = done
    lines = result.output.splitlines()
    assert len(lines) <= 45
    assert sum(line[:2] in ("1 ", "2 ", "3 ") for line in lines) == 3  # the waves of the chain
    verbose = shell("run", inputs / "case.toml", "--output", target, "--verbose").output
    _, opening, last = verbose.split("Answer: ")
    assert last.strip(), "the answer is the last thing"
    assert opening.startswith(last.strip())
    assert verbose.count(" converged") == 3
    assert "For comparison, the paper's chain of waves: μ = " in verbose
    assert "s_wavelength = 3.000" in verbose
    for words in ("Dynamic, 0.3 m/s", "stretch", "3 sine waves from", "Maxwell elements", "spikes"):
        assert words in verbose
        assert words not in result.output


def test_case_is_copied_but_for_the_names_of_its_files(done, inputs):
    text = (inputs / "case.toml").read_text()
    for name in ("road.txt", "dma.txt"):
        text = text.replace(name, f"inputs/{name}")
        assert (done[1] / "inputs" / name).read_bytes() == (inputs / name).read_bytes()
    assert (done[1] / "case.toml").read_text() == text


@pytest.mark.usefixtures("undrawn")
def test_a_chain_that_fails_leaves_the_answer_of_a_measured_surface(shell, changed, monkeypatch):
    solve = HalfPlane.solve

    def failing(self, problem, start=None):
        return replace(solve(self, problem, start), status=Status.ITERATION_LIMIT)

    monkeypatch.setattr(HalfPlane, "solve", failing)
    case = changed()
    result = shell("run", case)
    assert "chain of waves: No totals: wave 1 did not converge (iteration limit)" in " ".join(
        result.stdout.split()
    )
    chain = netcdf.load_dataset(case.parent / "results" / "chain.nc")
    assert str(chain.prediction_status.item()).startswith("wave 1 of 3")
    stated = case.with_name("stated.toml")
    _, rest = case.read_text().split("[rubber]")
    stated.write_text(f"{TWO_WAVES}[rubber]{rest}")
    result = shell("run", stated, "--output", case.parent / "stated", code=3)
    assert result.stderr.count("\n") == 1
    assert "wave 1 of 2" in result.stderr


@pytest.mark.usefixtures("undrawn")
def test_an_earlier_run_leaves_nothing_behind_and_other_files_stay(shell, changed):
    case = changed()
    figures = case.parent / "results" / "figures"
    figures.mkdir(parents=True)
    for name in ("static.nc", "notes.txt", "figures/heat.png", "figures/mine.png"):
        (case.parent / "results" / name).write_text("old")
    shell("run", case)
    folder = case.parent / "results"
    left = {p.name for p in folder.rglob("*") if p.is_file() and p.parent.name != "predictions"}
    texts = {"case.toml", "road.txt", "dma.txt", CASE_NOTE, "report.html"}
    assert left == texts | {"chain.nc", "answer.nc", "notes.txt", "mine.png"}


@pytest.mark.usefixtures("undrawn")
def test_what_was_finished_before_ctrl_c_is_kept_and_not_solved_again(shell, changed, monkeypatch):
    def stop(*_, **__):
        raise KeyboardInterrupt

    case, solve = changed(), Task.solve
    with monkeypatch.context() as patch:
        patch.setattr("gripscale.case_file.prepare_surface", stop)
        patch.setattr("gripscale.case_file.read_case", stop)
        for command in (["fit-surface", case.with_name("road.txt")], ["run", case]):
            stopped = shell(*command, code=130)
            assert stopped.stderr == "Stopped; nothing was finished.\n"
    printed = threading.Event()

    def answer_then(*given):
        result = answer_by(*given)
        printed.set()
        return result

    def stop_after_answer(*given):
        printed.wait(60.0)
        stop()

    with monkeypatch.context() as patch:  # in the chain, when the direct contact is solved
        patch.setattr("gripscale.cli.solve_run.answer_by", answer_then)
        patch.setattr(HalfPlane, "solve", stop_after_answer)
        stopped = shell("run", case, code=130)
    assert "Answer: " in stopped.stdout
    assert f"what was finished is kept in {case.parent / 'results'}" in stopped.stderr
    solved = []

    def counting(self, *arguments, **options):
        solved.append(self.model.name)
        return solve(self, *arguments, **options)

    monkeypatch.setattr(Task, "solve", counting)
    first, second = (shell("run", case).stdout for _ in range(2))
    assert solved == ["chain"]
    assert first == second


@pytest.mark.usefixtures("undrawn")
def test_a_chain_that_fails_at_once_leaves_the_answer(shell, changed, monkeypatch):
    def fail(*_):
        raise ConvergenceError("no wave has a solution")

    monkeypatch.setattr(HalfPlane, "solve", fail)
    failed = shell("run", changed(), code=3)
    assert "Answer: " in failed.stdout
    assert "no wave has a solution" in failed.stderr


@pytest.mark.usefixtures("undrawn")
def test_waves_by_hand_and_a_named_rubber_need_no_files(shell, tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(WAVES_BY_HAND.replace('"0.3 m/s"', "0"))
    result = shell("run", case)
    assert "1 wave: real contact area" in result.stdout
    assert "Dynamic" not in result.stdout
    chain = netcdf.load_dataset(tmp_path / "results" / "chain.nc")
    assert np.isinf(chain.load_time).all()


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (1.9, ""),
        (2.0, "; about 2 s left"),
        (89.4, "; about 89 s left"),
        (600.0, "; about 10 min left"),
    ],
)
def test_a_line_says_how_long_the_others_may_take(seconds, words):
    assert time_left(seconds) == words


EXTRAS = ("bokeh", "jinja2", "panel", "openpyxl", "dask", "distributed", "SurfaceTopography")
WITHOUT = f"import sys\nsys.modules |= dict.fromkeys({EXTRAS})\n"


def test_a_run_is_drawn(tmp_path):
    (tmp_path / "case.toml").write_text(case_text(TWO_WAVES, solver=HALF_PLANE))
    (tmp_path / "sitecustomize.py").write_text(WITHOUT)
    subprocess.run(
        [sys.executable, "-m", "gripscale", "run", "case.toml"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])},
        check=True,
    )
    figures = [path.stat().st_size for path in (tmp_path / "results" / "figures").glob("*.png")]
    assert len(figures) > 1
    assert min(figures) > 10_000


SURFACE = 'files = ["road.txt"]\nscales = 4\nsmallest_wavelength = "0.8 mm"\nspikes = "iso13473"'
CASE = case_text(
    SURFACE, 'file = "dma.txt"\nterms = 6', HALF_PLANE + '\n\n[output]\nfolder = "results"'
)


@pytest.fixture
def case(tmp_path):
    """A rough road of 0.6 m and a rubber measured over all its frequencies."""
    write_maxwell(tmp_path / "dma.txt")
    road = self_affine_profile(0.8, 1e-2, 8e-4, length=0.6, step=2e-4, seed=1)
    write_road(tmp_path / "road.txt", road)
    (tmp_path / "case.toml").write_text(CASE)
    return tmp_path / "case.toml"


def replaced(case, old, new):
    text = case.read_text()
    assert old in text
    case.write_text(text.replace(old, new))


@pytest.mark.usefixtures("undrawn")
def test_the_first_line_says_that_there_is_no_answer(shell, case):
    replaced(case, "scales", 'crop = ["200 mm", "220 mm"]\nscales')
    result = shell("compare", case, "--models", "chain_half_plane,direct", columns=400)
    lines = [line for line in result.stdout.splitlines() if line and line[0] not in "[gCS"]
    statement = "Answer: none to rely on. The measured surface is too small"
    assert lines[0].startswith(statement)
    (best,) = (line for line in lines if line.startswith("Best estimate"))
    assert best.endswith("; not to be relied on")
    page = Page(case.parent / "results" / "comparison" / "report.html")
    assert len([a for _, a in page.tags if a.get("role") == "alert"]) == 1
    assert "not to be relied on" in page.text, "in the cards"
    assert statement in page.text


@pytest.mark.usefixtures("undrawn")
def test_what_cannot_be_solved_is_an_error_before_all_else(shell, case):
    frequency = np.geomspace(1e-3, 1e3, 49)
    relaxed = 1j * frequency / (1.0 + 1j * frequency)
    write_master_curve(case.with_name("dma.txt"), frequency, 1e6 * relaxed + 1e3j * frequency)
    replaced(case, '"0.3 m/s"', "0")
    result = shell("run", case, code=2)
    assert result.stdout == ""
    assert "the pressure squeezes the rubber, a melt at rest, flat" in result.stderr
    assert "must be at least 1/10 of the pressure, 3e+04; got" in result.stderr
