"""Compounds on the same road under the same load, with their differences and what makes them.

Differences are those to the first compound. What each DMA leaves open is the range of the totals
over all series that fit it as well as the best one does (`Rubber.admissible_rubbers`),

    low = X min(1, X_k/X_0),    high = X max(1, X_k/X_0)

with X_k of series k and X_0 of the best one solved as half-planes, which cost less, and X of the
best one by the model of the case. The DMAs are independent of each other, see
`total_differences`.

What is to be believed are the best estimates of the direct contact where the road was measured, and
their ratios to the first (`ratios_to_first`). The road is the same for all, and the step from its
lines to a surface cancels but for its change with the load, which here is that with the contact
area. Ratios of single profiles scatter about as much as the numbers themselves, so that the
sampling of the road does not cancel. The truth is taken to lie evenly between the ends of a range.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.core.errors import InputError
from gripscale.core.units import celsius
from gripscale.experiment.design import Design, Point, solve_design, variable_attributes
from gripscale.experiment.solve import Bench, OnTask, bench_in
from gripscale.experiment.task import Task
from gripscale.half_space.line_to_map import LOAD_SENSITIVITY
from gripscale.half_space.model import DirectContact
from gripscale.model import input_doubts
from gripscale.questions.answer.best_estimate import POINT_ESTIMATES, with_best_estimate
from gripscale.questions.vary.inputs import TEMPERATURE, measured_rubber_of, reading_notes
from gripscale.questions.vary.side_by_side import Compounds
from gripscale.questions.vary.study import Study
from gripscale.rubber import Rubber, temperature_doubts
from gripscale.theory.half_plane import HalfPlane

_SAME = 0.5
"""Temperatures that differ by less are one [K]: 20 °C and 293 K."""


def at_one_temperature(
    rubbers: Mapping[str, Rubber], temperature: float | None = None
) -> tuple[dict[str, Rubber], tuple[str, ...]]:
    """Return rubbers that hold for one temperature, and what is to be said of that.

    Without a `temperature` it is that of the rubbers which cannot be shifted, or else of the first
    that states one. A rubber whose temperature is not known stays as it is, which is said.

    Returns the rubbers, and a sentence for each that was shifted and for what is doubtful (see
    `gripscale.rubber.temperature_doubts`). Raises `InputError` if a rubber would have to be shifted
    and has no shift.

    Parameters
    ----------
    rubbers
        The rubbers by what they are called.
    temperature : float, optional
        Where they are wanted [K].
    """
    temperatures = {
        name: rubber.reference_temperature
        for name, rubber in rubbers.items()
        if rubber.reference_temperature is not None
    }
    wanted = temperature
    if wanted is None:
        fixed = {name: t for name, t in temperatures.items() if rubbers[name].shift is None}
        if fixed and max(fixed.values()) - min(fixed.values()) > _SAME:
            each = ", ".join(
                f"{name} for {celsius(kelvin, '.1f')}" for name, kelvin in fixed.items()
            )
            raise InputError(
                "compounds must hold for one temperature, or have a shift to it; got "
                f"{each} without one"
            )
        wanted = next(iter((fixed or temperatures).values()), None)
    if wanted is None:
        return dict(rubbers), temperature_doubts(rubbers)
    together, shifted = {}, []
    for name, rubber in rubbers.items():
        before = temperatures.get(name)
        if before is None or abs(before - wanted) <= _SAME:
            together[name] = rubber
            continue
        if rubber.shift is None:
            raise InputError(
                f"{name} holds for {celsius(before, '.1f')} and cannot be brought to "
                f"{celsius(wanted, '.1f')}: "
                "give it a shift, or leave it out"
            )
        together[name] = rubber.at(wanted)
        shifted.append(f"{name} shifted from {celsius(before, '.1f')} to {celsius(wanted, '.1f')}")
    return together, (*shifted, *temperature_doubts(together))


FEWEST, _MOST = 2, 6
_TOTALS = ("total_friction", "total_contact_fraction")
ENDS = ("low", "high")
NORMAL = 1.645
"""Half width of a 90 % interval over a standard error."""
EVEN = NORMAL / math.sqrt(3.0)
"""Half width of a 90 % interval over that of a range which holds the truth evenly."""


def require_some(name: str, mapping: Mapping[str, Any], what: str) -> None:
    """Raise `InputError` unless there are two to six things to be compared."""
    if not FEWEST <= len(mapping) <= _MOST:
        raise InputError(
            f"{name} must be {FEWEST} to {_MOST} {what} to be compared; got {len(mapping)}"
        )


def total_differences(data: xr.Dataset, dim: str) -> dict[str, xr.DataArray]:
    """Return `total_friction_difference` and so on to the first along `dim`.

    With its `_low` and `_high` where `data` has those of the totals: of totals between low and
    high, all independent of each other, a difference to the first is between low - high of the
    first, and high - low of the first.
    """
    out = {}
    for quantity in _TOTALS:
        what = f"difference to the first, {data[quantity].attrs['long_name']}"
        out[f"{quantity}_difference"] = to_first(data[quantity], dim, what)
        if f"{quantity}_low" not in data:
            continue
        low, high = (data[f"{quantity}_{end}"] for end in ("low", "high"))
        first = xr.zeros_like(data[dim], dtype=bool)
        first[0] = True
        for end, ends in (("low", low - high.isel({dim: 0})), ("high", high - low.isel({dim: 0}))):
            name = f"{quantity}_difference_{end}"
            out[name] = ends.where(~first, 0.0).assign_attrs(
                variable_attributes(f"{end}est {what}")
            )
    return out


def to_first(values: xr.DataArray, dim: str, long_name: str) -> xr.DataArray:
    """Return the difference of `values` [-] to the first along `dim`."""
    return (values - values.isel({dim: 0}, drop=True)).assign_attrs(variable_attributes(long_name))


COMPARED_QUANTITIES = ("friction", "contact_fraction")


def ratios_to_first(
    data: xr.Dataset,
    dim: str,
    widths: Mapping[str, tuple[xr.DataArray, xr.DataArray]] | None = None,
) -> dict[str, xr.DataArray]:
    """Return `friction_ratio` and so on: the best there is over that of the first along `dim`.

    With the ends `_low` and `_high` of its 90 % interval, from the `widths`, down and up, of those
    of the logarithms, which are independent of each other.
    """
    out = {}
    for name in COMPARED_QUANTITIES:
        best = f"best_{name}" if f"best_{name}" in data else f"total_{name}"
        value = data[best].where(data[best] > 0.0)
        ratio = value / value.isel({dim: 0}, drop=True)
        text = f"over that of the first, {data[best].attrs['long_name']}"
        out[f"{name}_ratio"] = ratio.assign_attrs(variable_attributes(text))
        if widths is None:
            continue
        first = xr.zeros_like(data[dim], dtype=bool)
        first[0] = True
        down, up = widths[name]
        # a ratio is low where the number is low and that of the first is high
        for end, sign, width, other in (("low", -1.0, down, up), ("high", 1.0, up, down)):
            size = (width**2 + other.isel({dim: 0}, drop=True) ** 2) ** 0.5
            values = ratio * size.copy(data=np.exp(sign * size.values))
            out[f"{name}_ratio_{end}"] = (
                values.where(~first, 1.0)
                .reset_coords(drop=True)
                .assign_attrs(variable_attributes(f"{end} end of the 90 % interval, {text}"))
            )
    return out


def log(values: xr.DataArray) -> xr.DataArray:
    """Return the natural logarithm."""
    return values.copy(data=np.log(values.values))


def ranges(
    data: xr.Dataset, ends: Mapping[str, tuple[xr.DataArray, xr.DataArray]], text: str
) -> dict[str, xr.DataArray]:
    """Return `total_friction_low` and so on: totals times the `ends` of each, low and high."""
    return {
        f"{quantity}_{end}": (data[quantity] * factor).assign_attrs(
            variable_attributes(f"{end}est {data[quantity].attrs['long_name']} {text}")
        )
        for quantity, factors in ends.items()
        for end, factor in zip(("low", "high"), factors, strict=True)
    }


_POINTS = 128
"""Points of the half-planes that tell the range: only ratios of theirs count."""


def compare_compounds(
    case: Case,
    rubbers: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    temperature: float | None = None,
    uncertainty: bool = True,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Compounds:
    """Predict area and friction of several compounds on the road of a case, and compare them.

    Raises `InputError` or `FileError` if there are fewer than two or more than six compounds, one
    cannot be read, or they cannot be brought to one temperature.

    Parameters
    ----------
    case
        The case, or its file: surface, load, solver and conditions are taken from it.
    rubbers
        Two to six compounds by what they are called; the others are compared with the first. Each
        is a `Rubber`, "case", a rubber known by name, another case, or a file of moduli, read with
        what the case says of its own where it does not say itself.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    temperature : float, optional
        Where they are compared [K]; by default the temperature of the case's conditions, or one
        all of them have or can be shifted to.
    uncertainty : bool
        Whether the range that each DMA leaves open is predicted: some fifty half-planes each.
    workers, on_task
        As for `gripscale.experiment.solve_all`; `on_task` is not told of those half-planes.

    Returns
    -------
    Compounds
        Over `rubber`: the totals of the chain, `total_friction_low` and so on, `..._difference` to
        the first with its `_low` and `_high`; the best estimates `best_friction` and so on
        (`gripscale.questions.with_best_estimate`) where the road was measured, and `friction_ratio`
        to the first and so on, with its `_low` and `_high`; by wave `friction_running`, from the
        largest wave down, and `friction_difference`; by decade of relaxation time
        `friction_by_decade_difference`.
    """
    require_some("rubbers", rubbers, "compounds")
    measured = {name: measured_rubber_of(value, case) for name, value in rubbers.items()}
    if temperature is None and case.conditions is not None:
        temperature = case.conditions.temperature
    compounds = {name: each.rubber for name, each in measured.items()}
    together, notes = at_one_temperature(compounds, temperature)
    notes = (*reading_notes(rubbers.values()), *notes)
    vary = {"rubber": together}
    believed = Study(case, vary, static=False)
    best = None
    if isinstance(believed.model, DirectContact):
        best = believed.run(folder, workers=workers, on_task=_of_model(believed, on_task))
    # its file stays beside the result
    study = Study(case, vary, static=False, model=Chain.name)
    data = study.run(folder, workers=workers, on_task=_of_model(study, on_task))
    if uncertainty:
        with bench_in(folder, workers) as bench:
            data = data.assign(_ranges(study, data, bench))
    data = data.assign(_believed(data if best is None else with_best_estimate(best), data))
    loads = [point.task.load for point in study.points]
    data = data.assign(_differences(data)).assign_attrs(
        input_doubts([*study.surfaces, *measured.values()], loads, case.units),
        notes="\n".join(notes),
    )
    kelvins = [rubber.reference_temperature for rubber in together.values()]
    if kelvins[0] is not None and len({*kelvins}) == 1:
        data = data.assign_attrs({TEMPERATURE: kelvins[0]})
    return Compounds(data)


def _of_model(study: Study, on_task: OnTask | None) -> OnTask | None:
    """Return `on_task`, told of the model that predicts."""
    if on_task is None:
        return None
    name = study.model.name
    return lambda progress: on_task(replace(progress, label=f"{name}, {progress.label}"))


def _believed(best: xr.Dataset, data: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the best estimates of the compounds, and the ratios to the first that are believed."""
    names = [str(name) for name in best if name in POINT_ESTIMATES]
    widths = None
    if f"{_TOTALS[0]}_low" in data:
        widths = {name: _widths(best, data, name) for name in COMPARED_QUANTITIES}
    return {name: best[name] for name in names} | ratios_to_first(best, "rubber", widths)


