"""The pictures of the equations are those of their LaTeX."""

from __future__ import annotations

import base64
import html
import re

import pytest

from gripscale.report.elements import Equation
from gripscale.report.equations import draw_equations, method_equations

EVERY = pytest.mark.parametrize("equation", method_equations(), ids=lambda equation: equation.name)


@EVERY
def test_picture_is_of_its_equation(equation: Equation) -> None:
    picture = html.unescape(base64.b64decode(equation.data).decode("utf-8"))
    assert f"<!-- ${equation.latex}$ -->" in picture


def test_picture_is_what_matplotlib_draws() -> None:
    first = method_equations()[0]
    size = r'width="([\d.]+)pt" height="([\d.]+)pt"'
    drawn, stored = (
        re.search(size, text)
        for text in (draw_equations(first.latex), base64.b64decode(first.data).decode("utf-8"))
    )
    assert drawn is not None
    assert stored is not None
    for new, old in zip(drawn.groups(), stored.groups(), strict=True):
        assert float(new) == pytest.approx(float(old), rel=0.02)
