"""What a report is made of: a run with its inputs, a comparison, a study, a calibration, ..."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.core.errors import FileError
from gripscale.experiment.measured_friction import MeasuredFriction
from gripscale.io import netcdf
from gripscale.questions.answer.answer import ANSWER_FILE as DIRECT
from gripscale.questions.answer.best_estimate import with_best_estimate
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.compare.charts_of_ladder import varied
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.registry import result_class
from gripscale.questions.result import KIND, Result, load
from gripscale.questions.sensitivity.friction_sensitivity import LOSS as SENSITIVITY
from gripscale.questions.uncertainty.propagation import of_same_inputs, stored_uncertainty
from gripscale.questions.vary.axis import dimensions
from gripscale.questions.vary.effects import stored_effects

_PREDICTIONS = ("dynamic", "static")
COMPARISON = "comparison"
"""Folder of a comparison in that of the run, and the name of its file."""
OVER = "over_*.nc"
"""Files of comparisons over a varied input."""
KINDS = (
    "run, comparison, study, sensitivity, cut-off, design, calibration or uncertainty, or of "
    "surfaces or rubbers side by side"
)


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

    @property
    def own_uncertainty(self) -> xr.Dataset | None:
        """What was sampled of this very case, or None."""
        data = self.uncertainty
        return data if data is not None and of_same_inputs(data, self.case) else None

    def of(self, case: object) -> Compared:
        """Return those of just this text of a case."""
        return Compared.holding([data for data in self.parts if data.attrs.get("case") == case])

    @classmethod
    def holding(cls, parts: list[xr.Dataset]) -> Compared:
        """Return the comparisons, of which at most one has no axis."""
        ladders = [data for data in parts if not varied(data)]
        return cls(ladders[0] if ladders else None, [data for data in parts if varied(data)])


@dataclass(frozen=True)
class RunSource:
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
    cut_off: xr.Dataset | None = None
    """Contact and friction against the cut-off."""
    measured: MeasuredFriction | None = None
    """Measured friction that its case names."""

    @property
    def data(self) -> xr.Dataset:
        """The first prediction: load, waves, provenance, versions."""
        return self.predictions[0].data

    @property
    def attrs(self) -> dict[Any, Any]:
        """Attributes of the first prediction."""
        return self.data.attrs

    @property
    def record(self) -> InputRecord:
        """The record of its inputs."""
        return InputRecord(self.inputs)

    @property
    def by_wave(self) -> list[PredictionView]:
        """The predictions of models that go wave by wave."""
        return [prediction for prediction in self.predictions if prediction.waves]

    @property
    def own_uncertainty(self) -> xr.Dataset | None:
        """What was sampled of its very inputs, or None."""
        data, case = self.uncertainty, str(self.attrs.get("case", ""))
        if data is None or not of_same_inputs(data, case, self.record.digests):
            return None
        return data


@dataclass(frozen=True)
class StudySource:
    """The Dataset of many predictions.

    `kind` is study, compounds (a study over rubbers, with the differences to the first), roads,
    sensitivity, cut_off, design, uncertainty or calibration.
    """

    kind: str
    name: str
    data: xr.Dataset
    record: InputRecord = field(default_factory=lambda: InputRecord(xr.Dataset()))
    """The record of its inputs, where its command keeps it."""

    @property
    def axes(self) -> list[str]:
        """Names of the varied axes."""
        return dimensions(self.data)


ReportSource = RunSource | StudySource | Compared | Result


def read_result(path: Path) -> ReportSource:
    """Read the results folder or netCDF file at `path`.

    Raises `FileError` if it is missing, unreadable or no result of gripscale.
    """
    if path.is_dir():
        return _read_folder(path)
    if not path.exists():
        raise FileError(f"result {path} does not exist")
    tree = netcdf.load_tree(path)
    if result_class(str(tree.attrs.get(KIND, ""))) is not None:
        result: Result = load(path)
        return result
    names, kind = set(tree.variables), ""
    if "profile_excess" in names:
        kind = "calibration"
    elif SENSITIVITY in names:
        kind = "sensitivity"
    elif "rolling_ratio" in names:
        kind = "design"
    else:
        _require_totals(tree, path)
        if "rung" in tree.dims:
            return Compared.holding([tree.to_dataset()])
        if {"model", "surface"} <= set(tree.dims):
            kind = "roads"
        elif "total_friction_difference" in names:
            kind = "compounds"
        elif tree["total_friction"].ndim:
            kind = "study"
    if not kind:
        return _run({path.stem: tree})
    data = with_best_estimate(tree.to_dataset())
    return StudySource(kind, path.stem, data, InputRecord.of_tree(tree))


def _read_folder(folder: Path) -> ReportSource:
    paths = [folder / f"{name}.nc" for name in _PREDICTIONS]
    trees = {path.stem: _checked(path) for path in paths if path.is_file()}
    if trees:
        run = replace(_run(trees), compared=_comparisons(folder / COMPARISON))
        case = run.attrs.get("case")
        direct, curve = (
            _checked(path).to_dataset() if path.is_file() else None
            for path in (folder / DIRECT, folder / "cut_off.nc")
        )
        return replace(
            run,
            effects=stored_effects((folder / COMPARISON, folder), case),
            uncertainty=stored_uncertainty(folder),
            direct=direct if direct is not None and direct.attrs.get("case") == case else None,
            cut_off=curve if curve is not None and curve.attrs.get("case") == case else None,
            measured=_measured(folder),
        )
    compared = replace(_comparisons(folder), uncertainty=stored_uncertainty(folder.parent))
    if compared.parts:
        return compared
    others = sorted(path for path in folder.glob("*.nc") if not path.name.startswith("."))
    if not others:
        raise FileError(f"{folder} holds no result; expected the folder of a {KINDS}")
    # a comparison of compounds leaves the study it was made of beside its own result
    others = [path for path in others if path.name == "compounds.nc"] or others
    if len(others) > 1:
        names = ", ".join(path.name for path in others)
        raise FileError(f"{folder} holds several results; name one of them: {names}")
    return read_result(others[0])


def _measured(folder: Path) -> MeasuredFriction | None:
    """Read the measured friction that the saved case names; none without one."""
    # to import what reads a case takes longer than to read all results
    from gripscale.case_file.folder import SAVED_CASE

    case = folder / SAVED_CASE
    if not case.is_file():
        return None
    try:
        tables = tomllib.loads(case.read_text(encoding="utf-8"))
    except ValueError as error:
        raise FileError(f"case file {case} is not valid TOML: {error}") from error
    if "measured" not in tables:
        return None
    from gripscale.case_file.prepare import stated_friction
    from gripscale.case_file.read import read_case_file

    return stated_friction(read_case_file(case))


def _comparisons(folder: Path) -> Compared:
    """Read the comparisons in `folder`."""
    paths = [folder / f"{COMPARISON}.nc", *sorted(folder.glob(OVER))]
    return Compared.holding([_checked(path).to_dataset() for path in paths if path.is_file()])


def _run(trees: dict[str, xr.DataTree]) -> RunSource:
    views = [PredictionView(tree.to_dataset(), name) for name, tree in trees.items()]
    return RunSource(views, InputRecord.of_tree(next(iter(trees.values()))).data)


def _checked(path: Path) -> xr.DataTree:
    """Load `path` and refuse what no model answered."""
    tree = netcdf.load_tree(path)
    _require_totals(tree, path)
    return tree


def _require_totals(tree: xr.DataTree, path: Path) -> None:
    names = set(tree.variables)
    if not ({"total_contact_fraction", "total_friction"} <= names) or not (
        {"prediction_status", "status"} & names
    ):
        raise FileError(f"{path} has no report: it holds no totals or quantiles of a {KINDS}")
