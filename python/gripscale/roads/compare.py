"""Roads under the same rubber and load, in chain and direct contact, with their differences.

Differences are those to the first road. What another stretch of each road might have given is the
range of 90 % of n block bootstraps of its profiles (`gripscale.uncertainty.ProfileBlocks`),

    low = X min(1, q_5(X_k/X_0)),    high = X max(1, q_95(X_k/X_0))

with X_k of the drawn blocks and X_0 of the road as measured; of the chain by half-planes, which
cost less, of the direct contact by itself. The roads are independent of each other, see
`gripscale.differences`.
"""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale import checks, netcdf, versions
from gripscale.case.read import CaseFile, read_case
from gripscale.chain.model import Chain
from gripscale.differences import require_some
from gripscale.errors import InputError
from gripscale.model import Model, NominalLoad
from gripscale.roads.dataset import AS_MEASURED, MODELS, TO_COMPARE, Place, roads_dataset
from gripscale.rough.model import DirectContact
from gripscale.study.inputs import case_rubber, surface_of
from gripscale.study.models import model_of
from gripscale.study.store import PREDICTIONS, Store
from gripscale.study.task import Task
from gripscale.study.threads import OnTask, solve_all
from gripscale.surface import PreparedSurface
from gripscale.surface.named import SYNTHETIC_SURFACES, with_profile
from gripscale.theory.half_plane import HalfPlane
from gripscale.uncertainty.attempt import Attempt
from gripscale.uncertainty.design import draws
from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.sources.profile import ProfileSource
from gripscale.uncertainty.sources.source import Stated

RESULT = "surfaces.nc"
POINTS = 128
"""Points of the half-planes that tell the range: only ratios of theirs count."""
FEWEST_SAMPLES, MOST_SAMPLES = 10, 10_000
SAMPLES = 20
SEED = 0


@dataclass(frozen=True)
class Roads:
    """Roads that were compared."""

    surfaces: dict[str, PreparedSurface]
    """The roads as they were solved."""
    notes: tuple[str, ...]
    """Why a road has no range, or no direct contact."""
    data: xr.Dataset
    """Over `model` and `surface`; kept in surfaces.nc."""


def compare_surfaces(
    case: CaseFile | str | Path,
    surfaces: Mapping[str, Any],
    folder: str | Path,
    *,
    samples: int | None = SAMPLES,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Roads:
    """Predict area and friction of a case's rubber on several roads, and compare them.

    Parameters
    ----------
    case
        The case, or its file: rubber, load, solver and conditions are taken from it.
    surfaces
        Two to six roads by what they are called; the others are compared with the first. Each is a
        `PreparedSurface`, a `SineStack`, "case", a surface known by name, another case, or a
        profile (of a case on a map, a map), read with all other settings of the case.
    folder
        Gets predictions and `surfaces.nc`; what it has already is not solved again.
    samples : int or None
        Block bootstraps of each road, 10 to 10 000, for the range of its totals; None: no ranges.
    workers, on_task
        As for `gripscale.study.solve_all`.

    Returns
    -------
    Roads
        Over `model` and `surface`: the totals, `total_friction_low` and so on, `..._difference` to
        the first with its `_low` and `_high`; over `octave` of wavelength `friction_running`, from
        the longest wave down, and `friction_difference`; `correlation` over `lag` and `spectrum`
        over `wavenumber`.

    Raises
    ------
    InputError, FileError
        If there are fewer than two or more than six roads, or one cannot be read.
    """
    require_some("surfaces", surfaces, "roads")
    if samples is not None:
        checks.whole("samples", samples, least=FEWEST_SAMPLES, most=MOST_SAMPLES)
    file = case if isinstance(case, CaseFile) else read_case(case)
    given = {name: _surface(value, file) for name, value in surfaces.items()}
    load = file.case.load.nominal
    rubber, models = case_rubber(file), [_model(name, file) for name in MODELS]
    tasks: dict[Place, Task] = {}
    notes: list[str] = []
    for model, (name, surface) in product(models, given.items()):
        if isinstance(model, DirectContact) and surface.measured is None:
            notes.append(f"{name} was not measured: no direct contact")
            continue
        tasks[Place(model.name, name, AS_MEASURED)] = Task(rubber, surface, load, Attempt(model))
        if samples is None:
            continue
        known = Measurement(surface, rubber, speed=load.speed, load_time=load.load_time)
        try:
            drawn = _drawn(known, model, load, samples)
        except InputError as why:
            notes.append(f"{name}, {model.name}: no range; {why}")
            continue
        tasks |= {Place(model.name, name, part): task for part, task in drawn.items()}
    labels = {", ".join(place): task for place, task in tasks.items()}
    answers = solve_all(labels, Store(Path(folder) / PREDICTIONS), workers=workers, on_task=on_task)
    solved = {place: answers[task.key] for place, task in tasks.items()}
    words = [value if isinstance(value, str) else name for name, value in surfaces.items()]
    data = roads_dataset(given, solved).assign_attrs(
        notes="\n".join(notes),
        surfaces=shlex.join(words),
        case=file.text,
        case_file=str(file.path),
        **versions.attributes(),
    )
    return Roads(given, tuple(notes), netcdf.load(netcdf.save(data, Path(folder) / RESULT)))


def _surface(value: Any, file: CaseFile) -> PreparedSurface:
    """Return a road; a synthetic one with its profile, for the direct contact."""
    if isinstance(value, str) and value in SYNTHETIC_SURFACES:
        return with_profile(value)
    return surface_of(value, file)


def _model(name: str, file: CaseFile) -> Model:
    """Return a model under the conditions of the case; the direct contact on one full grid."""
    model = model_of(name, file)
    return replace(model, tolerance=None) if isinstance(model, DirectContact) else model


def _drawn(known: Measurement, model: Model, load: NominalLoad, samples: int) -> dict[str, Task]:
    """Return the tasks of a road's samples, and the one they are compared with, by their part.

    Raises `InputError` if no samples can be drawn.
    """
    source = ProfileSource.of(known, Stated(models=(model.name,)))
    case = Inputs.of(known)
    if isinstance(model, Chain):
        model = replace(model, solver=HalfPlane(points=POINTS))
    else:  # no waves are fitted: the roughness ends where it does as measured, to the last bit
        case = replace(case, fit={})
    parts = {TO_COMPARE: case}
    for number, one in enumerate(draws(case, [source], samples, SEED), start=1):
        if one.inputs is not None:
            parts[f"sample {number}"] = one.inputs
    tasks = {}
    for part, inputs in parts.items():
        surface, own = inputs.for_model(model)
        tasks[part] = Task(known.rubber, own.relevant(surface), load, Attempt(own))
    return tasks
