"""Charts of a direct contact: the rubber on the road, its pressure, and where it makes friction.

All are drawn from a trace (`gripscale.half_space.location.contact_trace`), which a result keeps.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from gripscale.charts import chart, draw
from gripscale.charts.draw import Chart
from gripscale.charts.style import BLUE, FAINT, GREEN, GREY, INK, ORANGE, SKY, WIDE
from gripscale.core.units import MEGA, MICRO, MILLI
from gripscale.half_space.location import contact_trace, traces_of
from gripscale.half_space.result import RoughContact
from gripscale.io.table import percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_DRAWN = 2  # profiles of a result that are drawn, of each of which a page holds 1.6 MB
# Length of the drawn stretch over that of its contact: as long as the stretch with most friction
# allows, and the least; and its least share of that stretch.
_AROUND, LEAST_AROUND, _LEAST_SHARE = 8.0, 1.2, 0.125
# Height of the largest pressure drawn upon the rubber, over the heights of the stretch.
DRAPED = 0.3
# Least height of the stretch to scale and what it shows below its contact, over its length.
FLATTEST, LOWEST = 0.15, 0.2
NamedTrace = tuple[str, xr.Dataset]  # name of a profile and its trace
PAGE = 420  # width of half a page [px]
# Heights of a frame over the whole line, of the field of a map, of the numbers below a frame, and
# of the legend [inch].
_ROW, FIELD_ROW, _BELOW, _HEAD = 1.15, 2.9, 0.32, 1.1
# Width of a frame over that of the figure, at most: a panel to scale is as wide as the others.
_INSIDE = 0.94
# Variables of a trace that are lengths.
_LENGTHS = (
    *("x", "height_low", "height_high", "rubber_low", "rubber_high"),
    *("stretch_start", "stretch_end", "section", "field_x", "field_y"),
)


def rough_contact_figure(contact: RoughContact, *, stretch: float | None = None) -> Figure:
    """Draw a direct contact: rubber on the surface, pressure, friction, a stretch to scale.

    Raises `InputError` if the stretch is not positive.

    Parameters
    ----------
    contact : RoughContact
        Of a line; of a map, the pressure field and its section with the strongest stretch.
    stretch : float, optional
        Length of the stretch that is drawn to scale [m], around the contact of the one of this
        length with most friction. By default that is sought with 4 mm, see
        `gripscale.half_space.contact_trace`, and drawn as short as its contact allows.
    """
    return trace_sheet(contact_trace(contact, stretch=stretch), length=stretch).on_paper()


def named_traces(data: xr.Dataset, inputs: xr.Dataset | None = None) -> list[NamedTrace]:
    """Return the first few traces of a result with the names of the profiles of its inputs.

    Profiles are numbered where their names do not tell them apart.
    """
    traces, names = traces_of(data), list[str]()
    if inputs is not None and "profile_name" in inputs:
        names = [str(name) for name in inputs["profile_name"].values if name]
    if len({_word(name) for name in names}) != len(traces):
        names = [f"profile {number}" for number in range(1, len(traces) + 1)]
    pairs = zip(names[:MOST_DRAWN], traces, strict=False)
    return [("map" if "section" in trace else name, trace) for name, trace in pairs]


def trace_sheet(trace: xr.Dataset, title: str = "", length: float | None = None) -> draw.Sheet:
    """Describe a trace on paper, its stretch of a length [m] or as short as the contact allows."""
    line = _around_contact(trace, length)
    fields, lines, close = _field_panels(line), _line_panels(line), _stretch_panel(line)
    heights = [FIELD_ROW] * len(fields) + [_ROW] * len(lines)
    return _sheet([*fields, *lines, close], heights, title)


def trace_charts(trace: xr.Dataset, name: str) -> list[Chart]:
    """Return a trace on the page: a stretch to scale, and along the whole line, to be zoomed."""
    from gripscale.charts.page import draw_linked  # of Bokeh, which only pages need

    line = _around_contact(trace)
    lines = draw_linked(
        _line_panels(line),
        f"contact-{_word(name)}",
        f"{name}: rubber on the surface, contact pressure, and friction and load from the "
        "beginning of the line. The shade is the stretch to scale. Draw a box to zoom; "
        "the tools above move the line and zoom by the wheel.",
        f"Heights of surface and rubber, pressure, and running friction along {name}.",
    )
    return [*draw.panels_on_page([_stretch_panel(line, name), *_field_panels(line, name)]), lines]


def height_panels(trace: xr.Dataset, name: str) -> list[chart.Panel]:
    """Return the stretch with most friction, and what its heights are worth for the friction."""
    line = _around_contact(trace)
    part, label = _stretch(line), "change of $\\mu$ by the height"
    worth = 100.0 * part.by_height.values * MICRO * MILLI
    curve = chart.Series(part.x.values, worth, GREEN, label, width=0.9)
    return [
        _stretch_panel(line, name),
        chart.Panel(
            _along(part),
            chart.PlotAxis("friction by height\n[% / (µm mm)]"),
            [curve, chart.CrossLine(0.0)],
            name=f"height-{_word(name)}",
            caption=f"{name}: per cent of its friction for a micrometre of height on a millimetre "
            "of the surface. Heights out of contact have no effect.",
            alt=f"Derivative of the friction by the height of {name}, over one stretch.",
            height=300,
        ),
    ]


def height_figure(trace: xr.Dataset, name: str) -> Figure:
    """Draw what heights are worth for the friction, on the stretch with most, and the stretch."""
    close, worth = height_panels(trace, name)
    sheet = _sheet([worth, close], [_ROW], name)
    return replace(sheet, layout={**sheet.layout, "sharex": True}).on_paper()


def _sheet(panels: list[chart.Panel], heights: list[float], title: str) -> draw.Sheet:
    """Return panels of these heights [inch] below each other, the last one to scale."""
    x, y = panels[-1].x, panels[-1].y
    start, end, low, high = (float(end or 0.0) for end in (x.low, x.high, y.low, y.high))
    heights = [*heights, _INSIDE * WIDE * (high - low) / (end - start)]
    height = sum(heights) + _BELOW * len(panels) + _HEAD
    look: dict[str, Any] = {"legend_columns": 4, "legend_title": title}
    return draw.Sheet(panels, 1, WIDE, height, layout={"height_ratios": heights}, **look)


def _word(name: str) -> str:
    return re.sub(r"\W+", "-", name)


def _along(trace: xr.Dataset) -> chart.PlotAxis:
    low, high = (float(trace.x[at]) for at in (0, -1))
    return chart.PlotAxis(f"distance $x$ [{trace.unit}]", low=low, high=high)


def _around_contact(trace: xr.Dataset, length: float | None = None) -> xr.Dataset:
    """Return a trace whose stretch has its contact in the middle, and its shares there.

    It ends before pieces of several points that are in contact: their contact is longer than it is.
    Lengths are in the `unit` of its attributes: in mm, or of very small surfaces in µm.
    """
    x, inside = trace.x.values, trace.pressure_high.values > 0.0
    start, end = (float(trace[f"stretch_{end}"]) for end in ("start", "end"))
    contact = x[inside & (x >= start) & (x <= end)]
    first, last = contact[[0, -1]] if contact.size else (start, end)
    if length is None:
        extent, most = last - first, end - start
        length = max(min(_AROUND * extent, most), LEAST_AROUND * extent, _LEAST_SHARE * most)
    coarse = x[inside & (np.gradient(x) > 1.01 * np.diff(x).min())]
    lowest = x[np.searchsorted(x, coarse[coarse < first].max(initial=x[0]), "right")]
    highest = x[np.searchsorted(x, coarse[coarse > last].min(initial=x[-1])) - 1]
    half = 0.5 * min(length, highest - lowest)
    middle = np.clip(0.5 * (first + last), lowest + half, highest - half)
    drawn = {"stretch_start": middle - half, "stretch_end": middle + half}
    before, after = np.searchsorted(x, [middle - half, middle + half])
    for name in ("friction", "load"):
        running = np.insert(trace[f"running_{name}"].values, 0, 0.0)
        drawn[f"stretch_{name}"] = running[after] - running[before]
    trace = trace.assign(drawn)
    size, unit = (MILLI, "mm") if np.ptp(x) > MILLI else (MICRO, "µm")
    lengths = {name: trace[name].astype(float) / size for name in _LENGTHS if name in trace}
    return trace.assign(lengths).assign_attrs(unit=unit)


def _stretch(trace: xr.Dataset) -> xr.Dataset:
    inside = (trace.x >= trace.stretch_start) & (trace.x <= trace.stretch_end)
    return trace.isel(piece=np.flatnonzero(inside.values))


def _line_panels(trace: xr.Dataset) -> list[chart.Panel]:
    """Return heights, pressure, and running friction and load along the whole line."""
    x, inside, along = trace.x.values, trace.pressure_high.values > 0.0, _along(trace)
    start, end = float(trace.stretch_start), float(trace.stretch_end)
    shade = chart.CrossLine(start, SKY, "", upright=True, to=end)

    def outline(name: str, colour: str, label: str = "", width: float = 0.8) -> chart.Outline:
        low, high = (trace[f"{name}_{end}"].values for end in ("low", "high"))
        return chart.Outline(x, low, high, colour, label, width)

    surface, pressure = outline("height", INK, "surface", 0.6), outline("pressure", ORANGE)
    low, high = (np.where(inside, end, np.nan) for end in (surface.low, surface.high))
    contact = chart.Outline(x, low, high, ORANGE, "contact", 2.2)
    low, high = (np.asarray(end) / MEGA for end in (pressure.low, pressure.high))
    running = [
        chart.Outline(x, values, values, colour, name, 1.2)
        for name, colour in (("load", GREY), ("friction", GREEN))
        if np.isfinite(values := trace[f"running_{name}"].values).any()
    ]
    heights: list[chart.Mark] = [shade, surface, outline("rubber", BLUE, "rubber", 0.9), contact]
    unnamed, height = replace(along, label=""), chart.PlotAxis(f"height $z$ [{trace.unit}]")
    force = chart.PlotAxis("pressure $p$ [MPa]", low=0.0)
    share = chart.PlotAxis("running share [-]", low=0.0)
    return [
        chart.Panel(unnamed, height, heights, height=250),
        chart.Panel(unnamed, force, [shade, replace(pressure, low=low, high=high)], height=190),
        chart.Panel(along, share, [shade, *running], height=190),
    ]


def _stretch_panel(trace: xr.Dataset, name: str = "") -> chart.Panel:
    """Return the stretch with most friction to scale, the pressure drawn upon the rubber."""
    part = _stretch(trace)
    x, surface, rubber = (part[name].values for name in ("x", "height_low", "rubber_low"))
    pressure = part.pressure_high.values / MEGA
    length, highest = x[-1] - x[0], float(rubber.max())
    contact = np.where(pressure > 0.0, part.height_high.values, np.nan)
    # of a pit beside the contact only the edge
    lowest = max(float(surface.min()), float(np.nanmin(contact)) - LOWEST * length)
    lowest = min(lowest, highest - FLATTEST * length)
    room = DRAPED * (highest - lowest)
    top = highest + 1.1 * room
    highest_pressure = float(pressure.max())
    scale, mark = _round_down(room / highest_pressure), _round_down(highest_pressure)
    text = f"pressure, {mark:g} MPa is {scale * mark:.2g} {trace.unit} high"
    makes = "a stretch"
    if "section" in trace and np.isfinite(part.stretch_friction):
        makes = "the stretch of a line with most friction"
    elif np.isfinite(part.stretch_friction):
        shares = (percent(float(part[f"stretch_{what}"])) for what in ("friction", "load"))
        makes = "the stretch with most friction, {} of it under {} of the load".format(*shares)
    floor = np.full(x.size, lowest)
    return chart.Panel(
        _along(part),
        chart.PlotAxis(f"height $z$ [{trace.unit}]", low=lowest, high=top),
        [
            chart.ShadedBand(x, floor, np.maximum(surface, lowest), FAINT, alpha=1.0),
            chart.ShadedBand(x, rubber, np.full(x.size, top), SKY, alpha=0.25),
            chart.ShadedBand(x, rubber, rubber + scale * pressure, ORANGE, text, alpha=0.8),
            chart.Series(x, np.where(surface < lowest, np.nan, surface), INK, "surface", width=0.8),
            chart.Series(x, rubber, BLUE, "rubber", width=0.9),
            chart.Series(x, contact, ORANGE, "contact", width=2.2),
            chart.Note(0.02, 0.95, "rubber slides $\\rightarrow$", frame="xy", top=True),
        ],
        title=f"To scale: {makes}",
        name=f"stretch-{_word(name)}",
        caption=f"{name}, to scale: {makes}. The pressure is drawn above the rubber.",
        alt=f"Rubber on the surface and contact pressure over one stretch of {name}.",
        height=int(min(max(PAGE * (top - lowest) / length, 200), 480)) + 150,
        to_scale=True,
    )


def _round_down(value: float) -> float:
    """Return the next smaller of 1, 2, 5 times a power of ten."""
    power = 10.0 ** np.floor(np.log10(value))
    steps = (step for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-9))
    return float(power * max(steps))


def _field_panels(trace: xr.Dataset, name: str = "") -> list[chart.Panel]:
    """Return the pressure of a map with its section; nothing of a line."""
    if "field_pressure" not in trace:
        return []
    x, y, pressure = (trace[f"field_{of}"].values for of in ("x", "y", "pressure"))
    field = chart.ValueMap(x, y, pressure.T / MEGA, "pressure $p$ [MPa]")
    return [
        chart.Panel(
            chart.PlotAxis(f"$x$, the way of sliding [{trace.unit}]", grid=False),
            chart.PlotAxis(f"$y$ [{trace.unit}]", grid=False),
            [field, chart.CrossLine(float(trace.section), BLUE, "section", width=1.2)],
            name=f"field-{_word(name)}",
            caption=f"{name}: contact pressure, white out of contact, and the section below.",
            alt=f"Contact pressure over the map {name}.",
            height=480,
            to_scale=True,
        )
    ]
