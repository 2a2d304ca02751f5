"""Curves of a study: totals over each axis, contact and friction against wavelength."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.charts.page import curve, dashed_entry, hover, legend, plot, shades, whole_decades
from gripscale.charts.page_elements import Chart, telling, words_of
from gripscale.charts.style import COLOURS, down_to, predictions_beyond, waves_beyond
from gripscale.core.units import KEYS
from gripscale.experiment.axis import LABELS, axis_shown
from gripscale.experiment.speed_and_temperature import COLLAPSED, REDUCED_SPEED
from gripscale.report.source import Study

MOST_CURVES = 12
"""Curves in one figure; of more, so many evenly spaced ones are drawn."""
PER_WAVE = ("running_contact_fraction", "running_friction", "contact_fraction", "friction")
Array = NDArray[np.float64]


def study_charts(study: Study) -> list[Chart]:
    """Return a figure for each total over each numeric axis, and for each number per wave."""
    totals = [
        str(name)
        for name, variable in study.data.data_vars.items()
        if variable.dims and set(variable.dims) <= set(study.axes) and variable.dtype.kind in "fi"
        if telling(variable)
    ]
    axes = [axis for axis in study.axes if _numeric(study.data, axis)]
    charts = [
        _total(study, name, axis)
        for axis in axes
        for name in totals
        if axis in study.data[name].dims
    ]
    if "friction_by_decade" in study.data and _numeric(study.data, "decade"):
        charts.append(_up_to_time(study))
    if REDUCED_SPEED in study.data.coords:
        charts += [_master(study, name) for name in COLLAPSED]
    if "wavelength" in study.data:
        charts += [_per_wave(study, name) for name in PER_WAVE if _drawable(study, name)]
    return charts


def _numeric(data: xr.Dataset, axis: str) -> bool:
    return axis in data.coords and data[axis].dtype.kind in "fiu" and data.sizes[axis] > 1


def _drawable(study: Study, name: str) -> bool:
    if name not in study.data or "scale" not in study.data[name].dims:
        return False
    values, lengths = study.data[name].values, study.data["wavelength"].values
    return bool(np.isfinite(values).any() and (lengths[np.isfinite(lengths)] > 0.0).any())


def _total(study: Study, name: str, axis: str) -> Chart:
    variable, words = study.data[name], words_of(study.data, name)
    x = _shown(study.data, axis)
    spread = bool((x > 0.0).all() and x.max() / x.min() > 8.0)
    figure = plot(_label(study.data, axis), _label(study.data, name), log="x" if spread else "")
    others = [str(dim) for dim in variable.dims if dim != axis]
    colours = _colours(variable, others)
    flags = xr.broadcast(_beyond(study.data, variable), variable)[0]
    pairs = zip(_slices(variable, others), _slices(flags, others), strict=True)
    for i, ((label, one), (_, beyond)) in enumerate(pairs):
        y = one.values.astype(float)
        dots = curve(figure, x, y, colours[i], label or words, beyond=beyond.transpose(axis))
        hover(figure, [dots], [(axis.replace("_", " "), "@x"), (words, "@y")])
    dashed_entry(figure, flags)
    over = words_of(study.data, axis)
    meaning = _sentence(str(variable.attrs.get("long_name", words)))
    return Chart(
        f"{name}-over-{axis}",
        f"{meaning}, over {over}.",
        f"{words} against {over}.",
        legend(figure),
    )


def _up_to_time(study: Study) -> Chart:
    """Draw friction summed up over relaxation times.

    The sum at the end of a decade is exact whatever the spacing of the Maxwell elements; the parts
    of the decades would rise and fall with how many of them one holds.
    """
    name = "friction_by_decade"
    parts = study.data[name]
    summed = parts.cumsum("decade", skipna=True).where(parts.notnull())
    times = 10.0 * study.data["decade"].values.astype(float)
    figure = plot("relaxation times up to [s]", f"{words_of(study.data, name)} [-]", log="x")
    others = [str(dim) for dim in parts.dims if dim != "decade"]
    colours = _colours(summed, others)
    for i, (label, one) in enumerate(_slices(summed, others)):
        dots = curve(figure, times, one.values.astype(float), colours[i], label)
        hover(figure, [dots], [("up to", "@x s"), ("μ", "@y")])
    return Chart(
        f"{name}-over-decade",
        "Friction coefficient of all Maxwell elements up to a relaxation time, split as at small "
        "strain.",
        "Friction summed up over relaxation times.",
        legend(figure),
    )


def _sentence(text: str) -> str:
    """Return a text with a capital, unless it begins with a letter of an equation."""
    return text if text[1:2] == " " else text[:1].upper() + text[1:]


def _master(study: Study, name: str) -> Chart:
    """Draw a total at every temperature over the reduced speed."""
    variable, reduced = study.data[name], study.data[REDUCED_SPEED]
    speeds = axis_shown(study.data, "speed")
    figure = plot(f"reduced speed a_T v [{speeds.unit}]", _label(study.data, name), log="x")
    temperatures = list(range(variable.sizes["temperature"]))
    colours = shades(len(temperatures))
    flags = _beyond(study.data, variable)
    for i in temperatures:
        x, y, beyond = (one.isel(temperature=i) for one in (reduced, variable, flags))
        words = _value(variable, "temperature", i)
        dots = curve(figure, speeds.of(x), y.values, colours[i], words, beyond=beyond)
        hover(figure, [dots], [("a_T v", "@x"), (words_of(study.data, name), "@y")])
    dashed_entry(figure, flags)
    return Chart(
        f"{name}-over-{REDUCED_SPEED}",
        f"{words_of(study.data, name)}, over the reduced speed a_T v: one curve where "
        "temperature does nothing but shift the relaxation times of the rubber.",
        f"{words_of(study.data, name)} against a_T v at every temperature.",
        legend(figure),
    )


def _beyond(data: xr.Dataset, variable: xr.DataArray) -> xr.DataArray:
    """Return which predictions rest on extrapolation; of what is at rest, or not known, none."""
    flags = data["total_friction"].copy(data=predictions_beyond(data))
    return flags if set(flags.dims) <= set(variable.dims) else xr.DataArray(False)


def _per_wave(study: Study, name: str) -> Chart:
    data = study.data
    lengths = data["wavelength"].values.astype(float) * 1e3
    lengths = lengths[np.isfinite(lengths)]
    log = "y" if "fraction" in name else ""
    label = _label(data, name)
    figure = plot("wavelength λ [mm]", label, log=log, wavelengths=lengths, height=400)
    flags = data["wavelength"].copy(data=waves_beyond(data))
    both = xr.broadcast(data[name], data["wavelength"], flags)
    others = [str(dim) for dim in both[0].dims if dim != "scale"]
    pairs = zip(*(_slices(one, others) for one in both), strict=True)
    colours = _colours(both[0], others)
    if log:
        whole_decades(figure, data[name].values)
    for i, ((text, values), (_, wavelength), (_, flag)) in enumerate(pairs):
        beyond = down_to(flag) if name.startswith("running") else flag
        x, y = wavelength.values.astype(float) * 1e3, values.values.astype(float)
        dots = curve(figure, x, y, colours[i], text or words_of(data, name), beyond=beyond)
        hover(figure, [dots], [("λ", "@x mm"), (words_of(data, name), "@y")])
    dashed_entry(figure, flags)
    return Chart(
        f"{name}-per-wave",
        f"{_sentence(str(data[name].attrs.get('long_name', name)))}, against wavelength.",
        f"{words_of(data, name)} against wavelength, which falls to the right.",
        legend(figure),
    )


def _colours(variable: xr.DataArray, over: list[str]) -> list[str]:
    """Return a colour for each slice: distinct ones for a few, shades for many."""
    count = min(math.prod(variable.sizes[name] for name in over), MOST_CURVES)
    return list(COLOURS) if count <= len(COLOURS) else shades(count)


def _slices(variable: xr.DataArray, over: list[str]) -> Iterator[tuple[str, xr.DataArray]]:
    """Yield the slices at (a choice of) all points of the axes `over`, with what to call them."""
    points = list(product(*(range(variable.sizes[name]) for name in over)))
    if len(points) > MOST_CURVES:
        chosen = np.linspace(0, len(points) - 1, MOST_CURVES).round().astype(int)
        points = [points[i] for i in chosen]
    for point in points:
        at = dict(zip(over, point, strict=True))
        words = [_value(variable, name, i) for name, i in at.items()]
        yield ", ".join(words), variable.isel(at)


def _value(variable: xr.DataArray, name: str, i: int) -> str:
    """Return what a point of an axis is called: with its unit, or else with the axis."""
    if name not in variable.coords:
        return f"{name.replace('_', ' ')} {i + 1}"
    value: Any = variable[name].values[i]
    if not isinstance(value, np.number):
        return str(value)
    unit = _unit(variable, name)
    shown = float(_shown(variable, name)[i])
    return f"{name.replace('_', ' ')} {shown:.3g}" if unit == "-" else f"{shown:.3g} {unit}"


def _label(data: xr.Dataset, name: str) -> str:
    return f"{words_of(data, name)} [{_unit(data, name)}]"


def _unit(data: xr.Dataset | xr.DataArray, name: str) -> str:
    """Return the unit in which a coordinate is drawn."""
    if name in (*KEYS, "temperature"):
        return axis_shown(data, name).unit
    unit = str(data[name].attrs.get("units", "1")) if name in data.coords else "1"
    return "-" if unit == "1" else unit


def _shown(data: xr.Dataset | xr.DataArray, name: str) -> Array:
    """Return a coordinate in the unit in which it is drawn."""
    values = data[name].values.astype(float)
    return axis_shown(data, name).of(values) if name in LABELS else values
