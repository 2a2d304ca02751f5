"""Where a contact makes its friction: on which slopes of the surface, and at which of its points.

The friction from the contact traction is a sum over the points of the grid,

    mu = sum_i p_i h'_i / (N p_0),

so that a class of slopes, or a stretch of the surface, has a share in it, as it has in the load,
sum_i p_i = N p_0, and in the contact area. Behind a summit p h' is below zero: over a stretch much
shorter than a summit a share may exceed 1, and over several summits it does not.

A trace is a contact along a line as a drawing needs it: lowest and highest values of pieces, half
of them equally long, the others single points in the stretches with most friction. Its size does
not depend on the number of points.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.core import checks
from gripscale.core.arrays import Array, Mask
from gripscale.core.labels import labelled

if TYPE_CHECKING:
    from gripscale.half_space.result import RoughContact

SLOPES = (0.0, 0.25, 0.5, 1.0, 2.0)
"""Lower ends of the classes of |dh/dx|; the last has no upper end."""
SHARES_BY_SLOPE = {
    "friction_by_slope": "share of the friction from contact on slopes of the class",
    "load_by_slope": "share of the load carried on slopes of the class",
    "contact_by_slope": "share of the contact area on slopes of the class",
}
STRETCH, LEAST_WAVES, MOST_OF_LINE = 4e-3, 20.0, 0.25
"""Length of a stretch that shows some stones [m], the least in smallest waves and the most in
lengths of the line."""
_PIECES = 2**15
"""Pieces of a trace: 1.2 MB in single precision."""
FIELD = 256
"""Most blocks of the field of a map along a side."""
_SOURCE = "gripscale direct contact"


def shares_by_slope(contact: RoughContact) -> xr.Dataset:
    """Return the shares of friction, load and contact area by slope of the surface.

    Parameters
    ----------
    contact : RoughContact
        The contact; the slope is dh/dx along the sliding direction, up or down.

    Returns
    -------
    xarray.Dataset
        `friction_by_slope`, `load_by_slope` and `contact_by_slope` [-] over `slope`, the lower end
        of the classes 0 to 0.25, to 0.5, to 1, to 2 and above. Each sums to 1; the friction is NaN
        where there is none.
    """
    slope = contact.grid.slope(contact.height)
    index = np.digitize(np.abs(slope), SLOPES[1:], right=True).reshape(-1)
    force, total = contact.pressure * slope, float(np.sum(contact.pressure * slope))
    moving = contact.speed > 0.0 and total > 0.0
    amounts = (
        force if moving else np.full(force.shape, math.nan),
        contact.pressure,
        contact.active,
    )
    data = {}
    for (name, text), amount in zip(SHARES_BY_SLOPE.items(), amounts, strict=True):
        sums = np.bincount(index, np.asarray(amount, dtype=float).reshape(-1), len(SLOPES))
        share = sums / amount.sum() if amount is not force else sums / total
        data[name] = labelled("slope", share, "1", text, _SOURCE)
    ends = labelled("slope", np.array(SLOPES), "1", "lower end of |dh/dx|", "input")
    return xr.Dataset(data, {"slope": ends})


def stretch_length(contact: RoughContact) -> float:
    """Return the length [m] of a stretch that shows some summits of a contact."""
    least = max(STRETCH, LEAST_WAVES * contact.smallest_wavelength)
    return min(least, MOST_OF_LINE * contact.grid.lengths[0])


def strongest_stretches(amount: Array, active: Mask, points: int, count: int) -> list[int]:
    """Return the first points of the stretches with the largest sums of an amount, largest first.

    They begin and end out of contact, where there is any such place.

    Parameters
    ----------
    amount : array, shape (n,)
        What each point of a line adds.
    active : array of bool, shape (n,)
        Where it is in contact.
    points : int
        Points of a stretch, at most n.
    count : int
        Stretches wanted; they do not overlap, so that there may be fewer.
    """
    sums = _window_sums(amount, points)
    cut = active[: sums.size] | active[points - 1 :]
    sums[cut & ~cut.all()] = -math.inf
    firsts: list[int] = []
    while len(firsts) < count and np.isfinite(sums).any():
        firsts.append(int(np.argmax(sums)))
        sums[max(firsts[-1] - points + 1, 0) : firsts[-1] + points] = -math.inf
    return firsts


def _window_sums(amount: Array, points: int) -> Array:
    """Return the sums over each window of so many points along the first axis."""
    running = np.cumsum(np.insert(amount, 0, 0.0, axis=0), axis=0)
    return np.asarray(running[points:] - running[:-points])


class _Line(NamedTuple):
    """A contact along x: a line, or the section of a map through its strongest stretch."""

    height: Array
    rubber: Array
    pressure: Array
    force: Array
    """p h' [Pa]."""
    mean: float
    """Sum of p h' of the mean line of the contact [Pa]; NaN at rest."""
    column: int | None
    """Of a map, where it is along y."""


def _line(contact: RoughContact, points: int) -> _Line:
    force = contact.pressure * contact.grid.slope(contact.height)
    mean = float(force.mean()) * force.shape[0] if contact.speed > 0.0 else math.nan
    rubber, pressure = contact.height + contact.gap, contact.pressure
    if contact.height.ndim == 1:
        return _Line(contact.height, rubber, pressure, force, mean, None)
    amount = force if contact.speed > 0.0 else pressure
    at = int(np.argmax(_window_sums(amount, points).max(axis=0)))
    height = contact.height[:, at]
    return _Line(height, rubber[:, at], pressure[:, at], force[:, at], mean, at)


