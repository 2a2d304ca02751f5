"""`gripscale docs`: every page and chapter that the program points to is one that it shows."""

import re

import pytest

from gripscale.cli.docs import anchors, pages
from tests.samples import DOCS, ROOT

POINTER = re.compile(r"docs/([\w-]+)\.md(?:#([\w-]+))?")


def test_all_pages_are_listed_by_name_and_title(shell):
    """The package holds links to them, so that a wheel has the files."""
    listed = shell("docs")
    for path in DOCS.glob("*.md"):
        title = path.read_text(encoding="utf-8").partition("\n")[0].removeprefix("# ")
        assert re.search(rf"^{path.stem} +{re.escape(title)}$", listed.stdout, re.MULTILINE)


def test_a_page_is_shown_from_a_chapter_on(shell):
    whole = shell("docs", "limits").stdout
    page = (DOCS / "limits.md").read_text(encoding="utf-8")
    heading = re.findall(r"^## (.*)$", page, re.MULTILINE)[1]
    assert heading in whole
    part = shell("docs", f"limits.md#{heading.lower().replace(' ', '-')}").stdout
    assert part.strip().startswith(heading)
    assert len(part) < len(whole)


def test_every_pointer_of_the_program_leads_to_a_page_and_a_chapter():
    sources = [*ROOT.glob("python/gripscale/**/*.py"), ROOT / "rust" / "status.rs"]
    found = {match for path in sources for match in POINTER.findall(path.read_text("utf-8"))}
    assert len(found) >= 7
    for page, heading in found:
        text = pages()[page].read_text(encoding="utf-8")
        assert not heading or heading in anchors(text), f"{page}#{heading}"


@pytest.mark.parametrize("page", pages())
def test_anchors_are_those_of_the_site(page):
    markdown = pytest.importorskip("markdown", reason="needs gripscale[docs]")
    text = pages()[page].read_text(encoding="utf-8")
    reader = markdown.Markdown(extensions=["tables", "toc", "pymdownx.superfences"])
    site = re.findall(r'<h\d id="([^"]*)"', reader.convert(text))
    assert list(anchors(text)) == site
    assert len(site) > 1


@pytest.mark.parametrize("anchor", ["kluppel-and-heinrich", "klüppel-and-heinrich"])
def test_a_chapter_with_an_umlaut_is_shown(shell, anchor):
    assert shell("docs", f"theories#{anchor}").stdout.strip().startswith("Klüppel and Heinrich")
