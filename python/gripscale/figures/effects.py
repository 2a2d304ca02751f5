"""What each effect of the conditions is worth: area and friction with and without it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from gripscale.effects.effects import CHANGES, WITH_AREA_TERM
from gripscale.figures.palette import COLOURS, INK, WIDE
from gripscale.figures.style import DOTTED, sheet, styled
from gripscale.study.display import EFFECTS, MODELS

HEIGHT, ROW = 1.5, 0.32
"""Of the figure without rows, and of each [inch]."""
INSIDE = 0.45
"""Of the longest bar; in one longer than that its number stands inside."""
BESIDE = 0.6
"""Of the height of a row that the bars of all models take."""


PANELS = {
    "total_contact_fraction": "real contact area $A_r/A_0$ [-]",
    "total_friction": "friction, hysteresis $\\mu$ [-]",
    WITH_AREA_TERM: "friction with area term [-]",
}
PER_CENT = "at a bar: what the effects left out change"


@styled
def effects_figure(*results: xr.Dataset, title: str = "") -> Figure:
    """Draw A_r/A_0 and friction as bars: with all effects, without each in turn, without any.

    A dotted line goes on from the answer with all effects. At each other bar stands what the
    effects left out change, in per cent of it. Where an area term was asked for, friction with it
    has a panel of its own.

    Parameters
    ----------
    *results : xarray.Dataset
        As `gripscale.effects.effects` returns them, one for each model, one at least; all of the
        same conditions.
    title : str
        Above the panels.
    """
    names = [str(name) for name in results[0].effect.values]
    shown = [name for name in PANELS if any(name in result for result in results)]
    height = HEIGHT + ROW * len(names) * max(len(results), 1.5)
    figure, panels = sheet(WIDE, height, 1, len(shown), gap=0.04, sharey=True)
    for axes, name in zip(panels[0], shown, strict=True):
        drawn = [result[name].values for result in results if name in result]
        longest = float(np.nanmax(np.concatenate(drawn), initial=0.0))
        for k, (result, colour) in enumerate(zip(results, COLOURS, strict=False)):
            place = np.arange(len(names)) + BESIDE * ((k + 0.5) / len(results) - 0.5)
            if name in result:
                look: dict[str, Any] = {"height": 0.9 * BESIDE / len(results), "color": colour}
                axes.barh(place, np.nan_to_num(result[name].values), **look, label=_name(result))
                _say(axes, result, name, place, colour, longest)
        axes.set_xlabel(PANELS[name])
        axes.grid(visible=False, axis="y")
        axes.margins(x=0.3)
        axes.set_xlim(left=0.0)
        axes.xaxis.set_major_locator(MaxNLocator(4))
    first = panels[0, 0]
    first.set_yticks(np.arange(len(names)), [EFFECTS.get(name, name) for name in names])
    first.invert_yaxis()
    handles, labels = first.get_legend_handles_labels()
    above = "\n".join(filter(None, [title, PER_CENT]))
    figure.legend(handles, labels, loc="outside upper center", ncols=len(handles), title=above)
    return figure


def _name(result: xr.Dataset) -> str:
    model = str(result.attrs["model"])
    return MODELS.get(model, model)


def _say(
    axes: Axes, result: xr.Dataset, name: str, place: Any, colour: str, longest: float
) -> None:
    """Write the changes beside the bars, and draw the answer with all effects behind them."""
    values, changes = result[name].values, result[CHANGES[name]].values
    if np.isfinite(values[0]):
        axes.axvline(values[0], color=colour, lw=0.8, ls=DOTTED, zorder=0.9)
    for at, value, change in zip(place, values, changes, strict=True):
        if np.isfinite(value) and not np.isfinite(change):
            continue
        text = f"{100.0 * change:+.0f} %" if np.isfinite(value) else "not converged"
        within = value > INSIDE * longest
        look: dict[str, Any] = {"color": "white", "ha": "right"} if within else {"color": INK}
        if not within:  # a short bar may end just before the line, which then passes behind
            look["bbox"] = {"facecolor": "white", "edgecolor": "none", "pad": 1.0}
        axes.annotate(
            text,
            (float(np.nan_to_num(value)), at),
            (-3.0 if within else 3.0, 0.0),
            textcoords="offset points",
            va="center",
            fontsize=7.0,
            **look,
        )
