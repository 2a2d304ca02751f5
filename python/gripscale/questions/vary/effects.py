"""The answer of a model under all its conditions, without each effect in turn, and without any.

    change by an effect = answer with all effects / answer without it - 1

The area term, which changes the rubber by its heat only, has no answer of its own.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.case import Case
from gripscale.chain.prediction import ChainResult
from gripscale.core import InputError, provenance
from gripscale.experiment.design import (
    CHANGES,
    WITH_AREA_TERM,
    Design,
    Point,
    solve_design,
    variable_attributes,
)
from gripscale.experiment.solve import Bench, OnTask
from gripscale.experiment.task import Store, Task, load_stored
from gripscale.io import netcdf
from gripscale.model import (
    ADHESIVE_FRICTION,
    OUTSIDE_BAND,
    STATUS,
    STATUS_WORD,
    TOTALS,
    Load,
    Model,
)
from gripscale.questions.vary import inputs
from gripscale.rubber import Rubber
from gripscale.surface import Surface

_KEPT = (*TOTALS, ADHESIVE_FRICTION, *OUTSIDE_BAND, STATUS, STATUS_WORD, "prediction_key")


def effect_tasks(model: Model, rubber: Rubber, surface: Surface, load: Load) -> dict[str, Task]:
    """Return what has to be solved, by the effects that count: "all", "no heat", ..., "none".

    Raises `InputError` if the model has no conditions, its conditions do nothing to the rubber, or
    the rubber has no shift to the temperature they state.
    """
    asked = inputs.effects_asked(model)
    if not asked:
        raise InputError(
            "effects need conditions with a temperature, softening or heat; got none with the "
            f"model {model.name}"
        )
    tasks = {}
    for selection in (inputs.ALL_EFFECTS, *(f"no {effect}" for effect in asked), inputs.NO_EFFECTS):
        changed = inputs.with_effects(model, selection)
        inputs.rubber_before(rubber, changed)  # nothing is solved if one of them is impossible
        tasks[selection] = Task(rubber, surface, load, changed)
    return tasks


def effects(
    model: Model,
    rubber: Rubber,
    surface: Surface,
    load: Load,
    *,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset:
    """Return what each effect of the conditions of a model is worth.

    Over `effect`: "all", "no" each effect that was asked for, "none": the totals of the model,
    friction with the area term if there is one, `prediction_status`, and the changes by what was
    left out [-], which are NaN for "all" and where one of both did not converge.

    `model` has conditions, such as `Chain(conditions=...)` or `DirectContact(conditions=...)`. A
    `folder` keeps the finished predictions, and shares them with a study or a comparison there.
    Other arguments are those of `Model.predict` and `gripscale.experiment.Bench`. Raises
    `InputError` as `effect_tasks`, and for an input that cannot be used; `FileError` if a result
    cannot be written.
    """
    tasks = effect_tasks(model, rubber, surface, load)
    points = [Point((at,), *task) for at, task in enumerate(tasks.items())]
    coords = {"effect": ("effect", list(tasks), variable_attributes("effects that count"))}
    bench = Bench(None if folder is None else Store(folder), workers, client, on_task)
    data = solve_design(Design({"effect": len(tasks)}, points, coords), bench)
    data = data[[name for name in _KEPT if name in data]]
    if ADHESIVE_FRICTION in data:
        both = data.total_friction + data[ADHESIVE_FRICTION]
        words = "friction coefficient of hysteresis and area term together"
        data = data.assign({WITH_AREA_TERM: both.assign_attrs(variable_attributes(words))})
    for name, change in CHANGES.items():
        if name in data:
            relative = data[name].sel(effect=inputs.ALL_EFFECTS, drop=True) / data[name] - 1.0
            words = f"what the effects left out change in {data[name].attrs['long_name']}"
            relative = relative.where(data.effect != inputs.ALL_EFFECTS)
            data[change] = relative.assign_attrs(variable_attributes(words))
    return data.assign_attrs(
        {
            "title": "What each effect of the conditions is worth",
            "model": model.name,
            "conditions": json.dumps(inputs.conditions_of(model).to_dict()),
            "rubber": f"{rubber.name}; {rubber.source}".strip("; "),
            "surface": surface.source,
            "nominal_pressure": load.pressure,
            "nominal_speed": load.speed,
            "footprint": load.footprint,
            "load_time": str(load.load_time),
            **provenance.version_attributes(),
        }
    )


EFFECTS_FILE = "effects_{model}.nc"  # what they are kept in, beside the result


def case_effects(
    case: Case,
    model: Model,
    folder: str | Path,
    store: str | Path,
    *,
    dynamic: ChainResult | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset | None:
    """Return what each effect is worth in a sliding case, and write it into `folder`.

    As `effects`; None of a case at rest, or whose conditions do nothing to the rubber. `model` has
    the conditions of the case; `folder` gets `effects_<model>.nc`, `store` keeps the finished
    predictions. `dynamic` is the chain of the sliding case, where it is solved already. Raises
    `FileError` if a result cannot be written.
    """
    if not inputs.effects_asked(model) or case.load.speed == 0.0:
        return None
    setup = (model, case.rubber, case.surface, case.load)
    if model == case.chain and dynamic is not None and dynamic.converged:
        key = effect_tasks(*setup)[inputs.ALL_EFFECTS].key
        solved = dynamic.to_dataset().assign_attrs(prediction_key=key)
        Store(store).put(key, solved)
    data = effects(*setup, folder=store, workers=workers, client=client, on_task=on_task)
    data = data.assign_attrs(case.attributes)
    netcdf.save(data, Path(folder) / EFFECTS_FILE.format(model=model.name))
    return data


def stored_effects(folders: Iterable[Path], case: object) -> list[xr.Dataset]:
    """Return what the first of `folders` that has effects of this text of a case keeps."""
    for folder in folders:
        stored = map(load_stored, sorted(folder.glob(EFFECTS_FILE.format(model="*"))))
        same = [data for data in stored if data is not None and data.attrs.get("case") == case]
        if same:
            return same
    return []
