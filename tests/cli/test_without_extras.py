"""The wheel alone, without what its extras install: a run draws its figures."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from gripscale.case_file import write_example

EXTRAS = ("bokeh", "jinja2", "panel", "openpyxl", "dask", "distributed", "SurfaceTopography")
WITHOUT = f"import sys\nsys.modules |= dict.fromkeys({EXTRAS})\n"


def test_a_case_with_sweeps_is_drawn(tmp_path: Path) -> None:
    case = write_example(tmp_path / "case", "sweeps")[0]
    text = case.read_text(encoding="utf-8")
    assert "\nscales = 4" in text
    coarse = '\n[solver]\nmodel = "half_plane"\npoints = 64\n'
    case.write_text(text.replace("\nscales = 4", "\nscales = 2") + coarse, encoding="utf-8")
    (tmp_path / "sitecustomize.py").write_text(WITHOUT)
    subprocess.run(
        [sys.executable, "-m", "gripscale", "run", "case.toml"],
        cwd=tmp_path / "case",
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        check=True,
    )
    figures = tmp_path / "case" / "results" / "figures"
    assert (figures / "superposition.png").stat().st_size > 10_000
