"""Figures drawn by another process are those of this one, and what goes wrong is said."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest

from gripscale.charts.chart import Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.figure_folder import FigureFolder, FigureProcess, figures_elsewhere
from gripscale.core.errors import FileError
from gripscale.questions.chain.charts_of_blocks import Blocks, DrawnBlock

X = np.linspace(-0.5, 0.5, 33)
SHEET = Sheet([Panel(PlotAxis("$x$ [mm]"), PlotAxis("height [mm]"), [Series(X, X**2)])])
BLOCKS = Blocks([DrawnBlock("wave", 0.1, 1.0, (X, 1.0 + X), None, slides=True)], "MPa", 1, 4.2)


def test_another_process_draws_the_same_pixels(tmp_path: Path) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    for folder in (here, there):
        folder.mkdir()
    process = FigureProcess(FigureFolder(there, ("png", "pdf", "svg")))
    for figures in (FigureFolder(here), process):
        figures.save(SHEET, "sheet")
        figures.save(BLOCKS, "blocks")
    process.close()
    assert {path.name for path in there.iterdir()} == {
        f"{name}.{kind}" for name in ("sheet", "blocks") for kind in ("png", "pdf", "svg")
    }
    for name in ("sheet.png", "blocks.png"):
        assert (here / name).read_bytes() == (there / name).read_bytes()
    assert "height [mm]" in (there / "sheet.svg").read_text()


def test_a_figure_that_cannot_be_written_is_named_at_the_end(tmp_path: Path) -> None:
    process = FigureProcess(FigureFolder(tmp_path / "nowhere"))
    process.save(SHEET, "sheet")
    with pytest.raises(FileError, match=r"nowhere/sheet\.png cannot be written"):
        process.close()


def test_what_is_saved_after_the_end_of_the_process_does_not_hide_why_it_ended(
    tmp_path: Path,
) -> None:
    process = FigureProcess(FigureFolder(tmp_path / "nowhere"))
    many = Series(np.arange(1e6), np.arange(1e6))
    for _ in range(3):
        process.save(Sheet([Panel(PlotAxis("x"), PlotAxis("y"), [many])]), "sheet")
    with pytest.raises(FileError, match="cannot be written"):
        process.close()


def test_an_error_ends_the_other_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "matplotlib.figure", raising=False)
    elsewhere = figures_elsewhere(FigureFolder(tmp_path))
    figures = elsewhere.__enter__()
    assert isinstance(figures, FigureProcess)
    assert not elsewhere.__exit__(KeyboardInterrupt, KeyboardInterrupt(), None)
    assert figures._process.returncode < 0
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.name != "posix", reason="sessions are of POSIX")
def test_ctrl_c_reaches_this_process_alone(tmp_path: Path) -> None:
    process = FigureProcess(FigureFolder(tmp_path))
    assert os.getsid(process._process.pid) != os.getsid(0)
    process.close()


def test_this_process_draws_once_matplotlib_is_imported(tmp_path: Path) -> None:
    import matplotlib.figure  # noqa: F401

    with figures_elsewhere(FigureFolder(tmp_path)) as figures:
        assert isinstance(figures, FigureFolder)
        figures.save(SHEET, "sheet")
    assert (tmp_path / "sheet.png").is_file()
