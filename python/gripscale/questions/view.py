"""How a result over varied inputs shows itself, by what its variables and coordinates say.

Sentences, tables and charts are made of the attributes `long_name`, `units`, `symbol`, `interval`
and `stacks` (`gripscale.questions.answer.variables`), and of the unit in which the values of a
coordinate were given. Nothing here knows a question.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.charts import chart, style
from gripscale.charts.chart import Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.style import BLUE, INK
from gripscale.core import Array, units
from gripscale.experiment.design import CONVERGED
from gripscale.io.table import Column, Table, least_to_most, percent, significant
from gripscale.model import STATUS
from gripscale.questions.answer.variables import SYMBOLS, believed
from gripscale.report.elements import Card

# What selections of effects are called where nothing else says what they are of.
EFFECTS = {"all": "all effects", "none": "no effects"}
_KINDS = {"Pa": "pressure", "m/s": "speed", "m": "length"}  # of quantities, by their SI unit


def dimensions(data: xr.Dataset) -> list[str]:
    """Return the dimensions of the predictions of a result, in order."""
    return [str(dim) for dim in data["total_friction"].dims]


def places(data: xr.Dataset) -> Iterator[dict[str, int]]:
    """Yield the place of every prediction on the dimensions."""
    dims = dimensions(data)
    for index in np.ndindex(*(data.sizes[dim] for dim in dims)):
        yield dict(zip(dims, index, strict=True))


def is_numeric(data: xr.Dataset, dim: str) -> bool:
    """Return whether a dimension has numbers for values."""
    return dim in data.coords and data[dim].dtype.kind in "fiu"


def numeric(data: xr.Dataset) -> list[str]:
    """Return the dimensions of numbers with at least two values, longest first."""
    dims = [dim for dim in dimensions(data) if is_numeric(data, dim) and data.sizes[dim] > 1]
    return sorted(dims, key=lambda dim: -data.sizes[dim])


def shown_unit(coordinate: xr.DataArray) -> units.DisplayUnit:
    """Return how the values of a coordinate are shown: in the unit they were given in."""
    unit, word = (str(coordinate.attrs.get(name, "")) for name in ("units", units.GIVEN))
    if unit == "K":
        return units.DisplayUnit("°C", zero=units.ZERO_CELSIUS)
    if unit in _KINDS:
        word = word or units.USUAL[_KINDS[unit]]
        return units.DisplayUnit(word, units.UNITS[_KINDS[unit]][word])
    return units.DisplayUnit(word or unit.removesuffix("1"))


def name_at(data: xr.Dataset, dim: str, i: int) -> str:
    """Return what value `i` of a dimension is called, with its unit; without values its number."""
    if dim not in data.coords:
        return f"{dim.replace('_', ' ')} {i + 1}"
    if is_numeric(data, dim):
        return shown_unit(data[dim]).text(float(data[dim].values[i]), digits=3).rstrip()
    text = str(data[dim].values[i])
    return EFFECTS.get(text, text) if dim == "effects" else text.replace("_", " ")


def where(data: xr.Dataset, at: Mapping[str, int]) -> str:
    """Return what a place on several dimensions is called."""
    return ", ".join(name_at(data, dim, i) for dim, i in at.items())


def points(data: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield what every prediction is called, and the Dataset there."""
    for at in places(data):
        yield where(data, at), data.isel(at)


def at_places(data: xr.Dataset, name: str) -> NDArray[Any]:
    """Return a number or a text of every prediction, in the order of `places`."""
    whole = data[name].broadcast_like(data["total_friction"])
    return np.ravel(whole.transpose(*dimensions(data)).values)


def answers(data: xr.Dataset) -> list[str]:
    """Return the variables to believe: friction, then the contact area."""
    return [believed(data, name) for name in reversed(SYMBOLS)]


def interval_ends_of(data: xr.Dataset, name: str) -> list[xr.DataArray]:
    """Return both ends of the 90 % interval of a number; nothing where none is known."""
    ends = [data[end] for end in data[name].attrs.get("interval", "").split() if end in data]
    return ends if len(ends) == 2 and bool(ends[0].notnull().any()) else []


def title(variable: xr.DataArray) -> str:
    """Return the meaning of a variable with its symbol, which a page or paper sets as a letter."""
    symbol = variable.attrs.get("symbol", "")
    return f"{variable.attrs.get('long_name', variable.name)}{f' ${symbol}$' if symbol else ''}"


