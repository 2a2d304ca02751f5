"""What is not known of a case: distributions, what matters most, and bands over a varied load."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.palette import BLUE, COLOURS, GREY, INK, ORANGE, WIDE
from gripscale.figures.style import log_axis, save_figure, sheet, styled
from gripscale.study.display import LABELS
from gripscale.uncertainty.shares import SURE

NAMES = {
    "friction": "friction coefficient $\\mu$ [-]",
    "contact_fraction": "real contact area $A_r/A_0$ [-]",
}
MOST_BINS = 24
SEVERAL = 2
"""Samples there must be for a distribution."""


def draw(data: xr.Dataset, folder: Path) -> None:
    """Draw distributions and what matters most, or bands where a load is varied, into `folder`."""
    axis = next((str(name) for name in data.failed.dims if name != "model"), "")
    if axis:
        save_figure(band_figure(data, axis), folder, f"over_{axis}")
        return
    save_figure(distribution_figure(data), folder, "distributions")
    for name in data.model.values:
        one = data.sel(model=name)
        if np.isfinite(one.friction_share).any():
            save_figure(tornado_figure(one), folder, f"tornado_{name}")


@styled
def distribution_figure(data: xr.Dataset) -> Figure:
    """Draw how friction and contact fraction are distributed, a row for each model.

    Lines are the median and the ends of the 90 % interval, the point is the case itself.
    """
    rows = data.sizes["model"]
    figure, panels = sheet(WIDE, 1.1 + 1.7 * rows, rows, 2, gap=0.06)
    for row, (model, colour) in enumerate(zip(data.model.values, COLOURS, strict=False)):
        one = data.sel(model=model)
        for axes, (name, label) in zip(panels[row], NAMES.items(), strict=True):
            _distribution(axes, one, name, colour)
            axes.set_xlabel(label)
        number = one.sizes["sample"] - int(one.failed)
        panels[row][0].set_ylabel(f"samples (of {number})")
        panels[row][0].set_title(str(model), loc="left")
    handles, labels = panels[0][0].get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


def _distribution(axes: Axes, one: xr.Dataset, name: str, colour: str) -> None:
    values = one[name].values
    known = values[np.isfinite(values)]
    if known.size < SEVERAL:
        return
    counts, *_ = axes.hist(
        known, bins=min(MOST_BINS, 1 + known.size // 6), color=colour, alpha=0.45
    )
    low, middle, high = one[f"{name}_quantile"].values[[0, 2, 4]]
    axes.axvline(middle, color=INK, lw=1.6, label="median")
    axes.axvline(low, color=INK, lw=0.9, ls="--", label="5 and 95 %")
    axes.axvline(high, color=INK, lw=0.9, ls="--")
    top = float(np.max(counts))
    axes.set_ylim(top=1.25 * top)
    case, above = float(one[f"{name}_case"]), 1.12 * top
    axes.plot(case, above, "v", ls="", color=INK, clip_on=False, label="the case itself")


@styled
def tornado_figure(one: xr.Dataset) -> Figure:
    """Draw what each source does to the friction of one model at one load, most on top.

    Bars go from 5 to 95 % of what a source does to friction, the others in their middle. Beside
    them is its share of the variance with its standard error; grey is what so many samples cannot
    tell from nothing.
    """
    ranked = np.argsort(one.friction_share.values, kind="stable")
    shares, errors = one.friction_share.values, one.friction_share_error.values
    figure, panels = sheet(WIDE, 1.0 + 0.34 * len(ranked), 1, 2, gap=0.03, sharey=True)
    bars, dots = panels[0]
    middle = float(np.exp(np.nanmean(np.log(one.friction.values))))
    for place, k in enumerate(ranked):
        low, high = one.friction_end.values[k]
        seen = shares[k] > SURE * errors[k]
        for end, colour in ((low, BLUE), (high, ORANGE)):
            bars.barh(place, end - middle, left=middle, height=0.6, color=colour if seen else GREY)
        dots.errorbar(
            shares[k], place, xerr=errors[k], fmt="o", color=INK if seen else GREY, ms=4.0, lw=1.0
        )
    bars.axvline(middle, color=INK, lw=0.8)
    bars.set_yticks(np.arange(len(ranked)), [str(one.label.values[k]) for k in ranked])
    bars.set_xlabel(NAMES["friction"])
    bars.set_title(f"{one.model.item()}: 5 to 95 % of what each does alone", loc="left")
    dots.axvline(0.0, color=INK, lw=0.8)
    dots.set_xlabel("share of the variance of $\\ln\\mu$ [-]")
    return figure


@styled
def band_figure(data: xr.Dataset, axis: str) -> Figure:
    """Draw medians over what is varied, with bands of 50 and 90 % of the samples."""
    shown = LABELS[axis]
    figure, panels = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    x = shown.of(data[axis].values)
    for model, colour in zip(data.model.values, COLOURS, strict=False):
        one = data.sel(model=model).transpose(axis, ...)
        for axes, (name, text) in zip(panels[0], NAMES.items(), strict=True):
            q = one[f"{name}_quantile"].values
            axes.fill_between(x, q[:, 0], q[:, 4], color=colour, alpha=0.18, lw=0.0)
            axes.fill_between(x, q[:, 1], q[:, 3], color=colour, alpha=0.3, lw=0.0)
            axes.plot(x, q[:, 2], color=colour, label=f"{model}: median, 50 and 90 %")
            axes.plot(x, one[f"{name}_case"], "o", color=colour, mfc="white", ms=3.5)
            axes.set_ylabel(text)
            axes.set_xlabel(shown.label)
            if (x > 0.0).all() and len(x) > 1:
                log_axis(axes, "x")
    panels[0][0].set_ylim(bottom=0.0)
    panels[0][1].set_ylim(bottom=0.0)
    panels[0][0].plot([], [], "o", color=INK, mfc="white", ms=3.5, label="the case itself")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure
