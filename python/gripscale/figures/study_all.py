"""Which figures a study writes."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr

from gripscale.figures.study_axes import pieces
from gripscale.figures.study_decades import decades_figure
from gripscale.figures.study_map import friction_master_figure, map_figure
from gripscale.figures.study_stacked import shares_figure, stacked_figure
from gripscale.figures.study_totals import totals_figure
from gripscale.figures.study_wavelength import wavelength_figure
from gripscale.figures.style import save_figure
from gripscale.study.display import dimensions, numeric
from gripscale.study.temperature import REDUCED_SPEED

MOST_PIECES = 8
"""Values of a second axis up to which each gets figures of its own."""


def draw(result: xr.Dataset, target: Path) -> None:
    """Draw totals, and for each value of the second axis what the waves do along the first."""
    save_figure(totals_figure(result), target, "totals")
    _over_temperature(result, target)
    numbers = numeric(result)
    axis = (numbers or dimensions(result))[0]
    for title, piece in list(pieces(result, axis))[:MOST_PIECES]:
        end = f"_{re.sub(r'[^A-Za-z0-9.]+', '_', title)}" if title else ""
        if "wavelength" not in piece or not (piece.prediction_status == "converged").any():
            continue
        save_figure(wavelength_figure(piece, axis, title), target, f"wavelength{end}")
        if not numbers:
            continue
        save_figure(stacked_figure(piece, axis, title), target, f"stacked{end}")
        save_figure(shares_figure(piece, axis, title), target, f"shares{end}")
        if "friction_by_decade" in piece:
            save_figure(decades_figure(piece, axis, title), target, f"decades{end}")


def _over_temperature(result: xr.Dataset, target: Path) -> None:
    """Draw the map over speed and temperature, and all temperatures over the reduced speed."""
    if REDUCED_SPEED not in result.coords or np.isnan(result.total_friction.values).all():
        return
    save_figure(friction_master_figure(result), target, "friction_master_curve")
    if min(result.sizes["speed"], result.sizes["temperature"]) > 1:
        save_figure(map_figure(result), target, "map")
