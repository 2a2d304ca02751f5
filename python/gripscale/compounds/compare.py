"""Compounds on the same road under the same load, with their differences and what makes them.

Differences are those to the first compound. What each DMA leaves open is the range of the totals
over all series that fit it as well as the best one does (`Rubber.admissible_rubbers`),

    low = X min(1, X_k/X_0),    high = X max(1, X_k/X_0)

with X_k of series k and X_0 of the best one solved as half-planes, which cost less, and X of the
best one by the model of the case. The DMAs are independent of each other, see
`gripscale.differences`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import netcdf
from gripscale.case.read import CaseFile, read_case
from gripscale.chain.model import Chain
from gripscale.compounds.one_temperature import at_one_temperature
from gripscale.differences import (
    TOTALS,
    attributes,
    ranges,
    require_some,
    to_first,
    total_differences,
)
from gripscale.rubber import Rubber
from gripscale.study.inputs import rubber_of
from gripscale.study.store import PREDICTIONS, Store
from gripscale.study.study import Study
from gripscale.study.task import Task
from gripscale.study.threads import OnTask, solve_all
from gripscale.theory.half_plane import HalfPlane

RESULT = "compounds.nc"
POINTS = 128
"""Points of the half-planes that tell the range: only ratios of theirs count."""


@dataclass(frozen=True)
class Compounds:
    """Compounds that were compared."""

    rubbers: dict[str, Rubber]
    """The rubbers as they were solved, at one temperature."""
    notes: tuple[str, ...]
    """What is to be said of their temperatures."""
    data: xr.Dataset
    """A study over `rubber`, with ranges and differences; kept in compounds.nc."""


def compare_compounds(
    case: CaseFile | str | Path,
    rubbers: Mapping[str, Any],
    folder: str | Path,
    *,
    temperature: float | None = None,
    uncertainty: bool = True,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Compounds:
    """Predict area and friction of several compounds on the road of a case, and compare them.

    Parameters
    ----------
    case
        The case, or its file: surface, load, solver and conditions are taken from it.
    rubbers
        Two to six compounds by what they are called; the others are compared with the first. Each
        is a `Rubber`, "case", a rubber known by name, another case, or a file of moduli, read with
        what the case says of its own where it does not say itself.
    folder
        Gets predictions and `compounds.nc`; what it has already is not solved again.
    temperature : float, optional
        Where they are compared [K]; by default the temperature of the case's conditions, or one
        all of them have or can be shifted to.
    uncertainty : bool
        Whether the range that each DMA leaves open is predicted: some fifty half-planes each.
    workers, on_task
        As for `gripscale.study.solve_all`; `on_task` is not told of those half-planes.

    Returns
    -------
    Compounds
        Over `rubber`: the totals, `total_friction_low` and so on, `..._difference` to the first
        with its `_low` and `_high`; by wave `friction_running`, from the largest wave down, and
        `friction_difference`; by decade of relaxation time `friction_by_decade_difference`.

    Raises
    ------
    InputError, FileError
        If there are fewer than two or more than six compounds, one cannot be read, or they cannot
        be brought to one temperature.
    """
    require_some("rubbers", rubbers, "compounds")
    file = case if isinstance(case, CaseFile) else read_case(case)
    given = {name: rubber_of(value, file) for name, value in rubbers.items()}
    if temperature is None:
        temperature = file.case.conditions.temperature
    together, notes = at_one_temperature(given, temperature)
    study = Study(file, {"rubber": together}, static=False)
    data = study.run(folder, workers=workers, on_task=on_task)
    if uncertainty:
        data = data.assign(_ranges(study, data, Path(folder), workers))
    data = data.assign(_differences(data)).assign_attrs(notes="\n".join(notes))
    return Compounds(together, notes, netcdf.load(netcdf.save(data, Path(folder) / RESULT)))


def _ranges(study: Study, data: xr.Dataset, folder: Path, workers: int | None) -> dict[str, Any]:
    """Return the lowest and highest totals of each compound over its admissible series."""
    assert isinstance(study.model, Chain)
    load = study.file.case.load.nominal
    model = replace(study.model, solver=HalfPlane(points=POINTS))
    tasks = {
        (name, i): Task(rubber, study.surfaces[0], load, model)
        for name, best in zip(data.rubber.values.tolist(), study.rubbers, strict=True)
        for i, rubber in enumerate([best, *best.admissible_rubbers()])
    }
    labels = {f"{name}, series {i}": task for (name, i), task in tasks.items()}
    solved = solve_all(labels, Store(folder / PREDICTIONS), workers=workers)
    found: dict[str, Any] = {}
    for quantity in TOTALS:
        ends = np.full((2, data.sizes["rubber"]), np.nan)
        for at, name in enumerate(data.rubber.values.tolist()):
            each = [float(solved[t.key][quantity]) for (n, _), t in tasks.items() if n == name]
            ratio = np.array(each[1:]) / each[0]
            if np.isfinite(ratio).any():
                ends[:, at] = np.nanmin([*ratio, 1.0]), np.nanmax([*ratio, 1.0])
        found[quantity] = ends
    return ranges(data, ["rubber"], found, "that the measured moduli leave open")


def _differences(data: xr.Dataset) -> dict[str, Any]:
    """Return what differs from the first compound."""
    out: dict[str, Any] = dict(total_differences(data, "rubber"))
    if "scale" in data.dims:
        friction = data.friction.transpose("rubber", "scale")
        text = "friction coefficient of this and all larger waves"
        running = friction.values.cumsum(axis=1)
        out["friction_running"] = (("rubber", "scale"), running, attributes(text))
        text = "difference to the first compound, friction coefficient of the wave"
        out["friction_difference"] = to_first(friction, "rubber", text)
    if "friction_by_decade" in data:
        parts = data.friction_by_decade.transpose("rubber", "decade")
        text = "difference to the first compound, friction coefficient by relaxation time"
        out["friction_by_decade_difference"] = to_first(parts, "rubber", text)
    return out
