"""What a report is made of: a run with its inputs, models side by side, a study, what was told."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.analysis.comparison import FILE as DIRECT
from gripscale.analysis.effects import stored_effects
from gripscale.analysis.propagation import stored_uncertainty
from gripscale.charts.ladder import varied
from gripscale.charts.view import PredictionView
from gripscale.core.errors import FileError
from gripscale.experiment.axis import dimensions
from gripscale.io import netcdf

PREDICTIONS = ("dynamic", "static")
COMPARISON = "comparison"
"""Folder of a comparison in that of the run, and the name of its file."""
OVER = "over_*.nc"
"""Files of comparisons over a varied input."""


@dataclass(frozen=True)
class Compared:
    """The comparisons of one case: under its own load, and over varied inputs."""

    ladder: xr.Dataset | None = None
    over: list[xr.Dataset] = field(default_factory=list)
    uncertainty: xr.Dataset | None = None
    """What was sampled of the case, or of another."""

    @property
    def parts(self) -> list[xr.Dataset]:
        """All of them."""
        return [*([] if self.ladder is None else [self.ladder]), *self.over]

    @property
    def case(self) -> str:
        """The text of the case."""
        return str(self.parts[0].attrs.get("case", ""))

    def of(self, case: object) -> Compared:
        """Return those of just this text of a case."""
        same = [one for one in self.parts if one.attrs.get("case") == case]
        return Compared.holding(same)

    @classmethod
    def holding(cls, found: list[xr.Dataset]) -> Compared:
        """Return the comparisons `found`, of which at most one has no axis."""
        ladders = [one for one in found if not varied(one)]
        return cls(ladders[0] if ladders else None, [one for one in found if varied(one)])


@dataclass(frozen=True)
class Run:
    """The predictions of one run, the record of its inputs and comparisons; both may be missing."""

    predictions: list[PredictionView]
    inputs: xr.Dataset
    compared: Compared = field(default_factory=Compared)
    """Models side by side over the same case, as far as they are there."""
    effects: list[xr.Dataset] = field(default_factory=list)
    """What each effect of its conditions is worth, model by model."""
    uncertainty: xr.Dataset | None = None
    """What was sampled of it, or of another case."""
    direct: xr.Dataset | None = None
    """Totals of the direct contact of the measured profiles."""

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


@dataclass(frozen=True)
class SurfaceComparison:
    """Roads side by side."""

    data: xr.Dataset


@dataclass(frozen=True)
class TextReport:
    """A result whose command said in text and figures what there is to say."""

    name: str
    data: xr.Dataset
    text: str
    pictures: list[Path]


TOLD = {"calibration": "profile_excess", "uncertainty": "friction_quantile"}
"""Results of that kind, by the name of their file, with a variable only they have."""

Source = Run | Study | Compared | SurfaceComparison | TextReport


def read_result(path: Path) -> Source:
    """Read the results folder or netCDF file at `path`.

    Raises `FileError` if it is missing, unreadable or no result of gripscale.
    """
    if path.is_dir():
        return _read_folder(path)
    if not path.exists():
        raise FileError(f"result {path} does not exist")
    tree = netcdf.load_tree(path)
    for name, variable in TOLD.items():
        if variable in tree.variables:
            return _told(name, path, tree.to_dataset())
    _require_totals(tree, path)
    if "rung" in tree.dims:
        return Compared.holding([tree.to_dataset()])
    if {"model", "surface"} <= set(tree.dims):
        return SurfaceComparison(tree.to_dataset())
    if tree["total_friction"].ndim:
        return Study(path.stem, tree.to_dataset())
    return _run({path.stem: tree}, Compared())


def _read_folder(folder: Path) -> Source:
    paths = [folder / f"{name}.nc" for name in PREDICTIONS]
    there = {path.stem: _checked(path) for path in paths if path.is_file()}
    if there:
        found = _run(there, _comparisons(folder / COMPARISON))
        effects = stored_effects((folder / COMPARISON, folder), found.attrs.get("case"))
        return replace(
            found,
            effects=effects,
            uncertainty=stored_uncertainty(folder),
            direct=_direct(folder, found),
        )
    compared = replace(_comparisons(folder), uncertainty=stored_uncertainty(folder.parent))
    if compared.parts:
        return compared
    others = sorted(path for path in folder.glob("*.nc") if not path.name.startswith("."))
    if not others:
        raise FileError(
            f"{folder} holds no result; expected the folder of a run, comparison, study, "
            "calibration or uncertainty"
        )
    if len(others) > 1:
        names = ", ".join(path.name for path in others)
        raise FileError(f"{folder} holds several results; name one of them: {names}")
    return read_result(others[0])


def _told(name: str, path: Path, data: xr.Dataset) -> TextReport:
    """Return what its command wrote beside a result."""
    text = path.with_name(f"{name}.txt")
    pictures = [*path.parent.glob("*.png"), *(path.parent / "figures").glob("*.png")]
    said = text.read_text(encoding="utf-8") if text.is_file() else ""
    return TextReport(name, data, said, sorted(pictures))


def _direct(folder: Path, found: Run) -> xr.Dataset | None:
    """Return the direct contact of just the case of the run; None where there is none."""
    path = folder / DIRECT
    if not path.is_file():
        return None
    data = _checked(path).to_dataset()
    return data if data.attrs.get("case") == found.attrs.get("case") else None


def _comparisons(folder: Path) -> Compared:
    """Read the comparisons in `folder`."""
    paths = [folder / f"{COMPARISON}.nc", *sorted(folder.glob(OVER))]
    return Compared.holding([_checked(path).to_dataset() for path in paths if path.is_file()])


def _run(trees: dict[str, xr.DataTree], compared: Compared) -> Run:
    views = [PredictionView(tree.to_dataset(), name) for name, tree in trees.items()]
    first = next(iter(trees.values()))
    inputs = first.children.get("inputs", xr.DataTree())
    return Run(views, inputs.to_dataset(inherit=False), compared)


def _checked(path: Path) -> xr.DataTree:
    """Load `path` and refuse what no model answered."""
    tree = netcdf.load_tree(path)
    _require_totals(tree, path)
    return tree


def _require_totals(tree: xr.DataTree, path: Path) -> None:
    told = {"prediction_status", "status"} & set(tree.variables)
    if not ({"total_contact_fraction", "total_friction"} <= set(tree.variables) and told):
        raise FileError(
            f"{path} has no report: it holds no totals of a run, comparison or study, and no "
            "calibration or uncertainty"
        )
