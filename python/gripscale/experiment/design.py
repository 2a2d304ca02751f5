"""A design: labelled dimensions with a task at each point, solved into one Dataset.

A point may be missing, refused (a sentence says why there is no task) or repeated: equal tasks are
solved once. The Dataset holds missing values where there is no answer.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.core import InputError
from gripscale.experiment.solve import Bench, Pick
from gripscale.experiment.task import Task

Index = tuple[int, ...]

CONVERGED = "converged"  # status of an answer whose numbers may be used

# All an answer says of the whole surface.
SURFACE = (
    *(*model.TOTALS, model.ADHESIVE_FRICTION, *model.OUTSIDE_BAND, *model.CUT_OFF_EXPONENTS),
    *(model.WHY_NO_EXPONENT, model.STATUS, model.STATUS_WORD),
)


@dataclass(frozen=True)
class Point:
    """One point of a design."""

    index: Index
    """Position along each dimension."""
    label: str
    """Name of the task while it is solved; different from all others."""
    task: Task


@dataclass(frozen=True, eq=False)
class Design:
    """Labelled dimensions with a task at each point."""

    sizes: Mapping[str, int]
    """Dimensions in order, with their sizes."""
    points: Sequence[Point]
    """In the order in which they are solved."""
    coords: Mapping[str, Any] = field(default_factory=dict)
    """Coordinates of the Dataset, as xarray takes them."""
    refused: Mapping[Index, str] = field(default_factory=dict)
    """Why there is no task at a point."""

    @property
    def tasks(self) -> dict[str, Task]:
        """The tasks by label."""
        return {point.label: point.task for point in self.points}

    def dataset(self, answers: Mapping[str, xr.Dataset]) -> xr.Dataset:
        """Return the answers, given by the keys of their tasks, over the dimensions.

        With status (of a refused point the refusal), its word, key and `seconds` of each point.
        """
        shape = tuple(self.sizes.values())
        status, words, keys = (np.full(shape, "", dtype=object) for _ in range(3))
        seconds = np.full(shape, math.nan)
        parts: dict[Index, xr.Dataset] = {}
        for index, refusal in self.refused.items():
            status[index] = refusal
        statuses = [model.STATUS, model.STATUS_WORD]
        for point in self.points:
            key = point.task.key
            answer = answers[key]
            parts[point.index] = answer.drop_vars(statuses, errors="ignore")
            status[point.index] = str(answer[model.STATUS].item())
            words[point.index] = str(model.status_words(answer).item())
            keys[point.index] = key
            seconds[point.index] = answer.attrs.get("seconds", math.nan)
        dims = tuple(self.sizes)
        kept_in = variable_attributes("name of the file the prediction is kept in")
        data = stack(parts, self.sizes).assign(
            prediction_status=(dims, status, variable_attributes("converged, or why not")),
            prediction_status_word=(dims, words, variable_attributes("word of the status")),
            prediction_key=(dims, keys, kept_in),
            seconds=(dims, seconds, variable_attributes("time to solve the prediction", "s")),
        )
        return data.assign_coords(self.coords)


def variable_attributes(long_name: str, unit: str = "1") -> dict[str, str]:
    """Return the attributes of a variable."""
    return {"units": unit, "long_name": long_name}


def surface_numbers(answer: xr.Dataset, _: Task) -> xr.Dataset:
    """Return what an answer says of the whole surface."""
    return answer[[name for name in SURFACE if name in answer]]


def error_of_total(data: xr.Dataset, name: str) -> float:
    """Return the error of a total as its model estimates it: of profiles by weight, of waves added.

    `name` is `contact_fraction` or `friction`; NaN where the model has no estimate. Waves: their
    relative errors add up in the product of areas, their errors in the sum of frictions; all in the
    same direction, because the same mesh makes them.
    """
    errors = data.get(f"{name}_error")
    if errors is None:
        return math.nan
    values = np.abs(errors.values)
    if errors.dims == ("profile",):
        return float(data["weight"].values @ values)
    if errors.dims == ("scale",):
        relative = name == "contact_fraction"
        parts = values / data[name].values if relative else values
        return float(parts.sum() * (data[f"total_{name}"] if relative else 1.0))
    return float(values)


_TOTALS_WITH_ERRORS = {"contact_fraction": "contact fraction", "friction": "friction coefficient"}


def basis_numbers(answer: xr.Dataset) -> xr.Dataset:
    """Return what an answer from a measured surface rests on, with its estimated errors.

    Nothing where the model does not tell.
    """
    if not set(model.BASIS) <= set(answer):
        return xr.Dataset()
    errors = {}
    for name, words in _TOTALS_WITH_ERRORS.items():
        attrs = variable_attributes(f"error of the {words} as the model estimates it")
        errors[f"total_{name}_error"] = ((), error_of_total(answer, name), attrs)
    return answer[[*model.BASIS]].assign(errors)


def solve_design(design: Design, bench: Bench, pick: Pick = surface_numbers) -> xr.Dataset:
    """Return the answers of a design, solved on a bench, over its dimensions.

    `pick` reduces an answer, with its task, to a Dataset of what is stacked, with
    `prediction_status`. Raises `InputError` or `FileError` as `Bench.solve`.
    """
    return design.dataset(bench.solve(design.tasks, pick))


def stack(parts: Mapping[Index, xr.Dataset], sizes: Mapping[str, int]) -> xr.Dataset:
    """Return Datasets, by their positions, over further dimensions.

    A dimension of the parts is aligned by its coordinate or, without one, from its beginning. What
    a part does not have is NaN, or empty text.
    """
    labels: dict[str, xr.Variable] = {}
    lengths: dict[str, int] = {}
    for dim in dict.fromkeys(str(dim) for part in parts.values() for dim in part.dims):
        lengths[dim] = max(part.sizes.get(dim, 0) for part in parts.values())
        coordinates = [part.variables[dim] for part in parts.values() if dim in part.coords]
        if coordinates:
            values = np.unique(np.concatenate([variable.values for variable in coordinates]))
            labels[dim] = xr.Variable(dim, values, coordinates[0].attrs)
            lengths[dim] = values.size
    data: dict[str, xr.Variable] = {}
    for name in dict.fromkeys(str(name) for part in parts.values() for name in part.variables):
        if name in labels:
            continue
        variables = {at: part.variables[name] for at, part in parts.items() if name in part}
        example = next(iter(variables.values()))
        inner = tuple(str(dim) for dim in example.dims)
        shape = (*sizes.values(), *(lengths[dim] for dim in inner))
        filled = sum(variable.size for variable in variables.values()) == math.prod(shape)
        fill: Any = "" if example.dtype.kind in "OUST" else math.nan
        kinds = {variable.dtype for variable in variables.values()}
        dtype: Any = object
        if fill != "":
            dtype = np.result_type(*kinds, *([] if filled else [np.float64]))
        values = np.empty(shape, dtype) if filled else np.full(shape, fill, dtype)
        for at, variable in variables.items():
            positions = [
                np.searchsorted(labels[dim].values, parts[at][dim].values)
                if dim in labels
                else np.arange(variable.sizes[dim])
                for dim in inner
            ]
            where: Any = (*at, *np.ix_(*positions))
            values[where] = variable.transpose(*inner).values if inner else variable.values.item()
        data[name] = xr.Variable((*sizes, *inner), values, example.attrs)
    return xr.Dataset(data, labels)


OF_THE_CASE = "case"  # what stands for the surface or the rubber of the case itself


def named_values(name: str, value: Any) -> tuple[tuple[Any, ...], tuple[str, ...]]:
    """Return values and labels of varied rubbers or surfaces: a mapping, or texts and paths.

    Raises `InputError` for anything else.
    """
    if isinstance(value, Mapping):
        return tuple(value.values()), tuple(str(label) for label in value)
    if isinstance(value, str):
        entries = value.split(",")
    else:
        entries = [*value] if isinstance(value, Iterable) else [value]
    for entry in entries:
        if not isinstance(entry, str | Path):
            raise InputError(
                f"{name} must be names and files, or a mapping from names; got {entry!r:.60}"
            )
    texts = [str(entry).strip() for entry in entries]
    stems = tuple(Path(text).stem for text in texts)
    return tuple(texts), stems if len(set(stems)) == len(stems) else tuple(texts)
