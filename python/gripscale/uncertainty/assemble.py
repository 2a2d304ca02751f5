"""From the answers of all samples to one Dataset: what was drawn beside what came of it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale import versions
from gripscale.model import FRICTION_OUTSIDE_BAND
from gripscale.shown import GIVEN
from gripscale.study.axis import LONG_NAMES, UNITS, Axis
from gripscale.uncertainty.choice import Chosen
from gripscale.uncertainty.design import Drawn
from gripscale.uncertainty.quantiles import LEVELS, QUANTITIES, quantiles
from gripscale.uncertainty.shares import shares
from gripscale.uncertainty.sources.source import Source

Array = NDArray[np.float64]

CONVERGED = "converged"
NUMBERS = {
    "friction": ("total_friction", "1", "friction coefficient"),
    "contact_fraction": ("total_contact_fraction", "1", "real over nominal contact area"),
    "outside_band": (
        FRICTION_OUTSIDE_BAND,
        "1",
        "share of the friction that rests on the rubber outside the measured frequencies",
    ),
}
"""What is kept of each answer: its name there, unit and meaning."""


class Place(NamedTuple):
    """One prediction: of which model, at which value of the axis, of which sample.

    The case itself is sample -1.
    """

    model: str
    value: int
    sample: int


def dataset(
    models: Sequence[str],
    axis: Axis | None,
    drawn: Sequence[Drawn],
    chosen: Chosen,
    solved: Mapping[Place, xr.Dataset],
    refused: Mapping[Place, str],
) -> xr.Dataset:
    """Return all samples over model, axis and sample, with quantiles and shares.

    Parameters
    ----------
    models, axis
        The dimensions beside `sample`; no axis for one load.
    drawn, chosen
        What was drawn in each sample, and of which sources.
    solved, refused
        The answers, and why there is none.
    """
    values = 1 if axis is None else len(axis.values)
    shape = (len(models), values, len(drawn) + 1)
    errors = [f"{name}_grid_error" for name in QUANTITIES]
    kept = {name: np.full(shape, np.nan) for name in (*NUMBERS, *errors, "seconds")}
    status = np.full(shape, "", dtype=object)
    for at in np.ndindex(shape):
        place = Place(models[at[0]], at[1], at[2] - 1)
        status[at] = refused.get(place, "")
        if place in solved:
            answer = solved[place]
            status[at] = str(answer["prediction_status"].item())
            kept["seconds"][at] = float(answer.attrs.get("seconds", math.nan))
            if status[at] == CONVERGED:
                for name, (theirs, *_) in NUMBERS.items():
                    kept[name][at] = float(answer[theirs])
                for name in QUANTITIES:
                    kept[f"{name}_grid_error"][at] = _grid_error(answer, name)
    named = _Named(axis)
    samples = {name: values[..., 1:] for name, values in kept.items()}
    data: dict[str, Any] = {
        name: named(samples[name], ("sample",), unit, text)
        for name, (_, unit, text) in NUMBERS.items()
    }
    data |= {
        f"{name}_case": named(kept[name][..., 0], (), "1", f"{text} of the case itself")
        for name, (_, text) in QUANTITIES.items()
    }
    for name, (_, text) in QUANTITIES.items():
        about = f"estimated relative error of the grid of a direct contact, {text}"
        error = samples[f"{name}_grid_error"]
        data[f"{name}_grid_error"] = named(error, ("sample",), "1", about)
    data["seconds"] = named(samples["seconds"], ("sample",), "s", "time it took to solve")
    data["status"] = named(status[..., 1:], ("sample",), "1", "converged, or why not")
    data["status_case"] = named(status[..., 0], (), "1", "converged, or why not, the case itself")
    failed = (status[..., 1:] != CONVERGED).sum(axis=-1)
    data["failed"] = named(failed, (), "1", "samples without an answer; they count in no quantile")
    for name, (_, text) in QUANTITIES.items():
        found = np.moveaxis(quantiles(samples[name]), 0, -1)
        data[f"{name}_quantile"] = named(found, ("quantile",), "1", text)
        data |= _shares(named, name, samples[name], _coordinates(drawn, chosen.sources))
    coordinates: dict[str, Any] = {
        "model": list(models),
        "quantile": ("quantile", list(LEVELS), {"units": "1", "long_name": "share below"}),
        "source": ("source", [s.name for s in chosen.sources], {"long_name": "source"}),
        "label": ("source", [s.label for s in chosen.sources], {"long_name": "source in words"}),
        "end": ("end", ["low", "high"]),
        **_drawn(drawn, chosen.sources),
    }
    if axis is not None:
        attrs = {"units": UNITS[axis.name], "long_name": LONG_NAMES[axis.name], GIVEN: axis.unit}
        coordinates[axis.name] = (axis.name, list(axis.values), attrs)
    return xr.Dataset(data, coordinates).assign_attrs(
        title="Uncertainty of real contact area and friction of rubber on a rough surface",
        left_out=json.dumps(chosen.left_out),
        **versions.attributes(),
    )


def _grid_error(answer: xr.Dataset, name: str) -> float:
    """Return the relative error a direct contact estimates of its grid, NaN of other models."""
    if not {"weight", f"{name}_error"} <= set(answer.data_vars):
        return math.nan
    total = abs(float(answer[f"total_{name}"]))
    error = float((answer["weight"] * answer[f"{name}_error"]).sum())
    return error / total if total > 0.0 else math.nan


class _Named:
    """Makes variables over model and axis; without an axis its dimension of one is dropped."""

    def __init__(self, axis: Axis | None) -> None:
        self.axis = axis

    def __call__(
        self, values: NDArray[Any], dims: tuple[str, ...], unit: str, long_name: str
    ) -> xr.Variable:
        attrs = {"units": unit, "long_name": long_name}
        if self.axis is None:
            return xr.Variable(("model", *dims), values[:, 0], attrs)
        return xr.Variable(("model", self.axis.name, *dims), values, attrs)


def _drawn(drawn: Sequence[Drawn], sources: Sequence[Source]) -> dict[str, Any]:
    """Return the coordinates of the draws over `sample`, each with its source."""
    return {
        name: (
            "sample",
            [one.coordinates[name] for one in drawn],
            {"units": told.unit, "long_name": told.long_name, "source": source.name},
        )
        for source in sources
        for name, told in source.coordinates.items()
    }


def _coordinates(drawn: Sequence[Drawn], sources: Sequence[Source]) -> dict[str, Array]:
    """Return the logarithms that describe the draws of each source, shape (samples, numbers)."""
    found = {}
    for source in sources:
        columns = [
            np.array([one.coordinates[name] for one in drawn], dtype=float)
            for name in source.coordinates
        ]
        logs = [told.logarithm for told in source.coordinates.values()]
        found[source.name] = np.stack(
            [c if is_log else np.log(c) for c, is_log in zip(columns, logs, strict=True)], axis=-1
        )
    return found


def _shares(
    named: _Named, name: str, samples: Array, coordinates: dict[str, Array]
) -> dict[str, xr.Variable]:
    """Return share, its error, the error of differences and the ends of each source."""
    outer, count = samples.shape[:-1], len(coordinates)
    share, error = np.full((*outer, count), np.nan), np.full((*outer, count), np.nan)
    apart, ends = np.full((*outer, count, count), np.nan), np.full((*outer, count, 2), np.nan)
    unexplained = np.full(outer, np.nan)
    for place in np.ndindex(outer):
        found = shares(samples[place], coordinates)
        if found is not None:
            share[place], error[place], apart[place] = found.share, found.error, found.apart
            ends[place] = np.stack([found.low, found.high], axis=-1)
            unexplained[place] = found.unexplained
    of = f"in the variance of the logarithm of {QUANTITIES[name][1]}"
    return {
        f"{name}_share": named(share, ("source",), "1", f"share of each source {of}"),
        f"{name}_share_error": named(error, ("source",), "1", "standard error of the share"),
        f"{name}_share_difference_error": named(
            apart, ("source", "other_source"), "1", "standard error of the difference of two shares"
        ),
        f"{name}_end": named(
            ends,
            ("source", "end"),
            "1",
            f"{QUANTITIES[name][1]}, at 5 and 95 % of what a source alone does",
        ),
        f"{name}_unexplained": named(unexplained, (), "1", f"share of no source {of}"),
    }
