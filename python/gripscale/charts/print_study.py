"""Which figures a study writes."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, MaxNLocator
from numpy.typing import NDArray

from gripscale.charts.style import (
    BEYOND,
    BEYOND_BESIDE,
    BLUE,
    COLOURS,
    DOTTED,
    GREY,
    INK,
    NARROW,
    WIDE,
    Flags,
    area_axis,
    dashed_entry,
    down_to,
    falling_wavelength,
    line,
    log_axis,
    power_of_ten,
    predictions_beyond,
    save_figure,
    sheet,
    short_number,
    stretches,
    styled,
    waves_beyond,
)
from gripscale.core.units import MILLI
from gripscale.experiment.axis import (
    WORDS,
    axis_label,
    axis_shown,
    dimensions,
    name_of,
    numeric,
    of_numbers,
)
from gripscale.experiment.speed_and_temperature import BEYOND_SHIFT, REDUCED_SPEED

# What the figures of a study share: axes, colours, pieces, the legend at the side.

Array = NDArray[np.float64]


def along(axes: Axes, result: xr.Dataset, name: str) -> Array:
    """Label `axes` below with a varied axis and return its values as they are drawn."""
    values = axis_shown(result, name).of(result[name].values)
    axes.set_xlabel(axis_label(result, name))
    if values.min() > 0.0 and values.max() > 20.0 * values.min():
        log_axis(axes, "x")
    axes.set_xlim(values.min(), values.max())
    return values


def pieces(result: xr.Dataset, keep: str) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield name and Dataset over `keep` alone, for each value of the other axis."""
    others = [name for name in dimensions(result) if name != keep]
    if not others:
        yield "", result
        return
    for i in range(result.sizes[others[0]]):
        yield name_of(result, others[0], i), result.isel({others[0]: i})


def colours(count: int, *, ordered: bool) -> Sequence[str]:
    """Return as many colours: of the palette, or along a scale where there is an order."""
    if not ordered and count <= len(COLOURS):
        return COLOURS[:count]
    shades = mpl.colormaps["viridis"](np.linspace(0.0, 0.9, count))
    return [mpl.colors.to_hex(shade) for shade in shades]


def wavelength_names(result: xr.Dataset) -> list[str]:
    """Return the wavelengths of a study over one axis, for a legend; ranges where they vary."""
    names = []
    for i in range(result.sizes["scale"]):
        values = result.wavelength.isel(scale=i).values / MILLI
        values = values[np.isfinite(values)]
        low, high = (values.min(), values.max()) if values.size else (math.nan, math.nan)
        same = high <= low * 1.01
        names.append(f"{high:.3g} mm" if same else f"{low:.3g} to {high:.3g} mm")
    return names


def legend_beside(
    figure: Figure, handles: Sequence[Any], labels: Sequence[str], title: str | None = None
) -> None:
    """Put a legend to the right of all panels."""
    place: Any = "outside right center"
    figure.legend(handles, labels, loc=place, title=title, alignment="left")


# Real contact area and friction of all waves over what a study varied.


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


# Which wave makes the grip: contributions of the waves to friction and area, stacked.

HEIGHT = 3.4
HATCHED: Any = {"facecolor": "none", "edgecolor": "white", "hatch": "////", "lw": 0.0}
"""Look of waves beyond the measured band."""


@styled
def stacked_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw friction as the sum, and contact area as the product, of its waves over one axis.

    Each band of friction is the friction coefficient of a wave; each band of area is the part of
    the contact a wave takes away, the lowest line what is left after all of them. Waves beyond the
    measured band of the rubber are hatched.
    """
    figure, panels = sheet(WIDE, HEIGHT, 1, 2, gap=0.06)
    friction, area = panels[0]
    shades, names = _shades(result)
    values = result.friction.transpose("scale", axis).values
    x, beyond = along(friction, result, axis), _beyond(result, axis)
    _stack(friction, x, values, shades, beyond)
    line(friction, x, result.total_friction, predictions_beyond(result), color=INK, lw=1.2)
    friction.set_ylabel("friction coefficient $\\mu$, wave upon wave [-]")
    running = result.running_contact_fraction.transpose("scale", axis).values
    _nested(area, along(area, result, axis), running, shades, beyond)
    area.set_ylabel("relative contact area after each wave [-]")
    _legend(figure, shades, names, title, hatched=bool(beyond.any()))
    return figure


@styled
def shares_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw the share of each wave in the friction over one axis, and its friction alone.

    Waves beyond the measured band of the rubber are hatched, and dashed.
    """
    figure, panels = sheet(WIDE, HEIGHT, 1, 2, gap=0.06)
    share, alone = panels[0]
    shades, names = _shades(result)
    values = result.friction.transpose("scale", axis).values
    total = result.total_friction.values
    beyond = _beyond(result, axis)
    _stack(share, along(share, result, axis), values / total, shades, beyond)
    share.set_ylim(0.0, 1.0)
    share.set_ylabel("share of each wave in $\\mu$ [-]")
    x = along(alone, result, axis)
    for row, colour, flags in zip(values, shades, beyond, strict=True):
        line(alone, x, row, flags, color=colour)
    alone.set_ylim(bottom=0.0)
    alone.set_ylabel("friction coefficient of each wave $\\mu_i$ [-]")
    _legend(figure, shades, names, title, hatched=bool(beyond.any()))
    return figure


