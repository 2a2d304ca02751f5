"""Without openpyxl, reading a workbook names an extra that has it."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest

from gripscale.core.errors import FileError
from gripscale.rubber import read_master_curve
from tests.samples import ROOT

EXTRA = "export"
HINT = f"needs openpyxl, which is not installed; install it with: pip install 'gripscale[{EXTRA}]'"


@pytest.fixture(autouse=True)
def _no_openpyxl(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "openpyxl", None)


def test_reading_gives_the_hint(tmp_path: Path) -> None:
    (tmp_path / "curve.xlsx").write_bytes(b"PK")
    with pytest.raises(FileError) as reading:
        read_master_curve(tmp_path / "curve.xlsx")
    assert HINT in str(reading.value)


def test_the_extra_has_it() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    extras = project["project"]["optional-dependencies"]
    assert any(needed.startswith("openpyxl") for needed in extras[EXTRA])
