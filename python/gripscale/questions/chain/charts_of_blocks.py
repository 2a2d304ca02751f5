"""The deformed rubber block of each wave on its rigid sine, with the contact pressure above it.

Described once, as charts are; `gripscale.questions.chain.charts_on_paper` draws the description.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gripscale.charts import draw
from gripscale.charts.chart import Drawing
from gripscale.charts.page_elements import Image, Picture
from gripscale.charts.style import WIDE
from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.units import MILLI
from gripscale.questions.chain.view import PredictionView

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class DrawnBlock:
    """One wave: pressure and mesh of a solution, or the words why there is none."""

    caption: str
    steepness: float
    """Amplitude of the rigid wave over its wavelength."""
    mean: float
    """Mean pressure in the unit of the figure."""
    pressure: tuple[Array, Array] | None
    """x over the wavelength and contact pressure; None without a solution."""
    mesh: tuple[Array, Array] | None
    """Nodes in wavelengths, see `PredictionView.mesh_along`; None without them."""
    slides: bool


@dataclass(frozen=True)
class Blocks(Drawing):
    """Blocks of a figure on paper, row by row."""

    blocks: Sequence[DrawnBlock]
    pressure_unit: str
    columns: int
    width: float
    """Of the figure with all its columns [inch]."""

    def on_paper(self) -> Figure:
        """Draw the blocks with matplotlib, which is imported here."""
        from gripscale.questions.chain.charts_on_paper import blocks_on_paper

        return blocks_on_paper(self)


def block_figure(prediction: xr.Dataset, wave: int = 1) -> Figure:
    """Draw one wave: contact pressure above the deformed mesh and the rigid sine.

    Parameters
    ----------
    prediction
        Dataset over `scale`, of a prediction or of `gripscale.wave.result.waves_to_dataset`.
    wave
        Number of the wave, from 1.

    Raises
    ------
    InputError
        If there is no such wave.
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
