"""The deformed blocks of a prediction as one picture inside the page."""

from __future__ import annotations

import base64
import io

from PIL import Image as Picture

from gripscale.figures import blocks_figure
from gripscale.figures.style import write_png
from gripscale.figures.view import PredictionView
from gripscale.report.elements import Image

DPI = 170
SHADES = 96
"""Colours the picture is reduced to: a third of the bytes, no visible loss."""


def blocks_image(prediction: PredictionView) -> Image:
    """Draw the blocks of `prediction`."""
    drawn, packed = io.BytesIO(), io.BytesIO()
    write_png(blocks_figure(prediction.data), drawn, DPI)
    picture = Picture.open(drawn).convert("RGB")
    picture.quantize(SHADES).save(packed, "PNG", optimize=True)
    return Image(
        f"blocks-{prediction.name}",
        f"{prediction.title}: deformed rubber on each rigid wave, contact pressure above. Lengths "
        "in wavelengths, to scale.",
        f"{prediction.waves} panels, largest wave first: contact pressure and deformed mesh of the "
        f"{prediction.name} prediction.",
        base64.b64encode(packed.getvalue()).decode("ascii"),
        "image/png",
        *picture.size,
    )
