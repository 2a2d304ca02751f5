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

from gripscale.charts import draw
from gripscale.charts.page_elements import Image, Picture
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


@dataclass(frozen=True)
class Blocks(draw.Drawing):
    """Blocks of a figure on paper, row by row."""

    blocks: Sequence[DrawnBlock]
    pressure_unit: str
    columns: int
    width: float  # of the figure with all its columns [inch]

    def on_paper(self) -> Figure:
        """Draw the blocks with matplotlib, whose own rules stay as they are.

        The panels are placed by hand: they are alike, and a layout engine takes as long as drawing.
        """
        from matplotlib.figure import Figure

        from gripscale.charts.paper import house_rules

        inside = (self.width - LEFT - RIGHT - (self.columns - 1) * BETWEEN) / self.columns
        columns = min(self.columns, max(len(self.blocks), 1))
        width = LEFT + RIGHT + columns * inside + (columns - 1) * BETWEEN
        rows = max(math.ceil(len(self.blocks) / columns), 1)
        low, high = _window(self.blocks)
        lines = max((block.caption.count("\n") for block in self.blocks), default=0)
        head = _HEAD + _LINE * max(lines - 2, 0)
        row_height = head + inside * (PRESSURE + high - low) + MIDDLE + FOOT
        height = rows * row_height + LAST

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
                _draw_pressure(above, block)
                _draw_block(below, block, (low, high))
                above.set_title(block.caption, loc="left", y=1.0, fontsize=7.0, parse_math=False)
                if number == 0 and block.pressure is not None:
                    _annotate(above, below, block)
                if column == 0:
                    above.set_ylabel(f"$p_c$ [{self.pressure_unit}]")
                    below.set_ylabel("$z/\\lambda$ [-]")
                else:
                    below.set_yticks([])  # those of the first block hold along the row
                if number + columns >= len(self.blocks):
                    below.set_xlabel("$x/\\lambda$ [-]")
        return figure


def _window(blocks: Sequence[DrawnBlock]) -> tuple[float, float]:
    """Return the heights shown [wavelengths]: the deepest valley and a part of the block."""
    if not blocks:
        return -0.16, 0.16
    steepest = max(block.steepness for block in blocks)
    meshed = any(block.mesh is not None for block in blocks)
    return -steepest - 0.06, steepest + (MESH_DEPTH if meshed else FOR_WORDS)


def _draw_pressure(axes: Axes, block: DrawnBlock) -> None:
    """Draw the contact pressure along one wavelength and its mean; of a failed wave the mean."""
    from matplotlib.ticker import MaxNLocator

    if block.pressure is None:
        axes.text(0.5, 0.75, "no solution", transform=axes.transAxes, ha="center", va="center")
        axes.set_ylim(0.0, 2.0 * block.mean)
    else:
        axes.fill_between(*block.pressure, color=ORANGE, alpha=0.35, lw=0)
        axes.plot(*block.pressure, color=ORANGE, lw=1.0)
        axes.set_ylim(bottom=0.0)
    axes.axhline(block.mean, color=GREY, lw=0.8, ls=DASHES["dashed"])
    axes.set_xlim(-0.5, 0.5)
    axes.set_xticks([])  # those of the block below hold here, too
    axes.yaxis.set_major_locator(MaxNLocator(2, steps=ROUND, min_n_ticks=2))


def _draw_block(axes: Axes, block: DrawnBlock, window: tuple[float, float]) -> None:
    x = np.linspace(-0.5, 0.5, 200)
    wave = block.steepness * np.cos(2.0 * math.pi * x)
    axes.fill_between(x, wave, window[0], color=FAINT, lw=0)
    if block.mesh is not None:
        _mesh(axes, *block.mesh, top=window[1])
    axes.plot(x, wave, color=INK, lw=0.9, label="wave")
    axes.set_xlim(-0.5, 0.5)
    axes.set_ylim(*window)
    axes.set_xticks([-0.5, 0.0, 0.5], ["-0.5", "0", "0.5"])
    axes.grid(False)


def _annotate(above: Axes, below: Axes, block: DrawnBlock) -> None:
    """Name the dashed line and, where the rubber slides, its direction (along x)."""
    mean = (-0.48, block.mean)
    above.annotate("mean", mean, (0, 2), textcoords="offset points", color=GREY, fontsize=6.5)
    if block.slides:
        box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
        look: dict[str, Any] = {"fontsize": 7.0, "va": "top", "bbox": box}
        text = "rubber slides $\\rightarrow$"
        below.text(0.05, 0.95, text, transform=below.transAxes, **look)


