"""Compounds side by side: their moduli, and which waves and relaxation times tell them apart."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.case.record import band
from gripscale.charts.style import (
    COLOURS,
    GREY,
    NARROW,
    WIDE,
    dashed_entry,
    falling_wavelength,
    line,
    log_axis,
    power_of_ten,
    sheet,
    styled,
)
from gripscale.core.units import MEGA, MILLI, SQUARE_MM
from gripscale.rubber import Rubber

LEAST_MODULUS_SHARE = 0.005
"""Of the largest difference: decades at either end with less are not drawn."""


@styled
def compound_moduli_figure(rubbers: Mapping[str, Rubber]) -> Figure:
    """Draw E' [MPa] and the loss factor of compounds, dashed beyond what was measured.

    The shade is what the measured moduli leave open of E'.
    """
    figure, panels = sheet(NARROW, 4.9, 2, 1, sharex=True)
    storage, loss = panels[:, 0]
    for (name, rubber), colour in zip(rubbers.items(), COLOURS, strict=False):
        omega = band(rubber, None, (), 300)
        modulus, beyond = rubber.complex_modulus(omega), rubber.outside_band(omega)
        if rubber.admissible is not None:
            low, high = rubber.complex_modulus_band(omega)
            shade = {"color": colour, "alpha": 0.15, "lw": 0.0}
            storage.fill_between(omega, low.real / MEGA, high.real / MEGA, **shade)
        line(storage, omega, modulus.real / MEGA, beyond, name, color=colour)
        line(loss, omega, modulus.imag / modulus.real, beyond, color=colour)
    log_axis(loss, "x")
    log_axis(storage, "y")
    storage.set_ylabel("storage modulus $E'$ [MPa]")
    loss.set_ylabel("loss factor [-]")
    loss.set_xlabel("angular frequency $\\omega$ [rad/s]")
    loss.set_ylim(bottom=0.0)
    dashed_entry(storage)
    figure.legend(*storage.get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


@styled
def compound_friction_figure(data: xr.Dataset) -> Figure:
    """Draw the friction of all waves down to each, and the differences by relaxation time.

    `data` is that of `gripscale.analysis.Compounds`.
    """
    by_decade = "friction_by_decade_difference" in data
    figure, panels = sheet(WIDE, 3.1, 1, 1 + by_decade, gap=0.06)
    running = panels[0, 0]
    for one, colour in zip(data.rubber.values.tolist(), COLOURS, strict=False):
        piece = data.sel(rubber=one)
        wavelength = piece.wavelength.values / MILLI
        running.plot(wavelength, piece.friction_running, "o-", ms=3.0, color=colour, label=one)
        if "total_friction_low" in piece:
            ends = [float(piece.total_friction_low), float(piece.total_friction_high)]
            running.plot([wavelength[-1]] * 2, ends, color=colour, lw=3.0, alpha=0.35)
    falling_wavelength(running, (data.wavelength.values / MILLI).ravel())
    running.set_ylabel("$\\mu$ of this and larger waves [-]")
    running.set_ylim(bottom=0.0)
    if by_decade:
        _decades(panels[0, 1], data)
    figure.legend(*running.get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def _decades(axes: Axes, data: xr.Dataset) -> None:
    """Draw the difference of each compound to the first by decade of relaxation time."""
    names = data.rubber.values.tolist()
    differences = np.abs(np.nan_to_num(data.friction_by_decade_difference.values))
    largest = differences.max(axis=data.friction_by_decade_difference.dims.index("rubber"))
    shown = np.flatnonzero(largest >= LEAST_MODULUS_SHARE * largest.max(initial=0.0))
    data = data.isel(decade=slice(shown[0], shown[-1] + 1)) if shown.size else data
    place = np.arange(data.sizes["decade"])
    width = 0.8 / (len(names) - 1)
    for i, (name, colour) in enumerate(zip(names[1:], COLOURS[1:], strict=False)):
        parts = np.nan_to_num(data.friction_by_decade_difference.sel(rubber=name).values)
        axes.bar(place + (i - 0.5 * (len(names) - 2)) * width, parts, width, color=colour)
    axes.axhline(0.0, color=GREY, lw=0.7)
    step = max(1, math.ceil(len(place) / 8))
    ticks = [power_of_ten(round(math.log10(time))) for time in data.decade.values[::step]]
    axes.set_xticks(place[::step], ticks)
    axes.set_xlabel("relaxation time from [s]")
    axes.set_ylabel(f"$\\mu$ less that of {names[0]} [-]")


# Roads side by side: correlations and spectra, and which waves make their friction.

CUBIC_MM = 1e-9
LEAST_POWER_SHARE = 0.02
"""Share of the largest friction of an octave from which one is drawn."""


@styled
def roads_statistics_figure(data: xr.Dataset) -> Figure:
    """Draw C_z [mm^2] over lag and the spectrum of lines [mm^3] over wavenumber of each road.

    `data` is that of `gripscale.analysis.Roads`.
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
    there = np.flatnonzero(lost > LEAST_POWER_SHARE * lost.max())
    return slice(max(there[0] - 1, 0), there[-1] + 1) if there.size else slice(None)