def _shades(result: xr.Dataset) -> tuple[list[str], list[str]]:
    return list(colours(result.sizes["scale"], ordered=True)), wavelength_names(result)


def _beyond(result: xr.Dataset, axis: str) -> Flags:
    """Return for each wave and point whether it excites the rubber beyond the measured band."""
    return waves_beyond(result.transpose("scale", axis, ...))


def _stack(axes: Axes, x: Array, rows: Array, shades: list[str], beyond: Flags) -> None:
    """Fill the band of each row upon the rows before it, hatched beyond; NaN leaves a gap."""
    upper = np.cumsum(np.where(np.isnan(rows), 0.0, rows), axis=0)
    upper[:, np.isnan(rows).all(axis=0)] = np.nan
    lower = np.vstack([np.zeros_like(x), upper[:-1]])
    for low, high, colour in zip(lower, upper, shades, strict=True):
        axes.fill_between(x, low, high, color=colour, lw=0.3, ec="white")
    for low, high, flags in zip(lower, upper, beyond, strict=True):
        _hatch(axes, x, low, high, flags)
    axes.set_ylim(bottom=0.0)


def _hatch(axes: Axes, x: Array, low: Array, high: Array, beyond: Flags) -> None:
    """Hatch a band where it is beyond the measured frequencies."""
    for part, hatched in stretches(beyond):
        if hatched:
            axes.fill_between(x[part], low[part], high[part], **HATCHED)


def _nested(axes: Axes, x: Array, running: Array, shades: list[str], beyond: Flags) -> None:
    """Fill between the running areas, largest wave first, on a log axis; hatched beyond."""
    upper = np.ones_like(x)
    for row, colour, flags in zip(running, shades, beyond, strict=True):
        axes.fill_between(x, row, upper, color=colour, lw=0.3, ec="white")
        _hatch(axes, x, row, upper, flags)
        upper = np.where(np.isnan(row), upper, row)
    line(axes, x, upper, np.any(beyond, axis=0), color=INK, lw=1.2)
    axes.set_ylim(0.7 * float(np.nanmin(running)), 1.0)
    area_axis(axes)


def _legend(
    figure: Figure, shades: list[str], names: list[str], title: str, *, hatched: bool
) -> None:
    """Name the waves beside the panels, last on top as they are stacked."""
    patches = [Patch(color=colour) for colour in shades]
    if hatched:
        entry = Patch(**(HATCHED | {"facecolor": GREY}))
        patches, names = [entry, *patches], [BEYOND_BESIDE, *names]
    legend_beside(figure, patches[::-1], names[::-1], "wavelength")
    if title:
        figure.suptitle(title, fontsize=9.0)


# Friction and contact area over speed and temperature, as maps and as one curve over a_T v.

PANELS = {
    "total_friction": "friction coefficient $\\mu$ [-]",
    "total_contact_fraction": "real contact area $A_r/A_0$ [-]",
}
LEVELS = 9
MOST_DECADES = 7
"""Numbers below the reduced speed, which may go over many powers of ten."""
TEMPERATURES = mpl.colors.ListedColormap(mpl.colormaps["plasma"](np.linspace(0.0, 0.88, 256)))


