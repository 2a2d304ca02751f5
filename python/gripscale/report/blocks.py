"""Figures as pictures inside the page."""

from __future__ import annotations

import base64
import io

from matplotlib.figure import Figure
from PIL import Image as Picture

from gripscale.figures import blocks_figure
from gripscale.figures.style import write_png
from gripscale.figures.view import PredictionView
from gripscale.report.elements import Image

DPI = 170
SHADES = 96
"""Colours the picture is reduced to: a third of the bytes, no visible loss."""


def picture(figure: Figure, name: str, caption: str, alt: str) -> Image:
    """Return a figure as a picture with its caption and a text for who cannot see it."""
    drawn, packed = io.BytesIO(), io.BytesIO()
    write_png(figure, drawn, DPI)
    found = Picture.open(drawn).convert("RGB")
    found.quantize(SHADES).save(packed, "PNG", optimize=True)
    data = base64.b64encode(packed.getvalue()).decode("ascii")
    return Image(name, caption, alt, data, "image/png", *found.size)


def blocks_image(prediction: PredictionView) -> Image:
    """Draw the blocks of `prediction`."""
    return picture(
        blocks_figure(prediction.data),
        f"blocks-{prediction.name}",
        f"{prediction.title}: deformed rubber on each rigid wave, contact pressure above. Lengths "
        "in wavelengths, to scale.",
        f"{prediction.waves} panels, largest wave first: contact pressure and deformed mesh of the "
        f"{prediction.name} prediction.",
    )