def _mesh(axes: Axes, x: Array, z: Array, top: float) -> None:
    """Draw the part of the periodic mesh that is seen, thinned where its lines would merge."""
    every = max((x.shape[1] - 1) // 32, 1)
    x = np.hstack([x[:, :-1] - 1.0, x[:, :-1], x + 1.0])
    z = np.hstack([z[:, :-1], z[:, :-1], z])
    seen = np.flatnonzero((x.max(axis=0) >= -0.5) & (x.min(axis=0) <= 0.5))
    first, last = max(seen[0] - 1, 0), seen[-1] + 2
    rows = int(np.argmax(z.min(axis=1) > top)) + 1 if (z.min(axis=1) > top).any() else len(z)
    upright = np.arange(first, last)[np.arange(first, last) % every == 0]
    level = slice(None, rows, max(x.shape[0] // 24, 1))
    edge = [np.append(v[0, first:last], v[rows - 1, first:last][::-1]) for v in (x, z)]
    lines = [np.append(_joined(v[level, first:last]), _joined(v[:rows, upright].T)) for v in (x, z)]
    axes.fill(*edge, color=BLUE, alpha=0.10, lw=0)
    axes.plot(*lines, color=BLUE, lw=0.3, alpha=0.6, label="mesh")
    axes.plot(x[0, first:last], z[0, first:last], color=BLUE, lw=1.2, label="surface")


def _joined(rows: Array) -> Array:
    """Return the rows as one, NaN after each: one line with gaps draws as fast as a single one."""
    return np.hstack([rows, np.full((len(rows), 1), math.nan)]).ravel()


def block_figure(prediction: xr.Dataset, wave: int = 1) -> Figure:
    """Draw one wave: contact pressure above the deformed mesh and the rigid sine.

    Raises `InputError` if there is no such wave.

    Parameters
    ----------
    prediction
        Dataset over `scale`, of a prediction or of `gripscale.wave.result.waves_to_dataset`.
    wave
        Number of the wave, from 1.
    """
    view = PredictionView(prediction)
    number = checks.whole("wave", wave, least=1, most=max(view.waves, 1))
    return _described(view, [number - 1], columns=1, width=4.2).on_paper()


def blocks_figure(prediction: xr.Dataset) -> Figure:
    """Draw every wave of a prediction, largest first, four side by side."""
    return all_blocks(prediction).on_paper()


def all_blocks(prediction: xr.Dataset) -> Blocks:
    """Describe every wave of a prediction, largest first, four side by side."""
    view = PredictionView(prediction)
    return _described(view, range(view.waves), columns=4, width=WIDE)


def _described(view: PredictionView, waves: Iterable[int], columns: int, width: float) -> Blocks:
    blocks = [_block(view, i) for i in waves]
    return Blocks(blocks, view.display_unit("pressure").unit, columns, width)


def _block(view: PredictionView, i: int) -> DrawnBlock:
    """Describe wave `i`; what a failed wave ended with is no result."""
    unit, solved = view.display_unit("pressure"), bool(view.converged[i])
    pressure = None
    if solved:
        x, pascal = view.pressure_along(i)
        pressure = x, unit.of(pascal)
    return DrawnBlock(
        caption=_caption(view, i),
        steepness=float(view.column("amplitude")[i] / view.column("wavelength")[i]),
        mean=float(unit.of(view.column("pressure_received")[i])),
        pressure=pressure,
        mesh=view.mesh_along(i) if solved else None,
        slides=bool(view.column("sliding_speed")[i] > 0.0),
    )


def _caption(view: PredictionView, i: int) -> str:
    def value(name: str, unit: float) -> str:
        return f"{view.column(name)[i] / unit:.3g}"

    pressure_unit = view.display_unit("pressure")
    contact = f", contact {view.column('contact_fraction')[i]:.2f}"
    return (
        f"λ = {value('wavelength', MILLI)} mm\n"
        f"A = {value('amplitude', MILLI)} mm\n"
        f"p = {value('pressure_received', pressure_unit.divisor)} {pressure_unit.unit}"
        + (contact if view.converged[i] else f"\n{textwrap.fill(view.why(i), 30)}")
    )


def blocks_image(prediction: PredictionView) -> Image:
    """Draw the blocks of `prediction`."""
    picture = Picture(
        f"blocks_{prediction.name}",
        blocks_figure(prediction.data),
        f"{prediction.title}: deformed rubber on each rigid wave, contact pressure above. Lengths "
        "in wavelengths, to scale.",
        f"{prediction.waves} panels, largest wave first: contact pressure and deformed mesh of the "
        f"{prediction.name} prediction.",
    )
    return draw.image(picture)
