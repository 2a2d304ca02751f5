"""One chain as a task: everything its result depends on, its key, and its solution.

The key is a hash of all inputs, to the last bit, and of the software that solves them: the version,
the compiled kernel and the Python files with numerics in them. Equal keys mean equal results, so a
result stored under its key never has to be found again and can never be a stale one.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import _kernel, chain, dataset, scale, theory
from gripscale.chain import ChainError, LoadTime, Prediction, Solver, predict
from gripscale.rubber import Rubber
from gripscale.surface import SineStack

KEY_LENGTH = 32
"""Hexadecimal digits of a key (128 bits)."""


@dataclass(frozen=True, eq=False)
class Task:
    """One chain to solve (m, Pa, m/s, s).

    Attributes
    ----------
    rubber, sines
        What slides, and on which waves.
    pressure, speed, footprint
        Nominal pressure [Pa], sliding speed [m/s] (zero: static, relaxed), length of contact [m].
    load_time
        As for `predict`.
    model
        "finite_strain" or "half_plane".
    options
        Further arguments of the solver: columns, rows ...
    """

    rubber: Rubber
    sines: SineStack
    pressure: float
    speed: float
    footprint: float
    load_time: LoadTime = "passage"
    model: str = "finite_strain"
    options: Mapping[str, Any] = field(default_factory=dict)

    @cached_property
    def key(self) -> str:
        """Name of the result: a hash of all inputs and of the software."""
        text = json.dumps({"software": software(), **self.inputs()}, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:KEY_LENGTH]

    def inputs(self) -> dict[str, Any]:
        """Return everything the result depends on, floats as exact hexadecimal texts."""
        waves = {"wavelength": self.sines.wavelength, "amplitude": self.sines.amplitude}
        own = {field.name: exact(getattr(self, field.name)) for field in fields(self)}
        return own | {"sines": exact(waves)}


def solve_task(task: Task, on_scale: Callable[[Prediction], None] | None = None) -> xr.Dataset:
    """Solve `task` and return its Dataset, as `Prediction.to_dataset` does.

    A wave that does not converge ends the chain; it is the last one of the Dataset, the totals are
    NaN and the attribute `case_status` says why. Otherwise `case_status` is "converged".
    """
    status = "converged"
    try:
        result = predict(
            task.rubber,
            task.sines,
            pressure=task.pressure,
            speed=task.speed,
            footprint=task.footprint,
            load_time=task.load_time,
            solver=_solver(task.model),
            on_scale=on_scale,
            **task.options,
        )
    except ChainError as error:
        result, status = error.partial, str(error)
    return result.to_dataset().assign_attrs(
        case_key=task.key, case_status=status, load_time=str(task.load_time)
    )


@lru_cache(maxsize=1)
def software() -> str:
    """Return version and fingerprint of what turns inputs into results."""
    fingerprint = hashlib.sha256()
    for file in (_kernel.__file__, scale.__file__, chain.__file__, theory.half_plane.__file__):
        fingerprint.update(Path(str(file)).read_bytes())
    return f"gripscale {dataset.versions()['gripscale']} {fingerprint.hexdigest()[:16]}"


def _solver(model: str) -> Solver | None:
    return theory.solve_half_plane if model == "half_plane" else None


def exact(value: Any) -> Any:
    """Return `value` for JSON without losing a bit: floats in hexadecimal, objects by field."""
    if isinstance(value, float):
        return float(value).hex()
    if isinstance(value, np.ndarray):
        return [exact(entry) for entry in value.tolist()]
    if isinstance(value, Mapping):
        return {str(name): exact(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [exact(entry) for entry in value]
    if is_dataclass(value):
        named = {f.name: exact(getattr(value, f.name)) for f in fields(value)}
        return {"class": type(value).__name__, **named}
    return value
