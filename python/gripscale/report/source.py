"""What a report is made of: the chains of a run with their inputs, or the Dataset of a study."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale import dataset
from gripscale.errors import FileError

Array = NDArray[np.float64]
OWN_DIMENSIONS = ("scale", "surface_node", "decade")
"""Dimensions that were not varied; any other is an axis of a study."""
CHAINS = ("dynamic", "static")


@dataclass(frozen=True)
class Chain:
    """One chain as read back: its Dataset and the groups written beside it."""

    name: str
    data: xr.Dataset
    solver: xr.Dataset = field(default_factory=xr.Dataset)

    @property
    def speed(self) -> float:
        """Sliding speed [m/s]."""
        return float(self.data.attrs.get("sliding_speed_m_per_s", np.nan))

    @property
    def moving(self) -> bool:
        """Whether it slides: a chain at rest has no friction to show."""
        return self.speed > 0.0

    @property
    def title(self) -> str:
        """What tables and figures call it."""
        return f"Dynamic, {self.speed:g} m/s" if self.moving else "Static"

    @property
    def waves(self) -> int:
        """Number of waves solved, a failed one included."""
        return int(self.data.sizes["scale"])

    @property
    def number(self) -> Array:
        """Numbers of the waves, from 1."""
        return np.arange(1.0, self.waves + 1.0)

    @cached_property
    def converged(self) -> NDArray[np.bool_]:
        """Whether each wave may be used."""
        return np.array([str(status) == "converged" for status in self.data["status"].values])

    def has(self, name: str) -> bool:
        """Return whether there is a column `name`, from the chain or from the solver."""
        return name in self.data or name in self.solver

    def column(self, name: str) -> Array:
        """Return a column over the waves."""
        data = self.data if name in self.data else self.solver
        return np.asarray(data[name].values, dtype=float)

    def usable(self, name: str) -> Array:
        """Return a column with NaN where the wave did not converge."""
        return np.where(self.converged, self.column(name), np.nan)

    def shows(self, name: str) -> bool:
        """Return whether some wave that may be used has a number in a column."""
        return self.has(name) and bool(np.isfinite(self.usable(name)).any())


@dataclass(frozen=True)
class Run:
    """The chains of one run and the record of its inputs, which may be missing."""

    chains: list[Chain]
    inputs: xr.Dataset

    @property
    def attrs(self) -> dict[Any, Any]:
        """Attributes of the first chain: load, provenance, versions."""
        return self.chains[0].data.attrs

    @property
    def planned(self) -> int:
        """Number of waves the chains should have; 0 if it was not recorded."""
        return int(self.inputs.sizes.get("wave", 0))


@dataclass(frozen=True)
class Study:
    """The Dataset of a study and the axes it varies."""

    name: str
    data: xr.Dataset

    @property
    def axes(self) -> list[str]:
        """Names of the varied axes."""
        return [str(name) for name in self.data.sizes if name not in OWN_DIMENSIONS]


def read_result(path: Path) -> Run | Study:
    """Read the results folder or netCDF file at `path`.

    Raises `FileError` if it is missing, unreadable or no result of gripscale.
    """
    if path.is_dir():
        return _read_folder(path)
    if not path.exists():
        raise FileError(f"result {path} does not exist")
    data = _checked(path)
    if any(name not in OWN_DIMENSIONS for name in data.sizes):
        return Study(path.stem, data)
    return _run([(path.stem, path, data)])


def _read_folder(folder: Path) -> Run | Study:
    chains = [(name, folder / f"{name}.nc") for name in CHAINS]
    there = [(name, path, _checked(path)) for name, path in chains if path.is_file()]
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


def _run(files: list[tuple[str, Path, xr.Dataset]]) -> Run:
    groups = [dataset.load_groups(path) for _, path, _ in files]
    chains = [
        Chain(name, data, group.get("solver", xr.Dataset()))
        for (name, _, data), group in zip(files, groups, strict=True)
    ]
    return Run(chains, groups[0].get("inputs", xr.Dataset()))


def _checked(path: Path) -> xr.Dataset:
    """Load `path` and refuse what has no waves."""
    data = dataset.load(path)
    single = all(name in OWN_DIMENSIONS for name in data.sizes)
    if single and not {"status", "wavelength", "contact_fraction"} <= set(data.variables):
        raise FileError(f"{path} is not a result of gripscale: it has no waves")
    return data
