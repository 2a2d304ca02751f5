"""Figures go into their folder as each of its kinds, drawn from what describes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gripscale.charts.chart import Panel, PlotAxis, Series
from gripscale.charts.draw import FigureFolder, Sheet
from gripscale.core.errors import FileError

X = np.linspace(-0.5, 0.5, 33)
SHEET = Sheet([Panel(PlotAxis("$x$ [mm]"), PlotAxis("height [mm]"), [Series(X, X**2)])])


def test_a_sheet_is_written_as_each_kind(tmp_path: Path) -> None:
    FigureFolder(tmp_path, ("png", "pdf", "svg")).save(SHEET, "sheet")
    FigureFolder(tmp_path).save(SHEET.on_paper(), "drawn")
    assert {path.name for path in tmp_path.iterdir()} == {
        *("sheet.png", "sheet.pdf", "sheet.svg", "drawn.png")
    }
    assert (tmp_path / "sheet.png").read_bytes() == (tmp_path / "drawn.png").read_bytes()
    assert "height [mm]" in (tmp_path / "sheet.svg").read_text()


def test_a_figure_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"nowhere/sheet\.png cannot be written"):
        FigureFolder(tmp_path / "nowhere").save(SHEET, "sheet")
