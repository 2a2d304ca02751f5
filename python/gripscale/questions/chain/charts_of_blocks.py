"""The deformed rubber block of each wave on its rigid sine, with the contact pressure above it.

Described once, as charts are; matplotlib is imported as the description is drawn.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from gripscale.charts.draw import Drawing
from gripscale.charts.style import BLUE, DASHES, DPI, FAINT, GREY, INK, ORANGE, ROUND, WIDE
from gripscale.core import Array, checks
from gripscale.core.units import MILLI
from gripscale.questions.chain.view import PredictionView

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LINE = 0.12  # of a title beyond its third line [inch]
FOR_WORDS = 0.2  # wavelengths left free above a wave without a mesh
MESH_DEPTH = 0.55  # depth of the block that is shown [wavelengths]
PRESSURE = 0.42  # height of a panel of pressure over its width
# Beside the panels: for the labels of the first, at the end, for numbers between two [inch].
LEFT, RIGHT, BETWEEN = 0.6, 0.22, 0.42
# Of a row of panels: its titles, between pressure and block, numbers; below the last [inch].
_HEAD, MIDDLE, FOOT, LAST = 0.5, 0.2, 0.22, 0.22


@dataclass(frozen=True)
class DrawnBlock:
    """One wave: pressure and mesh of a solution, or the words why there is none."""

    caption: str
    steepness: float  # amplitude of the rigid wave over its wavelength
    mean: float  # mean pressure in the unit of the figure
    # x over the wavelength and contact pressure; None without a solution.
    pressure: tuple[Array, Array] | None
    # Nodes in wavelengths, see `PredictionView.mesh_along`; None without them.
    mesh: tuple[Array, Array] | None
    slides: bool

    @classmethod
    def of(cls, view: PredictionView, i: int) -> DrawnBlock:
        """Return wave `i`; what a failed wave ended with is no result."""
        columns = ("wavelength", "amplitude", "pressure_received", "contact_fraction")
        length, amplitude, mean, contact = (float(view.column(name)[i]) for name in columns)
        unit, solved = view.display_unit("pressure"), bool(view.converged[i])
        caption = (
            f"λ = {length / MILLI:.3g} mm\nA = {amplitude / MILLI:.3g} mm\n"
            f"p = {unit.of(mean):.3g} {unit.unit}"
        )
        pressure = None
        if solved:
            caption += f", contact {contact:.2f}"
            x, pascal = view.pressure_along(i)
            pressure = x, unit.of(pascal)
        else:
            caption += f"\n{textwrap.fill(view.why(i), 30)}"
        mesh = view.mesh_along(i) if solved else None
        slides = bool(view.column("sliding_speed")[i] > 0.0)
        return cls(caption, amplitude / length, float(unit.of(mean)), pressure, mesh, slides)

    def draw_pressure(self, axes: Axes) -> None:
        """Draw the contact pressure along one wavelength and its mean; of a failed wave that."""
        from matplotlib.ticker import MaxNLocator

        if self.pressure is None:
            axes.text(0.5, 0.75, "no solution", transform=axes.transAxes, ha="center", va="center")
            axes.set_ylim(0.0, 2.0 * self.mean)
        else:
            axes.fill_between(*self.pressure, color=ORANGE, alpha=0.35, lw=0)
            axes.plot(*self.pressure, color=ORANGE, lw=1.0)
            axes.set_ylim(bottom=0.0)
        axes.axhline(self.mean, color=GREY, lw=0.8, ls=DASHES["dashed"])
        axes.set_xlim(-0.5, 0.5)
        axes.set_xticks([])  # those of the block below hold here, too
        axes.yaxis.set_major_locator(MaxNLocator(2, steps=ROUND, min_n_ticks=2))
        axes.set_title(self.caption, loc="left", y=1.0, fontsize=7.0, parse_math=False)

    def draw_mesh(self, axes: Axes, low: float, high: float) -> None:
        """Draw the rigid wave and the block upon it between two heights [wavelengths].

        Of the periodic mesh what is seen, thinned where its lines would merge.
        """
        abscissa = np.linspace(-0.5, 0.5, 200)
        wave = self.steepness * np.cos(2.0 * math.pi * abscissa)
        axes.fill_between(abscissa, wave, low, color=FAINT, lw=0)
        if self.mesh is not None:
            x, z = self.mesh
            every = max((x.shape[1] - 1) // 32, 1)
            x = np.hstack([x[:, :-1] - 1.0, x[:, :-1], x + 1.0])
            z = np.hstack([z[:, :-1], z[:, :-1], z])
            seen = np.flatnonzero((x.max(axis=0) >= -0.5) & (x.min(axis=0) <= 0.5))
            columns = np.arange(max(seen[0] - 1, 0), min(seen[-1] + 2, x.shape[1]))
            above = np.flatnonzero(z.min(axis=1) > high)
            rows = np.arange(above[0] + 1 if above.size else len(z))
            x, z = x[np.ix_(rows, columns)], z[np.ix_(rows, columns)]
            upright, level = columns % every == 0, rows % max(len(self.mesh[0]) // 24, 1) == 0
            edge = [np.append(v[0], v[-1, ::-1]) for v in (x, z)]
            lines = [np.append(_joined(v[level]), _joined(v[:, upright].T)) for v in (x, z)]
            axes.fill(*edge, color=BLUE, alpha=0.10, lw=0)
            axes.plot(*lines, color=BLUE, lw=0.3, alpha=0.6, label="mesh")
            axes.plot(x[0], z[0], color=BLUE, lw=1.2, label="surface")
        axes.plot(abscissa, wave, color=INK, lw=0.9, label="wave")
        axes.set_xlim(-0.5, 0.5)
        axes.set_ylim(low, high)
        axes.set_xticks([-0.5, 0.0, 0.5], ["-0.5", "0", "0.5"])
        axes.grid(False)


def _joined(rows: Array) -> Array:
    """Return the rows as one, NaN after each: one line with gaps draws as fast as a single one."""
    return np.hstack([rows, np.full((len(rows), 1), math.nan)]).ravel()


@dataclass(frozen=True)
class Blocks(Drawing):
    """Blocks of a figure on paper, row by row."""

    blocks: Sequence[DrawnBlock]
    pressure_unit: str
    columns: int
    width: float  # of the figure with all its columns [inch]

    @classmethod
    def of(cls, view: PredictionView, waves: Iterable[int], columns: int, width: float) -> Blocks:
        """Return some waves of a prediction."""
        blocks = [DrawnBlock.of(view, i) for i in waves]
        return cls(blocks, view.display_unit("pressure").unit, columns, width)

    @property
    def window(self) -> tuple[float, float]:
        """Heights shown [wavelengths]: the deepest valley and a part of the block."""
        if not self.blocks:
            return -0.16, 0.16
        steepest = max(block.steepness for block in self.blocks)
        meshed = any(block.mesh is not None for block in self.blocks)
        return -steepest - 0.06, steepest + (MESH_DEPTH if meshed else FOR_WORDS)

    def on_paper(self) -> Figure:
        """Draw the blocks with matplotlib, whose own rules stay as they are.

        The panels are placed by hand: they are alike, and a layout engine takes as long as drawing.
        """
        from matplotlib.figure import Figure

        from gripscale.charts.paper import house_rules

        inside = (self.width - LEFT - RIGHT - (self.columns - 1) * BETWEEN) / self.columns
        columns = min(self.columns, max(len(self.blocks), 1))
        width = LEFT + RIGHT + columns * inside + (columns - 1) * BETWEEN
        low, high = self.window
        lines = max((block.caption.count("\n") for block in self.blocks), default=0)
        head = _HEAD + _LINE * max(lines - 2, 0)
        row_height = head + inside * (PRESSURE + high - low) + MIDDLE + FOOT
        height = max(math.ceil(len(self.blocks) / columns), 1) * row_height + LAST

        def panel(x: float, y: float, high: float) -> Axes:
            frame = x / width, 1 - (y + high) / height, inside / width, high / height
            return figure.add_axes(frame)

        with house_rules():
            figure = Figure(figsize=(width, height), dpi=DPI)
            for number, block in enumerate(self.blocks):
                row, column = divmod(number, columns)
                x, y = LEFT + column * (inside + BETWEEN), row * row_height + head
                above = panel(x, y, inside * PRESSURE)
                below = panel(x, y + inside * PRESSURE + MIDDLE, inside * (high - low))
                block.draw_pressure(above)
                block.draw_mesh(below, low, high)
                if number == 0 and block.pressure is not None:
                    self._name_parts(above, below)
                if column == 0:
                    above.set_ylabel(f"$p_c$ [{self.pressure_unit}]")
                    below.set_ylabel("$z/\\lambda$ [-]")
                else:
                    below.set_yticks([])  # those of the first block hold along the row
                if number + columns >= len(self.blocks):
                    below.set_xlabel("$x/\\lambda$ [-]")
        return figure

    def _name_parts(self, above: Axes, below: Axes) -> None:
        """Name the dashed line and, where the rubber slides, its direction (along x)."""
        first = self.blocks[0]
        look: dict[str, Any] = {"color": GREY, "fontsize": 6.5, "textcoords": "offset points"}
        above.annotate("mean", (-0.48, first.mean), (0, 2), **look)
        if first.slides:
            box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
            look = {"fontsize": 7.0, "va": "top", "bbox": box, "transform": below.transAxes}
            below.text(0.05, 0.95, "rubber slides $\\rightarrow$", **look)


def block_figure(prediction: xr.Dataset, wave: int = 1) -> Figure:
    """Draw one wave, by its number from 1: pressure above the deformed mesh and the rigid sine.

    `prediction` is over `scale`, as `gripscale.wave.result.waves_to_dataset` has it. Raises
    `InputError` if there is no such wave.
    """
    view = PredictionView(prediction)
    number = checks.whole("wave", wave, least=1, most=max(view.waves, 1))
    return Blocks.of(view, [number - 1], columns=1, width=4.2).on_paper()


def blocks_figure(prediction: xr.Dataset) -> Figure:
    """Draw every wave of a prediction, largest first, four side by side."""
    view = PredictionView(prediction)
    return Blocks.of(view, range(view.waves), columns=4, width=WIDE).on_paper()
