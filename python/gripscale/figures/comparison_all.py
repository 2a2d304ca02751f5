"""Which figures a comparison writes."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from gripscale.figures.comparison import comparison_figure
from gripscale.figures.comparison_axis import comparison_axis_figure
from gripscale.figures.comparison_wavelength import comparison_wavelength_figure
from gripscale.figures.rungs import on_the_surface, varied, worth_drawing
from gripscale.figures.style import save_figure


def draw(comparison: xr.Dataset, folder: Path) -> None:
    """Draw a comparison into `folder`: its ladder and wavelengths, or all of it over its axis."""
    axis = varied(comparison)
    if axis:
        save_figure(comparison_axis_figure(comparison), folder, f"over_{axis}")
        return
    save_figure(comparison_figure(comparison), folder, "comparison")
    if worth_drawing(on_the_surface(comparison)).any():
        save_figure(comparison_wavelength_figure(comparison), folder, "by_wavelength")
