"""The page of a results folder or of one of its files, by what the file holds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.core.errors import FileError
from gripscale.io import netcdf
from gripscale.questions import registry
from gripscale.questions.answer.answer import ANSWER_FILE, CHAIN_FILE, CURVE_FILE, Answer
from gripscale.questions.answer.variables import with_present_names
from gripscale.questions.compare.question import Comparison
from gripscale.questions.result import INPUT_GROUP, KIND, Result
from gripscale.report import write_page


def load(path: str | Path) -> Any:
    """Return a saved result as it was.

    Raises `FileError` if it does not exist, is damaged, or is no result of a question.

        >>> gs.load("answer.nc").kind
        'answer'

    Parameters
    ----------
    path : path
        A file that `Result.save` or a command wrote.
    """
    tree = netcdf.load_tree(path)
    kind = registry.result_class(str(tree.attrs.get(KIND, "")))
    if kind is None:
        expected = ", ".join(registry.kinds())
        raise FileError(f"{path} holds no result of a question ({expected})")
    inputs = tree.children.get(INPUT_GROUP, xr.DataTree()).to_dataset(inherit=False)
    return kind(with_present_names(tree.to_dataset()), inputs)


KINDS_OF_REPORTS = (
    "run, comparison, study, sensitivity, cut-off, design, calibration or uncertainty, or of "
    "surfaces or rubbers side by side"
)


def _predicted(path: Path) -> xr.Dataset:
    """Return a prediction; raise `FileError` for a file that no model answered."""
    data = netcdf.load_dataset(path)
    totals = {"total_contact_fraction", "total_friction"} <= {*data}
    if not totals or not {"prediction_status", "status"} & {*data}:
        raise FileError(
            f"{path} has no report: it holds no totals or quantiles of a {KINDS_OF_REPORTS}"
        )
    return data


def write_report(result: str | Path, output: str | Path | None = None) -> Path:
    """Write the HTML report of `result` and return its path.

    Raises `FileError` if the result is missing or unreadable, or the page cannot be written;
    `InputError` if the libraries of `gripscale[report]` are not installed.

    Parameters
    ----------
    result
        Results folder of a run, comparison, study, calibration or uncertainty, or of roads or
        compounds side by side; or one of their netCDF files.
    output
        The file to write; `report.html` in the results folder by default.
    """
    path = Path(result)
    folder = path if path.is_dir() else path.parent
    return write_page(read_result(path).page_content, output or folder / "report.html")


def read_result(path: Path) -> Result:
    """Read the results folder or netCDF file at `path`.

    Raises `FileError` if it is missing, unreadable or no result of gripscale.
    """
    result: Result
    if not path.is_dir():
        result = load(path)
        return result
    if (path / ANSWER_FILE).is_file():
        run: Answer = load(path / ANSWER_FILE)
        for name, part in ((CHAIN_FILE, "chain"), (CURVE_FILE, "curve")):
            data = _predicted(path / name) if (path / name).is_file() else xr.Dataset()
            if data and data.attrs.get("case") == run.data.attrs.get("case"):
                setattr(run, part, data)
        return run
    paths = [path / "comparison.nc", *sorted(path.glob("over_*.nc"))]
    if compared := [Comparison(_predicted(file)) for file in paths if file.is_file()]:
        compared[0].others = compared[1:]
        return compared[0]
    others = sorted(file for file in path.glob("*.nc") if not file.name.startswith("."))
    if not others:
        raise FileError(f"{path} holds no result; expected the folder of a {KINDS_OF_REPORTS}")
    # a comparison of compounds leaves the study it was made of beside its own result
    others = [file for file in others if file.name == "compounds.nc"] or others
    if len(others) > 1:
        names = ", ".join(file.name for file in others)
        raise FileError(f"{path} holds several results; name one of them: {names}")
    return read_result(others[0])
