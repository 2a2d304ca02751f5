"""The wheel alone, without what its extras install: commands on a case draw all their figures."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from gripscale.case_file import write_example

EXTRAS = ("bokeh", "jinja2", "panel", "openpyxl", "dask", "distributed", "SurfaceTopography")
WITHOUT = f"import sys\nsys.modules |= dict.fromkeys({EXTRAS})\n"


@pytest.mark.parametrize(
    ("words", "figure"),
    [
        (["run", "case.toml"], "results/figures/superposition.png"),
        (
            ["study", "case.toml", "--vary", "speed=0.1:1:log3", "--model", "chain"],
            "results/study/figures/totals.png",
        ),
    ],
    ids=["run", "study"],
)
def test_a_case_with_sweeps_is_drawn(words: list[str], figure: str, tmp_path: Path) -> None:
    write_example(tmp_path / "case", "sweeps")
    (tmp_path / "sitecustomize.py").write_text(WITHOUT)
    subprocess.run(
        [sys.executable, "-m", "gripscale", *words],
        cwd=tmp_path / "case",
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        check=True,
    )
    assert (tmp_path / "case" / figure).is_file()
