"""The wheel alone, without what its extras install: a run draws its figures."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

EXTRAS = ("bokeh", "jinja2", "panel", "openpyxl", "dask", "distributed", "SurfaceTopography")
WITHOUT = f"import sys\nsys.modules |= dict.fromkeys({EXTRAS})\n"


def test_a_run_is_drawn(changed: Callable[..., Path], tmp_path: Path) -> None:
    case = changed()
    (tmp_path / "sitecustomize.py").write_text(WITHOUT)
    subprocess.run(
        [sys.executable, "-m", "gripscale", "run", case.name],
        cwd=case.parent,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])},
        check=True,
    )
    assert (tmp_path / "results" / "figures" / "correlation.png").stat().st_size > 10_000