def course(data: xr.Dataset, name: str) -> str:
    """Return in words the least and the most of a number, and where; empty without a value."""
    values, every = at_places(data, name), list(places(data))
    values = np.where(values > 0.0, values, np.nan)  # none at rest
    if not np.isfinite(values).any():
        return ""
    ends = [at_places(data, str(end.name)) for end in interval_ends_of(data, name)]

    def number(i: int) -> str:
        both = [significant(float(end[i])) for end in ends if math.isfinite(end[i])]
        return significant(float(values[i])) + (f" ({' to '.join(both)})" if both else "")

    words = chart.spelled_out(title(data[name]))
    if values.size == 1:
        return f"{words} is {number(0)}"
    least, most = int(np.nanargmin(values)), int(np.nanargmax(values))
    texts = [f"{number(i)} at {where(data, every[i])}" for i in (least, most)]
    return f"{words} from {texts[0]} to {texts[1]}"


def number_columns(data: xr.Dataset, names: Iterable[str]) -> Iterator[Column]:
    """Yield a column for each number of every prediction, with its interval."""
    for name in names:
        values, about = at_places(data, name), data[name].attrs
        if values.dtype.kind == "f":  # no friction at rest is none, not zero
            values = np.where(values == 0.0, math.nan, values)
        words, unit = about.get("symbol") or about.get("long_name", name), shown_unit(data[name])
        yield Column(name, values, words, unit.unit, unit.divisor, unit.zero)
        if ends := interval_ends_of(data, name):
            both = np.stack([at_places(data, str(end.name)) for end in ends], axis=1)
            yield Column(f"{name}_interval", both, "90 %")


def table(data: xr.Dataset, columns: Iterable[Column], name: str, caption: str) -> Table:
    """Return a row for each prediction: its place, the columns and its status."""
    every = list(places(data))
    keys = [
        Column(dim, [name_at(data, dim, at[dim]) for at in every], dim.replace("_", " "))
        for dim in dimensions(data)
    ]
    states = [str(text) for text in at_places(data, STATUS)]
    bad, columns = [text != CONVERGED for text in states], [*columns, Column("status", states)]
    return Table(name, [*keys, *columns], caption, keys=len(keys), bad=bad)


def first_rows(whole: Table, most: int) -> Table:
    """Return a table cut to its first rows, which says how many more there are."""
    if len(whole) <= most:
        return whole
    columns = [
        replace(c, values=c.values[:most], marks=c.marks[:most], bad=c.bad[:most])
        for c in whole.columns
    ]
    notes = [*whole.notes, f"{len(whole) - most} more predictions are in the result file."]
    return replace(whole, columns=columns, bad=whole.bad[:most], notes=notes)


MOST_BANDS = 3  # curves beyond which intervals would cover each other, and are not drawn
MOST_NAMES = 12  # names in a legend of curves, evenly spaced among more
INTERVAL = "90 % interval"
_MOST_NUMBERS = 5  # along an axis of many decades
STAR = " *"  # behind the name of a point that rests on the rubber beyond its measured band
_MARKERS = "osD^vPX<d>"  # of curves that have names, beside their colours
_LEAST_SHARE = 0.005  # of a sum: parts that never reach it are not drawn


def plot_axis(coordinate: xr.DataArray) -> tuple[PlotAxis, Array]:
    """Return the axis of a coordinate of numbers and its values as they are drawn."""
    unit = shown_unit(coordinate)
    x = unit.of(coordinate.values)
    if coordinate.name in ("wavelength", "octave"):
        return chart.wavelength_axis(x), x
    low, high = float(np.nanmin(x)), float(np.nanmax(x))
    limits: dict[str, Any] = {"low": low, "high": high} if high > low else {}
    log = low > 0.0 and high > 8.0 * low
    limits |= {"numbers": _MOST_NUMBERS} if log and high > 1e5 * low else {}
    return PlotAxis(f"{title(coordinate)} [{unit.unit or '-'}]", log=log, **limits), x


def ordinate(variable: xr.DataArray) -> PlotAxis:
    """Return the axis of a number: of areas logarithmic, of friction from zero."""
    area = "contact_fraction" in str(variable.name)
    return PlotAxis(f"{title(variable)} [-]", log=area, low=None if area else 0.0)


