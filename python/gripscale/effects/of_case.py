"""What each effect is worth in a case: of its chain, and of the direct contact of its surface."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale import netcdf
from gripscale.case.results import CaseResults
from gripscale.effects.effects import effect_tasks, effects
from gripscale.errors import FileError
from gripscale.model import Model
from gripscale.study.conditioned import ALL, effects_asked
from gripscale.study.store import Store
from gripscale.study.threads import OnTask

FILE = "effects_{model}.nc"
"""What they are kept in, beside the result."""


def case_effects(
    results: CaseResults,
    model: Model,
    folder: str | Path,
    store: str | Path,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset | None:
    """Return what each effect is worth in a sliding case, and write it into `folder`.

    Parameters
    ----------
    results : CaseResults
        The case; a prediction it has already is not solved again.
    model : Model
        With the conditions of the case.
    folder : path
        Gets `effects_<model>.nc`.
    store : path
        Keeps the finished predictions.
    workers, client, on_task
        As for `gripscale.study.solve_all`.

    Returns
    -------
    xarray.Dataset or None
        As `effects`; None of a case at rest, or whose conditions do nothing to the rubber.

    Raises
    ------
    FileError
        If a result cannot be written.
    """
    asked, load = effects_asked(model), results.load
    if not asked or load.speed == 0.0:
        return None
    given = (model, results.rubber.rubber, results.surface, load)
    if model == results.chain and results.dynamic is not None and results.dynamic.converged:
        key = effect_tasks(*given)[ALL].key
        solved = results.dynamic.to_dataset().assign_attrs(prediction_key=key)
        Store(store).put(key, solved)
    found = effects(*given, folder=store, workers=workers, client=client, on_task=on_task)
    found = found.assign_attrs(case=results.file.text)
    netcdf.save(found, Path(folder) / FILE.format(model=model.name))
    return found


def stored_effects(folders: Iterable[Path], case: object) -> list[xr.Dataset]:
    """Return what the first of `folders` that has effects of this text of a case keeps."""
    for folder in folders:
        found = []
        for path in sorted(folder.glob(FILE.format(model="*"))):
            try:
                found.append(netcdf.load(path))
            except FileError:
                continue
        same = [one for one in found if one.attrs.get("case") == case]
        if same:
            return same
    return []
