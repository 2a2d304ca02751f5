"""The page of a results folder or of one of its files, by what the file holds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from gripscale.core.errors import FileError
from gripscale.io import netcdf
from gripscale.questions.chain.run_page import RunSource, read_run, run_of, run_page
from gripscale.questions.compare.page import Compared, comparison_page, stored_comparisons
from gripscale.questions.result import Result
from gripscale.questions.stored import KINDS_OF_REPORTS, require_totals, result_of
from gripscale.questions.uncertainty.propagation import stored_uncertainty
from gripscale.report import write_page
from gripscale.report.elements import Page

# A run with its inputs, comparisons, or the result of a question.
ReportSource = RunSource | Compared | Result


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
    return write_page(lambda: page_of(read_result(path)), output or folder / "report.html")


def page_of(source: ReportSource) -> Page:
    """Return the page of a result."""
    if isinstance(source, RunSource):
        return run_page(source)
    return comparison_page(source) if isinstance(source, Compared) else source.page_content()


def read_result(path: Path) -> ReportSource:
    """Read the results folder or netCDF file at `path`.

    Raises `FileError` if it is missing, unreadable or no result of gripscale.
    """
    if not path.is_dir():
        if not path.exists():
            raise FileError(f"result {path} does not exist")
        tree = netcdf.load_tree(path)
        result: Result | None = result_of(tree)
        if result is not None:
            return result
        require_totals(tree, path)
        return run_of({path.stem: tree})
    run = read_run(path)
    if run is not None:
        return run
    compared = replace(stored_comparisons(path), uncertainty=stored_uncertainty(path.parent))
    if compared.parts:
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
