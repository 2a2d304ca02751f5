"""Pictures of a page: figures drawn with matplotlib, as few bytes as look the same."""

from __future__ import annotations

import base64
import io

import PIL.Image

from gripscale.charts.page_elements import Image, Picture
from gripscale.charts.paper import png

PICTURE_DPI = 170

SHADES = 96
"""Colours the picture is reduced to: a third of the bytes, no visible loss."""


def packed_image(picture: Picture) -> Image:
    """Return a picture as a page holds it."""
    drawn, packed = io.BytesIO(png(picture.figure, PICTURE_DPI)), io.BytesIO()
    pixels = PIL.Image.open(drawn).convert("RGB")
    pixels.quantize(SHADES).save(packed, "PNG")
    data = base64.b64encode(packed.getvalue()).decode("ascii")
    name = picture.name.replace("_", "-")
    return Image(name, picture.caption, picture.alt, data, "image/png", *pixels.size)