def contact_trace(
    contact: RoughContact,
    *,
    stretch: float | None = None,
    pieces: int = _PIECES,
    derivative: Array | None = None,
) -> xr.Dataset:
    """Return a contact along a line as charts draw it, in pieces.

    Parameters
    ----------
    contact : RoughContact
        Of a line, or of a map: then along its section with the strongest stretch.
    stretch : float, optional
        Length of the stretch with most friction [m]; by default 4 mm, at least 20 of the smallest
        waves and at most a quarter of the line.
    pieces : int
        Most pieces of the trace: half of them are equally long, the others are the points of the
        stretches with most friction.
    derivative : array, optional
        d ln friction / d height [1/m] of each point, shape of the grid.

    Returns
    -------
    xarray.Dataset
        Over `piece`: `x`, the middle [m]; `height_low` and `height_high`, `rubber_low` and
        `rubber_high` [m], `pressure_low` and `pressure_high` [Pa], zero out of contact;
        `running_friction` and `running_load` from the beginning of the line to the end of the
        piece, over those of the contact [-] (of a map, of its mean line), the friction NaN at rest;
        `by_height`, if there is a derivative: that by the height of a piece, over its length
        [1/m^2]. `stretch_start` and
        `stretch_end` [m] of the stretch with most friction (at rest, load), `stretch_friction` and
        `stretch_load`, its parts of them. Of a map also `section` [m], the y of the line, and over
        `block_x` and `block_y` the largest `field_pressure` [Pa], NaN out of contact, at `field_x`
        and `field_y` [m].

    Raises
    ------
    InputError
        If the stretch is not positive.
    """
    x, step = contact.x, contact.grid.spacing[0]
    length = stretch_length(contact) if stretch is None else checks.positive("stretch", stretch)
    points = min(max(round(length / step), 2), x.size)
    line = _line(contact, points)
    amount = line.force if contact.speed > 0.0 else line.pressure
    firsts = strongest_stretches(amount, line.pressure > 0.0, points, max(pieces // 2 // points, 1))
    first = _first_points(x.size, points, firsts, pieces)
    last = np.append(first[1:], x.size) - 1
    friction = np.cumsum(line.force) / line.mean
    load = np.cumsum(line.pressure) / (x.size * contact.nominal_pressure)
    columns = {
        "height_low": (np.minimum.reduceat(line.height, first), "m"),
        "height_high": (np.maximum.reduceat(line.height, first), "m"),
        "rubber_low": (np.minimum.reduceat(line.rubber, first), "m"),
        "rubber_high": (np.maximum.reduceat(line.rubber, first), "m"),
        "pressure_low": (np.minimum.reduceat(line.pressure, first), "Pa"),
        "pressure_high": (np.maximum.reduceat(line.pressure, first), "Pa"),
        "running_friction": (friction[last], "1"),
        "running_load": (load[last], "1"),
    }
    if derivative is not None:
        column = derivative if line.column is None else derivative[:, line.column]
        by_height = np.add.reduceat(column, first) / (step * (last - first + 1))
        columns["by_height"] = (by_height, "1/m^2")
    data = {
        name: labelled("piece", values.astype(np.float32), unit, name.replace("_", " "), _SOURCE)
        for name, (values, unit) in columns.items()
    }
    data["x"] = labelled("piece", 0.5 * (x[first] + x[last]), "m", "middle of the piece", _SOURCE)
    end = firsts[0] + points - 1
    for name, value, unit in (
        ("start", x[firsts[0]], "m"),
        ("end", x[end], "m"),
        ("friction", line.force[firsts[0] : end + 1].sum() / line.mean, "1"),
        (
            "load",
            line.pressure[firsts[0] : end + 1].mean() * points / x.size / contact.nominal_pressure,
            "1",
        ),
    ):
        data[f"stretch_{name}"] = labelled((), value, unit, f"{name} of the stretch", _SOURCE)
    if line.column is not None:
        data |= _field(contact, float(contact.y[line.column]))
    return xr.Dataset(data)


ROUNDED = 2**10
"""Pieces of a trace in a result are a multiple of these."""
PREFIX = "trace_"
"""Begin of the names and dimensions of traces in a result."""


def with_traces(answer: xr.Dataset, traces: Sequence[xr.Dataset]) -> xr.Dataset:
    """Return an answer with the trace of each of its profiles, over `profile`.

    Names and dimensions begin with `trace_`; shorter traces end in NaN.
    """
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


def _first_points(size: int, points: int, firsts: list[int], pieces: int) -> NDArray[np.int64]:
    """Return the first point of each piece: each of the stretches' points, and equal pieces."""
    if size <= pieces:
        return np.arange(size)
    even = np.linspace(0, size, pieces // 2, endpoint=False).astype(np.int64)
    single = [np.arange(start, start + points + 1) for start in firsts]
    first = np.unique(np.concatenate([even, *single]))
    return first[first < size]


def _field(contact: RoughContact, section: float) -> dict[str, xr.Variable]:
    """Return the pressure of a map by blocks, and where its section is."""
    edges = [np.arange(0, n, -(-n // FIELD)) for n in contact.grid.shape]
    pressure = np.maximum.reduceat(np.maximum.reduceat(contact.pressure, edges[0], 0), edges[1], 1)
    field = np.where(pressure > 0.0, pressure, math.nan).astype(np.float32)
    return {
        "section": labelled((), section, "m", "y of the section", _SOURCE),
        "field_pressure": labelled(
            ("block_x", "block_y"), field, "Pa", "largest pressure", _SOURCE
        ),
        "field_x": labelled("block_x", contact.x[edges[0]], "m", "begin of the block", _SOURCE),
        "field_y": labelled("block_y", contact.y[edges[1]], "m", "begin of the block", _SOURCE),
    }
