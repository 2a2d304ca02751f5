"""The deformed blocks of a chain as one picture inside the page."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from PIL import Image as Picture

from gripscale.figures import blocks_figure
from gripscale.figures.style import RULES
from gripscale.html_report.elements import Image
from gripscale.html_report.source import Array, Chain
from gripscale.scale import ScaleResult

DPI = 170
SHADES = 96
"""Colours the picture is reduced to: a third of the bytes, no visible loss."""


def blocks_image(chain: Chain) -> Image:
    """Draw the blocks of `chain`, which has `mesh_x` and `mesh_z` if the solver gave them."""
    picture = _picture(_scales(chain))
    packed = io.BytesIO()
    picture.quantize(SHADES).save(packed, "PNG", optimize=True)
    return Image(
        f"blocks-{chain.name}",
        f"{chain.title}: deformed rubber on each rigid wave, contact pressure above. Lengths in "
        "wavelengths, to scale.",
        f"{chain.waves} panels, largest wave first: contact pressure and deformed mesh of the "
        f"{chain.name} chain.",
        base64.b64encode(packed.getvalue()).decode("ascii"),
        "image/png",
        *picture.size,
    )


def _picture(scales: Sequence[ScaleResult]) -> Picture.Image:
    drawn = io.BytesIO()
    with mpl.rc_context(RULES):
        blocks_figure(scales).savefig(drawn, format="png", dpi=DPI)
    return Picture.open(drawn).convert("RGB")


def _scales(chain: Chain) -> list[ScaleResult]:
    """Return the waves as the figure wants them."""
    return [_scale(chain, i) for i in range(chain.waves)]


def _scale(chain: Chain, i: int) -> ScaleResult:
    def value(name: str) -> float:
        return float(chain.column(name)[i])

    x, pressure = chain.column("surface_x")[i], chain.column("surface_pressure")[i]
    known = np.isfinite(x)
    return ScaleResult(
        wavelength=value("wavelength"),
        amplitude=value("amplitude"),
        pressure_received=value("pressure_received"),
        speed=chain.speed,
        load_time=value("load_time"),
        contact_fraction=value("contact_fraction"),
        friction=value("friction"),
        friction_from_dissipation=value("friction_from_dissipation"),
        status=_plain(str(chain.data["status"].values[i])),
        newton_iterations=int(value("newton_iterations")),
        residual=value("residual"),
        min_stretch=value("min_stretch"),
        max_stretch=value("max_stretch"),
        x=x[known],
        pressure=pressure[known],
        deformed_mesh=_mesh(chain, i),
    )


def _mesh(chain: Chain, i: int) -> tuple[Array, Array] | None:
    """Return the mesh of wave `i` without the padding, or None."""
    if not (chain.has("mesh_x") and chain.has("mesh_z")):
        return None
    x, z = chain.column("mesh_x")[i], chain.column("mesh_z")[i]
    layers, columns = np.isfinite(x).any(axis=1), np.isfinite(x).any(axis=0)
    if not layers.any():
        return None
    return x[np.ix_(layers, columns)], z[np.ix_(layers, columns)]


def _plain(text: str) -> str:
    """Return `text` without what matplotlib takes for mathematics."""
    return text.replace("$", "")
