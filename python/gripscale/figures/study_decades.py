"""Which relaxation times of the rubber make the grip, over what a study varied."""

from __future__ import annotations

import math

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from gripscale.figures.palette import INK, NARROW
from gripscale.figures.stretches import BEYOND_BESIDE, predictions_beyond
from gripscale.figures.study_axes import along, legend_beside
from gripscale.figures.style import dashed_entry, line, power_of_ten, sheet, styled

LEAST_SHARE = 0.005
"""Decades that never reach this share of the friction are not drawn."""


@styled
def decades_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw the share of each decade of relaxation time in the friction over one axis.

    The split is that of small strain (see `gripscale.study.decades`), and the figure says so.
    """
    figure, panels = sheet(NARROW, 3.6)
    axes = panels[0, 0]
    share = (result.friction_by_decade / result.total_friction).transpose("decade", axis)
    count = np.nanmax(share.values, axis=1) >= LEAST_SHARE
    share = share.isel(decade=np.flatnonzero(count))
    x = along(axes, result, axis)
    upper = np.zeros_like(x)
    shades = mpl.colormaps["cividis"](np.linspace(0.0, 1.0, max(share.sizes["decade"], 2)))
    for row, time, colour in zip(share.values, share.decade.values, shades, strict=False):
        lower, upper = upper, upper + np.nan_to_num(row)
        label = power_of_ten(round(math.log10(time)))
        axes.fill_between(x, lower, upper, color=colour, lw=0.3, ec="white", label=label)
    line(axes, x, upper, predictions_beyond(result), color=INK, lw=1.2, clip_on=False)
    axes.set_ylim(0.0, 1.0)
    axes.set_ylabel("share in $\\mu$, split as at small strain [-]")
    dashed_entry(axes, BEYOND_BESIDE)
    handles, labels = axes.get_legend_handles_labels()
    legend_beside(figure, handles[::-1], labels[::-1], "relaxation\ntime from [s]")
    if title:
        figure.suptitle(title, fontsize=9.0)
    return figure
