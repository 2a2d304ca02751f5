"""LaTeX of the pages becomes MathML when the site is built; what cannot be is refused."""

import importlib.util
import re
from xml.etree import ElementTree

import pytest

from tests.samples import DOCS

pytest.importorskip("latex2mathml", reason="needs gripscale[docs]")


@pytest.fixture(scope="module")
def hooks():
    found = importlib.util.spec_from_file_location("hooks", DOCS / "hooks.py")
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


def test_fraction_and_root_are_elements_of_their_own(hooks):
    math = ElementTree.fromstring(
        re.sub(' xmlns="[^"]*"', "", hooks.equation(r"\sqrt{\frac{a}{b}}"))
    )
    assert [one.text for one in math.findall(".//msqrt//mfrac//mi")] == ["a", "b"]


def test_lines_are_aligned_in_a_table(hooks):
    given = "\\begin{aligned}\na &= b \\\\\nc &= d\n\\end{aligned}"
    math = hooks.equation(given)
    assert math.count("<mtr>") == 2
    assert "\n" not in math.strip()  # Markdown would take lines for its own


@pytest.mark.parametrize("given", [r"\nothing{a}", r"\begin{alignedat} a &= b \end{alignedat}"])
def test_what_is_not_known_is_refused(hooks, given):
    with pytest.raises(ValueError, match="cannot be made MathML"):
        hooks.equation(given)
