"""One prediction to make: everything its result depends on, its key, and its solution.

The key is a hash of all inputs, to the last bit, and of the software that solves them: a result
stored under its key cannot be a stale one.
"""

from __future__ import annotations

import hashlib
import json
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.chain.chain import Chain
from gripscale.core.errors import FileError, InputError
from gripscale.core.parallel import Stopped
from gripscale.core.provenance import software
from gripscale.io import netcdf
from gripscale.io.folders import make_folder
from gripscale.model import Load, Model, OnProgress
from gripscale.rubber import Rubber
from gripscale.surface import Surface

KEY_LENGTH = 32  # hexadecimal digits of a key (128 bits)

# Numbers of an array that are written out; of a larger one its bytes are hashed at once.
MOST_WRITTEN = 10_000
# Key, result and seconds of a task.
Solved = tuple[str, xr.Dataset, float]


@dataclass(frozen=True, eq=False)
class Task:
    """One prediction to make: what slides on what, under which load, by which model."""

    rubber: Rubber
    surface: Surface
    load: Load
    model: Model = field(default_factory=Chain)

    @cached_property
    def key(self) -> str:
        """Name of the result: a hash of all inputs and of the software.

        Raises `InputError` if the model holds something that cannot be written down exactly.
        """
        inputs = {
            "software": software(),
            "rubber": self.rubber,
            "surface": self.surface.only(self.model.needs),
            "load": self.load,
            "model": self.model,
        }
        return content_hash(inputs)[:KEY_LENGTH]

    def solve(self, stop: threading.Event | None = None, *, on_step: OnProgress = None) -> Solved:
        """Return key, result and seconds; give up between two steps once `stop` is set.

        `on_step` is called with each step of the model.
        """

        def look(step: object) -> None:
            if stop is not None and stop.is_set():
                raise Stopped
            if on_step is not None:
                on_step(step)

        start = time.perf_counter()
        answer = self.model.predict(self.rubber, self.surface, self.load, on_progress=look)
        seconds = time.perf_counter() - start
        return self.key, answer.assign_attrs(prediction_key=self.key), seconds


def content_hash(value: Any) -> str:
    """Return the SHA-256 of what `canonical_json` writes of a value."""
    content = json.dumps(canonical_json(value), sort_keys=True)
    return hashlib.sha256(content.encode()).hexdigest()


def canonical_json(value: Any) -> Any:
    """Return `value` for JSON without losing a bit: floats in hexadecimal, objects by field."""
    if isinstance(value, float):
        return float(value).hex()
    if isinstance(value, np.ndarray):
        if value.size > MOST_WRITTEN:
            content = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
            return {"array": str(value.dtype), "shape": list(value.shape), "sha256": content}
        if value.ndim == 1 and value.dtype == np.float64:  # most of what a key is made of
            return list(map(float.hex, value.tolist()))
        return [canonical_json(entry) for entry in value.tolist()]
    if isinstance(value, Mapping):
        return {str(name): canonical_json(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [canonical_json(entry) for entry in value]
    if is_dataclass(value):
        kind = type(value) if not isinstance(value, type) else value
        named = {f.name: canonical_json(getattr(value, f.name)) for f in fields(value)}
        return {"class": f"{kind.__module__}.{kind.__qualname__}", **named}
    if value is None or isinstance(value, str | bool | int):
        return value
    raise InputError(
        "a study keeps its results by everything they depend on: models and conditions must be "
        f"dataclasses of numbers, texts and such; got {value!r:.80}"
    )


PREDICTIONS = "predictions"  # folder of the finished predictions, in the folder of a result


class Store:
    """A folder of finished predictions: one small netCDF file each, named by the key of its task.

    A file is written beside its place and renamed into it, so a file that is there is whole. One
    that cannot be read back all the same (a disk that was full, a power cut) counts as not there.
    The folder is made if it is not there; `FileError` if it cannot be.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        make_folder(self.folder)

    def path(self, key: str) -> Path:
        """Return where the prediction of `key` is, or would be."""
        return self.folder / f"{key}.nc"

    def get(self, key: str) -> xr.Dataset | None:
        """Return the prediction of `key`, or None if it is not there whole."""
        try:
            data = netcdf.load_dataset(self.path(key))
        except FileError:
            return None
        return data if data.attrs.get("prediction_key") == key else None

    def put(self, key: str, solved: xr.Dataset) -> Path:
        """Write the prediction of `key`, else raise `FileError`; return the path of its file."""
        return netcdf.save(solved, self.path(key))
