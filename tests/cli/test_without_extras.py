"""The wheel alone, without what its extras install: a run draws its figures."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.samples import HALF_PLANE, TWO_WAVES, case_text

EXTRAS = ("bokeh", "jinja2", "panel", "openpyxl", "dask", "distributed", "SurfaceTopography")
WITHOUT = f"import sys\nsys.modules |= dict.fromkeys({EXTRAS})\n"


def test_a_run_is_drawn(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(case_text(TWO_WAVES, solver=HALF_PLANE))
    (tmp_path / "sitecustomize.py").write_text(WITHOUT)
    subprocess.run(
        [sys.executable, "-m", "gripscale", "run", "case.toml"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])},
        check=True,
    )
    figures = [path.stat().st_size for path in (tmp_path / "results" / "figures").glob("*.png")]
    assert len(figures) > 1
    assert min(figures) > 10_000
