"""Pictures of the equations of the method, as matplotlib sets them.

`python -m tests.report.draw_equations` draws them anew, for equations that have changed.
"""

from __future__ import annotations

import io
import tomllib
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from gripscale.report import equations

_POINTS = 14.0  # size of the letters [pt]


def drawn(latex: str) -> str:
    """Return an equation as SVG; its LaTeX stands in it as a comment."""
    rules: Any = {"mathtext.fontset": "stix", "svg.hashsalt": "gripscale", "svg.fonttype": "path"}
    file = io.StringIO()
    with mpl.rc_context(rules):
        figure = Figure()
        figure.text(0.0, 0.0, f"${latex}$", fontsize=_POINTS)
        look: dict[str, Any] = {"bbox_inches": "tight", "pad_inches": 0.02, "transparent": True}
        figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None}, **look)
    return file.getvalue()


if __name__ == "__main__":
    folder = Path(equations.__file__).parent / "templates" / "equations"
    for name, entry in tomllib.loads((folder / "equations.toml").read_text("utf-8")).items():
        (folder / f"{name}.svg").write_text(drawn(entry["latex"]), encoding="utf-8")
