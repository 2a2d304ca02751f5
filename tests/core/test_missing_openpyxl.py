"""Without openpyxl, reading a workbook names an extra that has it."""

import sys
import tomllib

import pytest

from gripscale.core.errors import FileError
from gripscale.rubber import read_master_curve
from tests.samples import ROOT

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
