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


def predicted_tree(path: Path) -> xr.DataTree:
    """Return the file of a prediction; raise `FileError` for one that no model answered."""
    tree = netcdf.load_tree(path)
    names = set(tree.variables)
    if not ({"total_contact_fraction", "total_friction"} <= names) or not (
        {"prediction_status", "status"} & names
    ):
        raise FileError(
            f"{path} has no report: it holds no totals or quantiles of a {KINDS_OF_REPORTS}"
        )
    return tree


def read_run(folder: Path) -> Answer:
    """Return what a run left in a folder: its answer, with what is of the same case beside it.

    Raises `FileError` if a file is damaged or no result.
    """
    result: Answer = load(folder / ANSWER_FILE)

    def of_this_case(name: str) -> xr.Dataset | None:
        path = folder / name
        data = predicted_tree(path).to_dataset() if path.is_file() else None
        same = data is not None and data.attrs.get("case") == result.data.attrs.get("case")
        return data if same else None

    result.chain, result.curve = of_this_case(CHAIN_FILE), of_this_case(CURVE_FILE)
    return result


def write_report(result: str | Path, output: str | Path | None = None) -> Path:
    """Write the HTML report of `result` and return its path.

    Raises `FileError` if the result is missing or unreadable, or the page cannot be written. Raises
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


def read_comparisons(folder: Path) -> Comparison | None:
    """Return the comparisons in a folder as one; None without any."""
    paths = [folder / "comparison.nc", *sorted(folder.glob("over_*.nc"))]
    every = [Comparison(predicted_tree(p).to_dataset()) for p in paths if p.is_file()]
    if not every:
        return None
    every[0].others = every[1:]
    return every[0]


def read_result(path: Path) -> Result:
    """Read the results folder or netCDF file at `path`.

    Raises `FileError` if it is missing, unreadable or no result of gripscale.
    """
    if not path.is_dir():
        result: Result = load(path)
        return result
    if (path / ANSWER_FILE).is_file():
        return read_run(path)
    if (compared := read_comparisons(path)) is not None:
        return compared
    others = sorted(file for file in path.glob("*.nc") if not file.name.startswith("."))
    if not others:
        raise FileError(f"{path} holds no result; expected the folder of a {KINDS_OF_REPORTS}")
    # a comparison of compounds leaves the study it was made of beside its own result
    others = [file for file in others if file.name == "compounds.nc"] or others
    if len(others) > 1:
        names = ", ".join(file.name for file in others)
        raise FileError(f"{path} holds several results; name one of them: {names}")
    return read_result(others[0])
