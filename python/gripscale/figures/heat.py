"""How warm the rubber gets in a contact: on every scale, and along the surface."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.errors import InputError
from gripscale.figures.palette import BLUE, GREEN, GREY, INK, MILLI, NARROW, ORANGE, SKY, WIDE
from gripscale.figures.style import falling_wavelength, sheet, styled
from gripscale.rough import RoughContact
from gripscale.units import ZERO_CELSIUS

PARTS = {
    "warming_uniform": ("all waves, spread evenly", SKY),
    "warming_larger_waves": ("in the contact of larger waves", BLUE),
    "warming_own": ("the wave's own", ORANGE),
}
"""What warms a wave where it loses energy: name in results, in legends, and colour."""
BAR = 1.25
"""Left end of a bar over its wavelength, and that over its right end."""


def require_warming(data: xr.Dataset) -> None:
    """Raise `InputError` unless a chain's Dataset has temperatures of its waves."""
    if not set(PARTS) <= set(data.data_vars) or "scale" not in data.dims:
        raise InputError("data must be of a chain solved with heat; got one without temperatures")


@styled
def heat_figure(data: xr.Dataset, title: str = "") -> Figure:
    """Draw by how much each wave of a chain is warmer than the rubber before the contact.

    Bars are the temperature where the wave loses its energy, in the parts that add to it, those
    that cool it below zero: heat that comes up from the depth when the contact has passed. Dots are
    at the surface, in the contact of the wave. Waves without solution are left out.

    Parameters
    ----------
    data : xarray.Dataset
        Of `Prediction.to_dataset`, with heat.
    title : str
        Above the panel.

    Raises
    ------
    InputError
        If there are no temperatures in it.
    """
    require_warming(data)
    data = data.isel(scale=np.isfinite(data.warming_own.values))
    figure, panels = sheet(NARROW, 3.4)
    axes = panels[0, 0]
    length = data.wavelength.values / MILLI
    above, below = np.zeros(length.size), np.zeros(length.size)
    for name, (label, colour) in PARTS.items():
        part = data[name].values
        axes.bar(
            length / BAR,
            part,
            length * (BAR - 1.0 / BAR),
            bottom=np.where(part > 0.0, above, below),
            align="edge",
            color=colour,
            label=label,
        )
        above, below = above + np.maximum(part, 0.0), below + np.minimum(part, 0.0)
    before = _before(data)
    look: dict[str, Any] = {"marker": "o", "ms": 4.0, "mfc": "white", "mec": INK, "ls": ""}
    axes.plot(length, data.contact_temperature - before, label="at the surface, in contact", **look)
    falling_wavelength(axes, length)
    axes.axhline(0.0, color=INK, lw=0.7)
    axes.use_sticky_edges = False  # of bars upon bars, which would leave none above the topmost
    axes.margins(y=0.08)
    axes.set_ylabel(f"above the {before - ZERO_CELSIUS:.3g} °C before the contact [K]")
    figure.legend(loc="outside upper center", ncols=2, title=title)
    return figure


def _before(data: xr.Dataset) -> float:
    """Return the temperature before the contact [K], NaN without waves.

    Stated, or else the least that is left of any wave's without what warms it: of the temperature a
    wave was solved at and the warming it found, which agree to some tenths of a kelvin.
    """
    stated = (json.loads(data.attrs.get("conditions", "null")) or {}).get("temperature")
    if stated is not None:
        return float(stated)
    left = data.temperature - sum(data[name] for name in PARTS)
    return float(left.mean()) if left.size else math.nan


@styled
def direct_heat_figure(contact: RoughContact, title: str = "") -> Figure:
    """Draw by how much the rubber is warmer than before a direct contact.

    On one side where the octaves of wavelengths lose their energy; on the other at the surface, of
    a line with its contact marked below.

    Parameters
    ----------
    contact : RoughContact
        Solved with heat, sliding.
    title : str
        Above the panels.

    Raises
    ------
    InputError
        If it has no temperatures.
    """
    if contact.surface_warming is None or contact.scales is None:
        raise InputError("contact must be solved with heat and slide; got one without temperatures")
    figure, panels = sheet(WIDE, 3.2, 1, 2, gap=0.06, width_ratios=[1.0, 1.5])
    octaves, surface = panels[0]
    length = 2.0 * math.pi / contact.scales.wavenumber / MILLI
    octaves.plot(length, contact.scales.warming, "o-", color=ORANGE)
    falling_wavelength(octaves, length)
    octaves.set_ylim(0.0, 1.1 * float(contact.scales.warming.max()))
    octaves.set_ylabel("warming where the octave loses energy [K]")
    if contact.height.ndim == 1:
        _along(surface, contact, contact.surface_warming)
    else:
        _map(figure, surface, contact, contact.surface_warming)
    if title:
        figure.suptitle(title, fontsize=9.0)
    return figure


def _along(axes: Axes, contact: RoughContact, warming: Any) -> None:
    """Draw the surface temperature along a line, and where it touches."""
    x, top = contact.x / MILLI, float(np.max(warming))
    axes.plot(x, warming, color=ORANGE, lw=0.9, rasterized=True)
    level = float(np.average(warming, weights=contact.pressure))
    axes.axhline(level, color=GREY, lw=0.8, ls="-.", label="mean in the contact, by pressure")
    touching = np.where(contact.active, -0.06 * top, np.nan)
    axes.plot(x, touching, color=GREEN, lw=4.0, solid_capstyle="butt", label="contact")
    axes.set_ylim(-0.12 * top, 1.25 * top)
    axes.margins(x=0.0)
    axes.set_xlabel("along the way of sliding $x$ [mm]")
    axes.set_ylabel("warming of the surface [K]")
    axes.legend(loc="upper right", ncols=2)


def _map(figure: Figure, axes: Axes, contact: RoughContact, warming: Any) -> None:
    shown = axes.pcolormesh(
        contact.x / MILLI, contact.y / MILLI, np.asarray(warming).T, cmap="inferno", rasterized=True
    )
    axes.set_aspect("equal")
    axes.grid(visible=False)
    axes.set_xlabel("along the way of sliding $x$ [mm]")
    axes.set_ylabel("$y$ [mm]")
    bar = figure.colorbar(shown, ax=axes, label="warming of the surface [K]")
    bar.outline.set_linewidth(0.0)
