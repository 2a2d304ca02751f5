"""Real contact area and friction of all waves over what a study varied."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.palette import BLUE, GREY, INK, WIDE
from gripscale.figures.stretches import BEYOND, predictions_beyond
from gripscale.figures.study_axes import along, colours
from gripscale.figures.style import DOTTED, area_axis, dashed_entry, line, sheet, styled
from gripscale.study.display import WORDS, dimensions, name_of, numeric, of_numbers


@styled
def totals_figure(result: xr.Dataset) -> Figure:
    """Draw A_r/A_0 and friction over the first numeric axis, a line for each value of the other.

    Without a numeric axis they are drawn as points over the names of the first one. Contact at
    rest is dotted where it was solved. Predictions that did not converge leave gaps. What rests on
    the rubber beyond its measured band is dashed, of names has a star.
    """
    figure, panels = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    area, friction = panels[0]
    names = dimensions(result)
    x = (numeric(result) or names)[0]
    other = next((name for name in names if name != x), None)
    count = result.sizes[other] if other else 1
    shades = [BLUE] if other is None else colours(count, ordered=other in numeric(result))
    for i, colour in enumerate(shades):
        piece = result if other is None else result.isel({other: i})
        label = "sliding" if other is None else name_of(result, other, i)
        _line(area, piece, x, "total_contact_fraction", colour, label)
        _line(friction, piece, x, "total_friction", colour, label)
        if "static_total_contact_fraction" in result:
            _rest(area, piece, x, colour, "at rest" if other is None else None)
    if other is not None and "static_total_contact_fraction" in result:
        look: dict[str, Any] = (
            {"ls": "", "marker": "o", "mfc": "white"} if not of_numbers(result, x) else {}
        )
        area.plot([], [], **({"color": INK, "ls": DOTTED, "lw": 0.9} | look), label="at rest")
    if not of_numbers(result, x):
        _name(area, friction, result, x)
    dashed_entry(area)
    area_axis(area)
    area.set_ylabel("real contact area $A_r/A_0$ [-]")
    friction.set_ylabel("friction coefficient $\\mu$ [-]")
    friction.set_ylim(bottom=0.0)
    handles, labels = area.get_legend_handles_labels()
    if len(handles) > 1:
        figure.legend(handles, labels, loc="outside upper center", ncols=4)
    return figure


def _line(axes: Axes, piece: xr.Dataset, x: str, quantity: str, colour: str, label: str) -> None:
    if not of_numbers(piece, x):
        place = np.arange(piece.sizes[x])
        axes.set_xlabel(f"{WORDS[x]} [-]")
        axes.margins(x=0.3)
        axes.plot(place, piece[quantity], "o", color=colour, label=label)
    else:
        look: dict[str, Any] = {"marker": "o", "ms": 3.0, "clip_on": False, "color": colour}
        beyond = predictions_beyond(piece)
        line(axes, along(axes, piece, x), piece[quantity], beyond, label, **look)


def _name(area: Axes, friction: Axes, result: xr.Dataset, x: str) -> None:
    """Put the names of an axis below, a star at those whose friction is partly extrapolated."""
    flags = predictions_beyond(result.transpose(x, ...))
    stars = [bool(np.any(one)) for one in flags]
    names = [f"{name_of(result, x, i)}{' *' if star else ''}" for i, star in enumerate(stars)]
    for axes in (area, friction):
        axes.set_xticks(np.arange(len(names)), names)
    if any(stars):
        area.plot([], [], ls="", marker="$*$", color=GREY, label=BEYOND)


def _rest(axes: Axes, piece: xr.Dataset, x: str, colour: str, label: str | None) -> None:
    """Draw contact at rest, which has no speed, as a dotted level or over the same axis."""
    rest = piece.static_total_contact_fraction
    style: dict[str, Any] = {
        "color": colour if label is None else INK,
        "ls": DOTTED,
        "lw": 1.1,
    }
    if x not in rest.dims:
        axes.axhline(float(rest), label=label, **style)
    elif x in WORDS:
        axes.plot(np.arange(rest.size), rest, "o", mfc="white", color=colour, label=label)
    else:
        axes.plot(along(axes, piece, x), rest, label=label, **style)