def beyond(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return which predictions rest on extrapolation; where it is not known, none."""
    flags = data["total_friction"].copy(data=style.predictions_beyond(data))
    return flags if {*flags.dims} <= {*data[name].dims} else xr.DataArray(False)


def curves(data: xr.Dataset, dims: Sequence[str]) -> Iterator[tuple[dict[str, int], str, str]]:
    """Yield the points of some dimensions with colour and name."""
    every = list(product(*(range(data.sizes[dim]) for dim in dims)))
    colours = [style.COLOURS[i % len(style.COLOURS)] for i in range(len(every))]
    if all(is_numeric(data, dim) for dim in dims):
        colours = style.colours(len(every), ordered=len(dims) == 1)
    if [*dims] == ["temperature"]:
        colours = style.shades(len(every), "Plasma")
    for point, colour in zip(every, colours, strict=True):
        at = dict(zip(dims, point, strict=True))
        yield at, colour, where(data, at)


def panel(
    data: xr.Dataset, name: str, along: str, *, over: str = "", flags: xr.DataArray | None = None
) -> Panel:
    """Return a number along a dimension, a curve for each point of the others; names are points.

    It is drawn `over` another coordinate along the dimension where there is one. What rests on the
    rubber beyond its measured band, the `flags`, is dashed; of names it has a star.
    """
    numbers = bool(over) or is_numeric(data, along)
    flags = beyond(data, name) if flags is None else flags
    variable, flags = xr.broadcast(data[name], flags)
    others = [str(dim) for dim in variable.dims if dim != along]
    if numbers:
        abscissa, values = plot_axis(data[over or along])
        x = xr.broadcast(data[over or along].copy(data=values), variable)[0]
    else:
        stars = flags.any(others).values
        names = [f"{name_at(data, along, i)}{STAR * bool(star)}" for i, star in enumerate(stars)]
        x = xr.broadcast(xr.DataArray(np.arange(float(len(names))), dims=along), variable)[0]
        label = data[along].attrs.get("long_name", along)
        abscissa = PlotAxis(f"{label} [-]", ticks=dict(enumerate(names)), margin=0.3)
    drawn: dict[str, Any] = {"dash": "", "size": 4.5}
    if numbers:
        drawn = {"dash": "solid", "size": 3.0, "clip": False}
    every, marks = list(curves(data, others)), list[Mark]()
    listed, ordered = -(-len(every) // MOST_NAMES), all(is_numeric(data, dim) for dim in others)
    ends = interval_ends_of(data, name)
    for i, (at, colour, words) in enumerate(every):
        only, marker = colour if others else BLUE, "o" if ordered else _MARKERS[i % len(_MARKERS)]
        places_x, y, dashed, *both = (
            part.isel({dim: at[dim] for dim in part.dims if dim in at}).values
            for part in (x, variable, flags, *ends)
        )
        if not np.isfinite(y).any():
            continue
        bars: dict[str, Any] = dict(zip(("low", "high"), () if numbers else both, strict=False))
        if both and numbers and len(every) <= MOST_BANDS and np.isfinite(both[0]).any():
            label = "" if others else INTERVAL
            marks.append(ShadedBand(places_x, both[0], both[1], only, label, 0.15))
        marks.append(Series(places_x, y, only, words or "sliding", marker=marker, **drawn, **bars,
                            beyond=numbers & dashed, listed=i % listed == 0))  # fmt: skip
    return Panel(abscissa, ordinate(data[name]), marks)


def stacked_panel(
    data: xr.Dataset, name: str, along: str, words: Sequence[str], y: PlotAxis
) -> Panel:
    """Return a band for each part along a dimension, named by `words`, one upon the other."""
    stacks = data[name].attrs["stacks"]
    rows = data[name].transpose(stacks, along).values
    there = np.nan_to_num(rows)
    upper = np.where(np.isnan(rows).all(axis=0), np.nan, np.cumsum(there, axis=0))
    most = there.max(axis=1)
    seen = [i for i, part in enumerate(most) if part >= _LEAST_SHARE * there.sum(axis=0).max()]
    abscissa, x = plot_axis(data[along])
    colours = style.shades(max(len(seen), 2), "Viridis" if stacks == "octave" else "Cividis")
    bands: list[Mark] = [
        ShadedBand(x, upper[i] - there[i], upper[i], colour, words[i], 1.0, edged=True)
        for i, colour in zip(seen, colours, strict=False)
    ]
    total = Series(x, upper[-1], INK, width=1.2, clip=False, beyond=style.predictions_beyond(data))
    # the last first: so they stand in the legend as in the stack
    return Panel(abscissa, y, [*bands[::-1], total])


# Models in words; others by their names.
_MODELS = {"chain": "chain of sine waves", "direct": "direct contact of the measured surface"}


def model_in_words(data: xr.Dataset) -> str:
    """Return what predicted a result."""
    name = str(data.attrs.get("model", "model"))
    return _MODELS.get(name, name.replace("_", " "))


def load_in_words(data: xr.Dataset) -> Iterator[str]:
    """Yield nominal pressure and speed, where a result has one of them."""
    for name in ("pressure", "speed"):
        nominal = data.get(f"nominal_{name}", data.attrs.get(f"nominal_{name}", math.nan))
        values = np.unique(nominal)
        if name not in data.dims and values.size == 1 and math.isfinite(values[0]):
            yield units.display_unit_of(data.attrs, name).text(float(values[0]))


def cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield the range of friction and contact area."""
    for name in answers(data):
        values = data[name].values[data[name].values > 0.0]  # none at rest
        if not values.size:
            continue
        detail = "answer" if name.startswith("answer") else model_in_words(data)
        if interval_ends_of(data, name):
            width = float(data[f"{name}_half_width"].max())
            detail = f"answer; ± {percent(width)} (90 %)"
        words = chart.spelled_out(title(data[name]))
        yield Card(f"{words[0].upper()}{words[1:]}", least_to_most(values), detail)
