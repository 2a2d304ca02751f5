"""Folders of figures; matplotlib is imported when the first is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.charts.draw import Sheet
from gripscale.io.folders import write_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class FigureFolder:
    """A folder of figures and what they are written as."""

    path: Path
    kinds: Sequence[str] | None = None  # out of `gripscale.charts.paper.KINDS`; png by default

    def save(self, figure: Sheet | Figure, name: str) -> None:
        """Write a figure or what describes it; `FileError` if that fails."""
        from gripscale.charts.paper import figure_file

        drawn = figure.on_paper() if isinstance(figure, Sheet) else figure
        for kind in self.kinds or ("png",):
            write_bytes(self.path / f"{name}.{kind}", figure_file(drawn, kind))