@styled
def map_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 over the speed, to the right, and the temperature.

    Dots are the predictions; open where some of the friction rests on the rubber beyond its
    measured band, crosses where the temperature lies beyond those the shift rests on. What did not
    converge is left white.
    """
    figure, panels = sheet(WIDE, 3.3, 1, 2, gap=0.06, sharey=True)
    for axes, (name, label) in zip(panels[0], PANELS.items(), strict=True):
        values = result[name].transpose("temperature", "speed").values
        x = along(axes, result, "speed")
        y = axis_shown(result, "temperature").of(result.temperature)
        levels = MaxNLocator(LEVELS).tick_values(np.nanmin(values), np.nanmax(values))
        filled = axes.contourf(x, y, values, levels=levels, cmap="viridis")
        axes.contour(x, y, values, levels=levels, colors="white", linewidths=0.4)
        bar = figure.colorbar(filled, ax=axes, label=label, pad=0.02)
        bar.outline.set_linewidth(0.0)
        bar.ax.yaxis.set_major_formatter(lambda value, _: short_number(value))
        _points(axes, result, x, y)
        axes.grid(visible=False)
    panels[0, 0].set_ylabel(axis_label(result, "temperature"))
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


@styled
def friction_master_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 of all temperatures over the reduced speed a_T v.

    Where temperature does nothing but shift the relaxation times, they are one curve. Dashed is
    what rests on the rubber beyond its measured band.
    """
    figure, panels = sheet(WIDE, 3.3, 1, 2, gap=0.06)
    speeds = axis_shown(result, "speed")
    celsius = axis_shown(result, "temperature").of(result.temperature)
    scale = ScalarMappable(Normalize(celsius.min(), celsius.max()), TEMPERATURES)
    for axes, (name, label) in zip(panels[0], PANELS.items(), strict=True):
        for i, colour in enumerate(scale.to_rgba(celsius)):
            one = result.isel(temperature=i)
            look: dict[str, Any] = {"color": colour, "marker": "o", "ms": 2.6, "lw": 1.0}
            line(axes, speeds.of(one[REDUCED_SPEED]), one[name], predictions_beyond(one), **look)
        log_axis(axes, "x")
        axes.xaxis.set_major_locator(LogLocator(numticks=MOST_DECADES))
        axes.set_xlabel(f"reduced speed $a_T v$ [{speeds.unit}]")
        axes.set_ylabel(label)
        dashed_entry(axes)
    friction, area = panels[0]
    friction.set_ylim(bottom=0.0)
    area_axis(area)
    bar = figure.colorbar(scale, ax=panels[0], label=axis_label(result, "temperature"), pad=0.02)
    bar.outline.set_linewidth(0.0)
    handles, labels = friction.get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside upper center")
    return figure


def _points(axes: Axes, result: xr.Dataset, x: Any, y: Any) -> None:
    """Mark the predictions by what they rest on."""
    beyond = np.asarray(
        result.total_friction.copy(data=predictions_beyond(result)).transpose(
            "temperature", "speed"
        )
    ).astype(bool)
    shifted = result[BEYOND_SHIFT].transpose("temperature", "speed").values.astype(bool)
    solved = np.isfinite(result.total_friction.transpose("temperature", "speed").values)
    shape = np.shape(solved)
    kinds = (
        (~beyond & ~shifted, "solved", {"marker": ".", "color": INK, "ms": 2.5}),
        (
            beyond & ~shifted,
            "beyond the measured band",
            {"marker": "o", "mfc": "none", "mec": INK, "ms": 3.0, "mew": 0.5},
        ),
        (
            shifted,
            "beyond the temperatures of the shift",
            {"marker": "x", "color": GREY, "ms": 3.0, "mew": 0.7},
        ),
    )
    speeds, temperatures = np.broadcast_to(x, shape), np.broadcast_to(np.reshape(y, (-1, 1)), shape)
    for kind, label, look in kinds:
        which = kind & solved
        if which.any():
            places = speeds[which], temperatures[which]
            axes.plot(*places, ls="", clip_on=False, label=label, **look)  # type: ignore[arg-type]


# Which relaxation times of the rubber make the grip, over what a study varied.

LEAST_SHARE = 0.005
"""Decades that never reach this share of the friction are not drawn."""


@styled
def decades_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw the share of each decade of relaxation time in the friction over one axis.

    The split is that of small strain (see
    `gripscale.experiment.speed_and_temperature`), and the figure says so.
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


# Contact area and friction against wavelength over a study (figures 5 to 9 of LW).

MOST_NAMES = 12


@styled
def wavelength_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw running contact area and running friction against wavelength over one axis.

    Dashed is what rests on the rubber beyond its measured band.
    """
    figure, panels = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    area, friction = panels[0]
    ordered = np.issubdtype(result[axis].dtype, np.number)
    shades = colours(result.sizes[axis], ordered=ordered)
    every = -(-len(shades) // MOST_NAMES)
    for i, colour in enumerate(shades):
        one = result.isel({axis: i})
        x = one.wavelength / MILLI
        label = name_of(result, axis, i) if i % every == 0 else None
        beyond = down_to(waves_beyond(one))
        look: dict[str, Any] = {"marker": "o", "ms": 3.0, "color": colour}
        line(area, x, one.running_contact_fraction, beyond, label, **look)
        line(friction, x, one.running_friction, beyond, **look)
    area_axis(area, top=1.15)
    area.set_ylabel("relative contact area, running [-]")
    friction.set_ylabel("friction coefficient, running [-]")
    friction.set_ylim(bottom=0.0)
    wavelengths = result.wavelength.values[np.isfinite(result.wavelength.values)] / MILLI
    for panel in (area, friction):
        falling_wavelength(panel, wavelengths)
    dashed_entry(area, BEYOND_BESIDE)
    legend_beside(figure, *area.get_legend_handles_labels())
    if title:
        figure.suptitle(title, fontsize=9.0)
    return figure


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
