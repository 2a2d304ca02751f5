"""The site builds without a warning, has every page, loads nothing from elsewhere."""

import importlib.util
import os
import re
import subprocess
import sys
from inspect import ismodule
from xml.etree import ElementTree

import pytest

import gripscale
from gripscale import chain
from gripscale.case_file.keys import sections
from tests.report.reading import Page
from tests.samples import DOCS, ROOT

LOADING = {"script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src"}
"""Tags that make a browser fetch, with the attribute that says what; links are looked at apart."""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    pytest.importorskip("mkdocs", reason="needs gripscale[docs]")
    pytest.importorskip("latex2mathml", reason="needs gripscale[docs]")
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    built = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert built.returncode == 0, built.stderr
    assert "WARNING" not in built.stderr + built.stdout
    return folder


def loaded(page):
    """Yield what a page makes a browser fetch."""
    for tag, attrs in page.tags:
        fetched = attrs.get(LOADING.get(tag, ""))
        if tag == "link" and attrs.get("rel") not in ("canonical", "prev", "next"):
            fetched = attrs.get("href")
        if fetched:
            yield fetched


def test_no_page_loads_anything_from_elsewhere(site):
    pages = list(site.rglob("*.html"))
    assert len(pages) > 14
    for page in pages:
        assert "$$" not in page.read_text(encoding="utf-8"), "equations are MathML"
        for target in loaded(Page(page)):
            assert not re.match(r"(\w+:)?//", target), f"{page.name} loads {target}"
            if not target.startswith("data:") and page.name != "404.html":
                file = page.parent / target.partition("?")[0].partition("#")[0]
                assert file.exists(), f"{page.name} loads {target}, which is not there"


def test_no_style_sheet_loads_anything_from_elsewhere(site):
    for sheet in site.rglob("*.css"):
        text = sheet.read_text(encoding="utf-8")
        assert not re.search(r"(@import|url\()\s*[\"']?(https?:)?//", text), sheet.name


def test_every_key_of_a_case_is_on_its_page(site):
    page = (site / "reference" / "case-keys.html").read_text(encoding="utf-8")
    for section in sections():
        _, found, rest = page.partition(f">{section.title}</h2>")
        assert found, section.title
        table = rest.partition("</table>")[0]
        for key in section.keys:
            assert f"<code>{key.name}</code>" in table, f"{section.title} {key.name}"


def test_every_public_name_has_its_entry(site):
    pages = map(Page, (site / "reference").glob("*.html"))
    ids = {attrs["id"] or "" for page in pages for _, attrs in page.tags if "id" in attrs}
    packages = {name for name in gripscale.__all__ if ismodule(getattr(gripscale, name))}
    same = {"ScaleResult"}  # another name of ScaleResult
    names = [f"gripscale.{name}" for name in gripscale.__all__ if name not in packages | same]
    names += [f"gripscale.theory.{name}" for name in gripscale.theory.__all__]
    assert not [name for name in names if name not in ids]
    entries = {identifier.rpartition(".")[2] for identifier in ids}
    assert {*gripscale.wave.__all__, *chain.__all__, "Model", "Load"} <= entries


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
