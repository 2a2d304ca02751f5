"""What a report is made of: the predictions of a run with their inputs, or a study."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale import netcdf
from gripscale.errors import FileError
from gripscale.figures.view import PredictionView
from gripscale.study.display import dimensions

PREDICTIONS = ("dynamic", "static")


@dataclass(frozen=True)
class Run:
    """The predictions of one run and the record of its inputs, which may be missing."""

    predictions: list[PredictionView]
    inputs: xr.Dataset

    @property
    def data(self) -> xr.Dataset:
        """The first prediction: load, waves, provenance, versions."""
        return self.predictions[0].data

    @property
    def attrs(self) -> dict[Any, Any]:
        """Attributes of the first prediction."""
        return self.data.attrs

    @property
    def by_wave(self) -> list[PredictionView]:
        """The predictions of models that go wave by wave."""
        return [prediction for prediction in self.predictions if prediction.waves]


@dataclass(frozen=True)
class Study:
    """The Dataset of a study."""

    name: str
    data: xr.Dataset

    @property
    def axes(self) -> list[str]:
        """Names of the varied axes."""
        return dimensions(self.data)


def read_result(path: Path) -> Run | Study:
    """Read the results folder or netCDF file at `path`.

    Raises `FileError` if it is missing, unreadable or no result of gripscale.
    """
    if path.is_dir():
        return _read_folder(path)
    if not path.exists():
        raise FileError(f"result {path} does not exist")
    tree = _checked(path)
    if tree["total_friction"].ndim:
        return Study(path.stem, tree.to_dataset())
    return _run({path.stem: tree})


def _read_folder(folder: Path) -> Run | Study:
    paths = [folder / f"{name}.nc" for name in PREDICTIONS]
    there = {path.stem: _checked(path) for path in paths if path.is_file()}
    if there:
        return _run(there)
    others = sorted(path for path in folder.glob("*.nc") if not path.name.startswith("."))
    if not others:
        raise FileError(
            f"{folder} holds no result; expected dynamic.nc, static.nc or the file of a study"
        )
    if len(others) > 1:
        names = ", ".join(path.name for path in others)
        raise FileError(f"{folder} holds several results; name one of them: {names}")
    return read_result(others[0])


def _run(trees: dict[str, xr.DataTree]) -> Run:
    views = [PredictionView(tree.to_dataset(), name) for name, tree in trees.items()]
    first = next(iter(trees.values()))
    inputs = first.children.get("inputs", xr.DataTree())
    return Run(views, inputs.to_dataset(inherit=False))


def _checked(path: Path) -> xr.DataTree:
    """Load `path` and refuse what no model answered."""
    tree = netcdf.load_tree(path)
    if not {"total_contact_fraction", "total_friction", "prediction_status"} <= set(tree.variables):
        raise FileError(f"{path} is not a result of gripscale: it has no totals")
    return tree
