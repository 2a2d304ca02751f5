"""Traces: a contact along a line as a drawing needs it.

A trace holds the lowest and highest values of pieces of the line, half of them equally long, the
others single points in the stretches with most friction, sum_i p_i h'_i / (N p_0). Behind a summit
p h' is below zero: over a stretch much shorter than a summit its share may exceed 1.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import xarray as xr

from gripscale.core import Array, Mask, checks, labelled
from gripscale.half_space.result import RoughContact

# Length of a stretch that shows some stones [m], the least in smallest waves and the most in
# lengths of the line.
STRETCH, LEAST_WAVES, MOST_OF_LINE = 4e-3, 20.0, 0.25
_PIECES = 2**15  # pieces of a trace: 1.2 MB in single precision
FIELD = 256  # most blocks of the field of a map along a side
_SOURCE = "gripscale direct contact"


def strongest_stretches(amount: Array, active: Mask, points: int, count: int) -> list[int]:
    """Return the first points of separate stretches of largest sums, cut where out of contact."""
    sums = _window_sums(amount, points)
    cut = active[: sums.size] | active[points - 1 :]
    sums[cut & ~cut.all()] = -math.inf
    firsts: list[int] = []
    while len(firsts) < count and np.isfinite(sums).any():
        firsts.append(int(np.argmax(sums)))
        sums[max(firsts[-1] - points + 1, 0) : firsts[-1] + points] = -math.inf
    return firsts


def _window_sums(amount: Array, points: int) -> Array:
    running = np.cumsum(np.insert(amount, 0, 0.0, axis=0), axis=0)
    return np.asarray(running[points:] - running[:-points])


def contact_trace(
    contact: RoughContact,
    *,
    stretch: float | None = None,
    pieces: int = _PIECES,
    derivative: Array | None = None,
) -> xr.Dataset:
    """Return a contact along a line as charts draw it, in pieces.

    The result is over `piece`: `x`, the middle [m]; `height_low` and `height_high`, `rubber_low`
    and `rubber_high` [m], `pressure_low` and `pressure_high` [Pa], zero out of contact;
    `running_friction` and `running_load` from the beginning of the line to the end of the piece,
    over those of the contact [-] (of a map, of its mean line), the friction NaN at rest;
    `by_height`, if there is a derivative: that by the height of a piece, over its length [1/m^2].
    `stretch_start` and `stretch_end` [m] of the stretch with most friction (at rest, load),
    `stretch_friction` and `stretch_load`, its parts of them. Of a map also `section` [m], the y of
    the line, and over `block_x` and `block_y` the largest `field_pressure` [Pa], NaN out of
    contact, at `field_x` and `field_y` [m]. Raises `InputError` if the stretch is not positive.

    A map is cut along its section with the strongest `stretch` [m]: by default 4 mm, at least 20 of
    the smallest waves and at most a quarter of the line. `derivative` is d ln friction / d height
    [1/m] of each point, shape of the grid.
    """
    x, step = contact.x, contact.grid.spacing[0]
    least = max(STRETCH, LEAST_WAVES * contact.smallest_wavelength)
    length = min(least, MOST_OF_LINE * contact.grid.lengths[0])
    if stretch is not None:
        length = checks.positive("stretch", stretch)
    points = min(max(round(length / step), 2), x.size)
    by_point = contact.pressure * contact.grid.slope(contact.height)
    moving = contact.speed > 0.0
    # of a map, the section through its strongest stretch; the friction is that of its mean line
    column = None
    if contact.height.ndim > 1:
        amount = by_point if moving else contact.pressure
        column = int(np.argmax(_window_sums(amount, points).max(axis=0)))
    height, rubber, pressure, force = (
        values if column is None else values[:, column]
        for values in (contact.height, contact.height + contact.gap, contact.pressure, by_point)
    )
    whole = float(by_point.mean()) * x.size if moving else math.nan

    amount = force if moving else pressure
    firsts = strongest_stretches(amount, pressure > 0.0, points, max(pieces // 2 // points, 1))
    first = np.arange(x.size)
    if x.size > pieces:
        even = np.linspace(0, x.size, pieces // 2, endpoint=False).astype(np.int64)
        single = [np.arange(start, start + points + 1) for start in firsts]
        first = np.unique(np.concatenate([even, *single]))
        first = first[first < x.size]
    last = np.append(first[1:], x.size) - 1
    friction = np.cumsum(force) / whole
    load = np.cumsum(pressure) / (x.size * contact.nominal_pressure)
    columns = {
        "height_low": (np.minimum.reduceat(height, first), "m"),
        "height_high": (np.maximum.reduceat(height, first), "m"),
        "rubber_low": (np.minimum.reduceat(rubber, first), "m"),
        "rubber_high": (np.maximum.reduceat(rubber, first), "m"),
        "pressure_low": (np.minimum.reduceat(pressure, first), "Pa"),
        "pressure_high": (np.maximum.reduceat(pressure, first), "Pa"),
        "running_friction": (friction[last], "1"),
        "running_load": (load[last], "1"),
    }
    if derivative is not None:
        by_line = derivative if column is None else derivative[:, column]
        by_height = np.add.reduceat(by_line, first) / (step * (last - first + 1))
        columns["by_height"] = (by_height, "1/m^2")
    data = {
        name: labelled("piece", values.astype(np.float32), unit, name.replace("_", " "), _SOURCE)
        for name, (values, unit) in columns.items()
    }
    data["x"] = labelled("piece", 0.5 * (x[first] + x[last]), "m", "middle of the piece", _SOURCE)
    strongest = slice(firsts[0], firsts[0] + points)
    stretch_load = pressure[strongest].mean() * points / x.size / contact.nominal_pressure
    for name, value, unit in (
        ("start", x[strongest][0], "m"),
        ("end", x[strongest][-1], "m"),
        ("friction", force[strongest].sum() / whole, "1"),
        ("load", stretch_load, "1"),
    ):
        data[f"stretch_{name}"] = labelled((), value, unit, f"{name} of the stretch", _SOURCE)
    if column is not None:
        data |= _field(contact, float(contact.y[column]))
    return xr.Dataset(data)


def _field(contact: RoughContact, section: float) -> dict[str, xr.Variable]:
    """Return the largest pressure of a map in each block, and where its section is."""
    along, across = (np.arange(0, n, -(-n // FIELD)) for n in contact.grid.shape)
    pressure = np.maximum.reduceat(np.maximum.reduceat(contact.pressure, along, 0), across, 1)
    field = np.where(pressure > 0.0, pressure, math.nan).astype(np.float32)
    axes = ("block_x", "block_y")
    return {
        "section": labelled((), section, "m", "y of the section", _SOURCE),
        "field_pressure": labelled(axes, field, "Pa", "largest pressure", _SOURCE),
        "field_x": labelled("block_x", contact.x[along], "m", "begin of the block", _SOURCE),
        "field_y": labelled("block_y", contact.y[across], "m", "begin of the block", _SOURCE),
    }


ROUNDED = 2**10  # pieces of a trace in a result are a multiple of these
PREFIX = "trace_"  # begin of the names and dimensions of traces in a result


def with_traces(answer: xr.Dataset, traces: Sequence[xr.Dataset]) -> xr.Dataset:
    """Return an answer with the traces of its profiles over `profile`; shorter ones end in NaN."""
    sizes = {dim: max(trace.sizes[dim] for trace in traces) for dim in traces[0].dims}
    # traces of like profiles, from several answers, then have one length
    sizes["piece"] = -(-sizes["piece"] // ROUNDED) * ROUNDED
    padded = [
        trace.pad({dim: (0, size - trace.sizes[dim]) for dim, size in sizes.items()})
        for trace in traces
    ]
    together = xr.concat(padded, "profile").rename({dim: f"{PREFIX}{dim}" for dim in sizes})
    return answer.assign({f"{PREFIX}{name}": together[name].variable for name in together})


def trace_variables(data: xr.Dataset) -> xr.Dataset:
    """Return the variables of a result that are its traces, named as they are there."""
    return data[[name for name in map(str, data) if name.startswith(PREFIX)]]


def traces_of(data: xr.Dataset) -> list[xr.Dataset]:
    """Return the traces that a result holds over `profile` or `sample`; empty without any."""
    traces = trace_variables(data).drop_vars(data.coords, errors="ignore")
    if not traces:
        return []
    names = {name: str(name).removeprefix(PREFIX) for name in traces}
    dims = {dim: str(dim).removeprefix(PREFIX) for dim in traces.dims}
    traces = traces.rename(names | {dim: name for dim, name in dims.items() if dim != name})
    along = "sample" if "sample" in traces.dims else "profile"
    each = (traces.isel({along: i}) for i in range(traces.sizes[along]))
    return [trace.isel(piece=np.flatnonzero(np.isfinite(trace.x.values))) for trace in each]
