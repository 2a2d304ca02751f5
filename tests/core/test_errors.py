"""An error carries what is missing as data, through files and processes."""

import pickle
import sys
import tomllib

import pytest

from gripscale.core.errors import (
    ConvergenceError,
    FileError,
    GripscaleError,
    InputError,
    about_file,
)
from gripscale.rubber import read_master_curve
from tests.samples import ROOT


@pytest.mark.parametrize("kind", [GripscaleError, InputError, FileError, ConvergenceError])
def test_what_is_missing_goes_with_an_error_to_another_process(kind):
    error = pickle.loads(pickle.dumps(kind("moduli of what?", missing="modulus")))
    assert (type(error), str(error), error.missing) == (kind, "moduli of what?", "modulus")
    assert kind("no key helps").missing == ""


def test_an_error_about_a_file_keeps_what_is_missing():
    with pytest.raises(FileError, match=r"^a\.csv: how far apart") as caught, about_file("a.csv"):
        raise InputError("how far apart are the points?", missing="step")
    assert caught.value.missing == "step"


# Without openpyxl, reading a workbook names an extra that has it.

EXTRA = "export"
HINT = f"needs openpyxl, which is not installed; install it with: pip install 'gripscale[{EXTRA}]'"


@pytest.fixture(autouse=True)
def _no_openpyxl(monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)


def test_reading_gives_the_hint(tmp_path):
    (tmp_path / "curve.xlsx").write_bytes(b"PK")
    with pytest.raises(FileError) as reading:
        read_master_curve(tmp_path / "curve.xlsx")
    assert HINT in str(reading.value)


def test_the_extra_has_it():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    extras = project["project"]["optional-dependencies"]
    assert any(needed.startswith("openpyxl") for needed in extras[EXTRA])
