"""The equations of the method, with pictures that matplotlib has set as SVG.

MathML would need no pictures, but browsers set it badly where no mathematical font is installed.
"""

from __future__ import annotations

import base64
import re
import tomllib
from collections.abc import Sequence
from functools import cache
from importlib.resources import files

from gripscale.report.elements import Equation, Section, Text

FOLDER = files("gripscale.report").joinpath("templates", "equations")


@cache
def method_equations() -> dict[str, Equation]:
    """Return every equation that a model may name, by its name, with pictures in base64."""
    equations = {}
    for name, entry in tomllib.loads(FOLDER.joinpath("equations.toml").read_text("utf-8")).items():
        svg = FOLDER.joinpath(f"{name}.svg").read_text(encoding="utf-8")
        sizes = re.search(r'<svg[^>]* width="([\d.]+)pt" height="([\d.]+)pt"', svg)
        assert sizes is not None
        width, height = (round(float(points) * 4.0 / 3.0) for points in sizes.groups())
        data = base64.b64encode(svg.encode("utf-8")).decode("ascii")
        equations[name] = Equation(name, **entry, data=data, width=width, height=height)
    return equations


def method_section(*methods: Sequence[str]) -> Section:
    """Return what the models that were run say of themselves (`gripscale.model.Model.method`)."""
    by_name = method_equations()
    items = dict.fromkeys(item for method in methods for item in method)
    return Section("method", "Method", [by_name.get(item) or Text(item) for item in items])