def _widths(best: xr.Dataset, data: xr.Dataset, name: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the half widths, down and up, of the 90 % interval of a logarithm.

    From what the DMA leaves open, without which they are NaN; of the direct contact also from its
    grid, the sampling of the road and the change of the step to a surface with the contact area.
    """
    total = data[f"total_{name}"]
    down, up = (log(data[f"total_{name}_{end}"] / total) ** 2 for end in ENDS)
    if f"best_{name}" not in best:
        return EVEN * down**0.5, EVEN * up**0.5
    grid = (best[f"total_{name}_error"] / best[f"total_{name}"]).fillna(0.0)
    area = best["total_contact_fraction"]
    step = LOAD_SENSITIVITY * log(area / area.isel(rubber=0, drop=True))
    even = EVEN**2 * (grid**2 + step**2)
    rest = even + (NORMAL * best[f"best_{name}_sampling_error"]) ** 2
    return (EVEN**2 * down + rest) ** 0.5, (EVEN**2 * up + rest) ** 0.5


def _ranges(study: Study, data: xr.Dataset, bench: Bench) -> dict[str, xr.DataArray]:
    """Return the lowest and highest totals of each compound over its admissible series."""
    load = study.case.load
    model = replace(study.case.chain, solver=HalfPlane(points=_POINTS))
    points = [
        Point((at, i), f"{name}, series {i}", Task(rubber, study.surfaces[0], load, model))
        for at, (name, best) in enumerate(zip(data.rubber.values, study.rubbers, strict=True))
        for i, rubber in enumerate([best, *best.admissible_rubbers()])
    ]
    sizes = {"rubber": data.sizes["rubber"], "series": 1 + max(p.index[1] for p in points)}
    solved = solve_design(Design(sizes, points, {"rubber": data.rubber}), bench)
    ratio = solved[list(_TOTALS)] / solved[list(_TOTALS)].isel(series=0)
    ratio = ratio.where(ratio.count("series") > 1)  # the best series alone gives no range
    ends = {name: (ratio[name].min("series"), ratio[name].max("series")) for name in _TOTALS}
    return ranges(data, ends, "that the measured moduli leave open")


def _differences(data: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return what differs from the first compound."""
    out = total_differences(data, "rubber")
    if "scale" in data.dims:
        friction = data.friction.transpose("rubber", "scale")
        running = friction.copy(data=friction.values.cumsum(axis=1))
        running.attrs = variable_attributes("friction coefficient of this and all larger waves")
        out["friction_running"] = running
        text = "difference to the first compound, friction coefficient of the wave"
        out["friction_difference"] = to_first(friction, "rubber", text)
    if "friction_by_decade" in data:
        parts = data.friction_by_decade.transpose("rubber", "decade")
        text = "difference to the first compound, friction coefficient by relaxation time"
        out["friction_by_decade_difference"] = to_first(parts, "rubber", text)
    return out
