"""Pictures of equations are those of their LaTeX; failures point to a chapter that is there."""

import base64
import html
import re

import pytest

from gripscale.chain.chain import Chain
from gripscale.cli.docs import anchors
from gripscale.conditions import Conditions, ConstantStress
from gripscale.core.errors import ExtrapolationError, InputError
from gripscale.core.status import Status
from gripscale.half_space.model import DirectContact
from gripscale.questions.vary.inputs import AnswerModel
from gripscale.report.elements import Equation, Text
from gripscale.report.equations import method_equations, method_section
from gripscale.report.failures import Failure, chapter_words, explained
from gripscale.theory import Persson
from tests.report.draw_equations import drawn
from tests.samples import DOCS


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


BEYOND = ExtrapolationError.see.removeprefix("docs/")


FAILURES = [status for status in Status if status != "converged"]


@pytest.mark.parametrize("chapter", sorted({*(status.chapter for status in Status), BEYOND}))
def test_chapters_are_there(chapter):
    page, _, anchor = chapter.partition("#")
    assert anchor in anchors((DOCS / page).read_text(encoding="utf-8"))


@pytest.mark.parametrize("status", FAILURES)
def test_a_failure_says_what_to_do_and_where_to_read(status):
    assert status.sentence[0].isupper()
    assert status.sentence.endswith(".")
    assert status.advice.endswith(".")
    text = f"wave 3 of 3 did not converge: {status} at 40 % of the pressure"
    see = f"See {chapter_words(status.chapter)}"
    assert explained(Failure(text, str(status))) == f"{text}. {status.advice} {see}"


@pytest.mark.parametrize("word", ["", "converged", "a word of a later version"])
def test_a_failure_without_a_known_word_is_its_sentence(word):
    text = "wave 3 of 3 did not converge: iteration limit"
    assert explained(Failure(text, word)) == text


def test_a_chapter_is_found_without_the_source():
    words = chapter_words("docs/reading-results.md#beyond-the-measured-band")
    assert words == "`gripscale docs reading-results#beyond-the-measured-band`"
    assert chapter_words("docs/limits.md") == "`gripscale docs limits`"
    assert chapter_words("`gripscale keys rubber`") == "`gripscale keys rubber`"


def test_refusals_point_by_their_kind_and_others_nowhere():
    assert explained(ExtrapolationError("far beyond")) == f"far beyond; see {chapter_words(BEYOND)}"
    assert explained(InputError("speed must be positive")) == "speed must be positive"
