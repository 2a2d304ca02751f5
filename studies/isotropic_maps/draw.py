"""The figure of docs/isotropic-maps.md: a measured line over lines of maps, the maps beside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gripscale.surface import Profile

Heights = NDArray[np.float64]

LABELS = {
    "spectrum": "(a) spectrum",
    "heights": "(b) spectrum and heights",
    "lines": "(c) statistics of pieces of the line, by height",
}
FIRST = 0.4
"""Where the piece of the measured line begins, as a share of it."""
RISE, SHADE = 7.0, 1.2
"""Half of the heights shown [mm]; slope that is black or white."""


def draw(measured: Profile, maps: dict[str, Heights], length: float, path: Path) -> None:
    """Draw the piece of the measured line, then for each map a line and the shaded map."""
    figure = Figure(figsize=(9.0, 8.4), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(1 + len(maps), 2, width_ratios=(2.4, 1.0))
    points = round(length / measured.step)
    first = round(FIRST * len(measured))
    piece = measured.z[first : first + points]
    x = np.arange(points, dtype=np.float64) * measured.step
    _line(figure.add_subplot(grid[0, 0]), x, piece - np.nanmean(piece), "measured, station 0")
    note = figure.add_subplot(grid[0, 1])
    note.axis("off")
    note.text(0.0, 0.5, "maps lit along x;\nall maps are synthetic", va="center", fontsize=9)
    for row, (name, z) in enumerate(maps.items(), start=1):
        step = length / z.shape[0]
        x = np.arange(z.shape[0], dtype=np.float64) * step
        _line(figure.add_subplot(grid[row, 0]), x, z[:, z.shape[1] // 2], LABELS[name])
        axes = figure.add_subplot(grid[row, 1])
        slope = np.gradient(z, step, axis=0)
        extent = (0.0, length * 1e3, 0.0, length * 1e3)
        axes.imshow(slope.T, cmap="gray", vmin=-SHADE, vmax=SHADE, extent=extent, origin="lower")
        axes.set_xticks([0, 25, 50])
        axes.set_yticks([0, 25, 50])
        axes.set_xlabel("x [mm]" if row == len(maps) else "")
    figure.axes[-2].set_xlabel("x [mm]")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=90, pil_kwargs={"optimize": True})


def _line(axes: Axes, x: Heights, z: Heights, label: str) -> None:
    axes.plot(x * 1e3, z * 1e3, color="0.15", linewidth=0.9)
    axes.set_aspect("equal")
    axes.set_xlim(0.0, 51.2)
    axes.set_ylim(-RISE, RISE)
    axes.set_ylabel("z [mm]")
    axes.set_title(label, loc="left", fontsize=9)
