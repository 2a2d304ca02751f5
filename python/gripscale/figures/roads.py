"""Roads side by side: correlations and spectra, and which waves make their friction."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from gripscale.figures.palette import COLOURS, MILLI, SQUARE_MM, WIDE
from gripscale.figures.style import falling_wavelength, log_axis, sheet, styled

CUBIC_MM = 1e-9
LEAST = 0.02
"""Share of the largest friction of an octave from which one is drawn."""


@styled
def roads_statistics_figure(data: xr.Dataset) -> Figure:
    """Draw C_z [mm^2] over lag and the spectrum of lines [mm^3] over wavenumber of each road.

    `data` is that of `gripscale.roads.Roads`.
    """
    figure, panels = sheet(WIDE, 3.2, 1, 2, gap=0.06)
    correlation, spectrum = panels[0]
    for name, colour in zip(data.surface.values.tolist(), COLOURS, strict=False):
        one = data.sel(surface=name)
        if "correlation" in one:
            value = one.correlation.values / SQUARE_MM
            correlation.plot(one.lag.values / MILLI, value, color=colour, label=name)
        if "spectrum" in one:
            per_mm = one.wavenumber.values * MILLI
            spectrum.plot(per_mm, one.spectrum.values / CUBIC_MM, color=colour)
    for axes in panels[0]:
        log_axis(axes, "x")
        log_axis(axes, "y")
    correlation.set_xlabel("lag $l$ [mm]")
    correlation.set_ylabel("height difference $C_z$ [mm$^2$]")
    spectrum.set_xlabel("wavenumber $q$ [rad/mm]")
    spectrum.set_ylabel("spectrum $C_1$ [mm$^3$]")
    figure.legend(*correlation.get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


@styled
def roads_friction_figure(data: xr.Dataset) -> Figure:
    """Draw the friction of all longer waves over wavelength, a panel for each model.

    Bars at the end are what other stretches of the road might give, in 90 % of the samples.
    """
    models = [m for m in data.model.values if np.isfinite(data.friction_running.sel(model=m)).any()]
    figure, panels = sheet(WIDE, 3.2, 1, max(1, len(models)), gap=0.06, sharey=True)
    data = data.isel(octave=_telling(data))
    wavelength = data.octave.values / MILLI
    for axes, model in zip(panels[0], models, strict=False):
        for at, name in enumerate(data.surface.values.tolist()):
            one, colour = data.sel(model=model, surface=name), COLOURS[at]
            axes.plot(wavelength, one.friction_running, "o-", ms=3.0, color=colour, label=name)
            if "total_friction_low" in one:
                ends = [float(one.total_friction_low), float(one.total_friction_high)]
                place = wavelength[-1] / 1.12 ** (1 + at)
                axes.plot([place] * 2, ends, color=colour, lw=3.0, alpha=0.35)
        falling_wavelength(axes, [*wavelength, wavelength[-1] / 1.12 ** data.sizes["surface"]])
        axes.set_title(str(model), loc="left")
    panels[0, 0].set_ylabel("$\\mu$ of this and longer waves [-]")
    panels[0, 0].set_ylim(bottom=0.0)
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def _telling(data: xr.Dataset) -> slice:
    """Return the octaves from the first to the last in which something is lost."""
    running = np.nan_to_num(data.friction_running.values.reshape(-1, data.sizes["octave"]))
    lost = np.abs(np.diff(running, axis=1, prepend=0.0)).max(axis=0)
    there = np.flatnonzero(lost > LEAST * lost.max())
    return slice(max(there[0] - 1, 0), there[-1] + 1) if there.size else slice(None)
