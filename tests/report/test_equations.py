"""The pictures of the equations are those of their LaTeX."""

import base64
import html
import re

import pytest

from gripscale.chain.chain import Chain
from gripscale.conditions import Conditions, ConstantStress
from gripscale.half_space.model import DirectContact
from gripscale.questions.vary.inputs import AnswerModel
from gripscale.report.elements import Equation, Text
from gripscale.report.equations import method_equations, method_section
from gripscale.theory import Persson
from tests.report.draw_equations import drawn


@pytest.mark.parametrize("name", method_equations())
def test_picture_is_of_its_equation(name):
    equation = method_equations()[name]
    picture = html.unescape(base64.b64decode(equation.data).decode("utf-8"))
    assert f"<!-- ${equation.latex}$ -->" in picture


def test_picture_is_what_matplotlib_draws():
    first = method_equations()["correlation"]
    size = r'width="([\d.]+)pt" height="([\d.]+)pt"'
    new_size, stored = (
        re.search(size, text)
        for text in (drawn(first.latex), base64.b64decode(first.data).decode("utf-8"))
    )
    for new, old in zip(new_size.groups(), stored.groups(), strict=True):
        assert float(new) == pytest.approx(float(old), rel=0.02)


def names(*methods):
    """Return the names of the equations in the section of methods."""
    elements = method_section(*methods).elements
    return [element.name for element in elements if isinstance(element, Equation)]


def test_the_method_is_that_of_the_models_that_were_run():
    direct = ["prony", "half_space", "rough_contact", "rough_friction"]
    dry = AnswerModel(conditions=Conditions(shear_stress=ConstantStress(1e6)))
    assert names(DirectContact.method) == direct
    assert names(AnswerModel().method) == [*direct, "surface"]
    assert names(dry.method) == [*direct, "surface", "interface"]
    assert names(Chain.method)[:2] == ["correlation", "sines"]
    assert names(Chain.method, DirectContact.method).count("prony") == 1
    both = {*Chain.method, *dry.method}
    assert set(method_equations()) <= both  # none that no model names


def test_a_model_without_equations_says_what_it_is():
    (element,) = method_section(Persson().method).elements
    assert isinstance(element, Text)
    assert "Persson" in str(element)
    assert not method_section().elements
