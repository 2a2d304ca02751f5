"""What a report is made of: a run with its inputs, a comparison, a study, a calibration, ..."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import xarray as xr

from gripscale.core.errors import FileError
from gripscale.io import netcdf
from gripscale.questions.answer.best_estimate import with_best_estimate
from gripscale.questions.chain.run_folder import (
    RunSource,
    read_run,
    run_of,
)
from gripscale.questions.compare.stored import (
    KINDS_OF_REPORTS,
    Compared,
    require_totals,
    stored_comparisons,
)
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.registry import result_class
from gripscale.questions.result import KIND, Result, load
from gripscale.questions.uncertainty.propagation import stored_uncertainty
from gripscale.questions.vary.axis import dimensions


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
    require_totals(tree, path)
    if "rung" in tree.dims:
        return Compared.holding([tree.to_dataset()])
    kind = ""
    if {"model", "surface"} <= set(tree.dims):
        kind = "roads"
    elif "total_friction_difference" in tree.variables:
        kind = "compounds"
    elif tree["total_friction"].ndim:
        kind = "study"
    if not kind:
        return run_of({path.stem: tree})
    data = with_best_estimate(tree.to_dataset())
    return StudySource(kind, path.stem, data, InputRecord.of_tree(tree))


def _read_folder(folder: Path) -> ReportSource:
    run = read_run(folder)
    if run is not None:
        return run
    compared = replace(stored_comparisons(folder), uncertainty=stored_uncertainty(folder.parent))
    if compared.parts:
        return compared
    others = sorted(path for path in folder.glob("*.nc") if not path.name.startswith("."))
    if not others:
        raise FileError(f"{folder} holds no result; expected the folder of a {KINDS_OF_REPORTS}")
    # a comparison of compounds leaves the study it was made of beside its own result
    others = [path for path in others if path.name == "compounds.nc"] or others
    if len(others) > 1:
        names = ", ".join(path.name for path in others)
        raise FileError(f"{folder} holds several results; name one of them: {names}")
    return read_result(others[0])
