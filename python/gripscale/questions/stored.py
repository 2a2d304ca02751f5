"""Results of questions read from their files.

gs.load("answer.nc").page("answer.html")
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.core.errors import FileError
from gripscale.io import netcdf
from gripscale.questions import registry
from gripscale.questions.answer.variables import with_present_names
from gripscale.questions.result import INPUT_GROUP, KIND


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
    result = result_of(netcdf.load_tree(path))
    if result is None:
        expected = ", ".join(registry.kinds())
        raise FileError(f"{path} holds no result of a question ({expected})")
    return result


def result_of(tree: xr.DataTree) -> Any:
    """Return the result that a file holds; None where it is of no question."""
    kind = registry.result_class(str(tree.attrs.get(KIND, "")))
    if kind is None:
        return None
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
