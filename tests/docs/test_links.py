"""Every relative link, figure and file named in the Markdown pages exists."""

import re

import pytest

from tests.samples import ROOT

PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
LINK = re.compile(r"\]\(([^)#]+)(?:#[^)]*)?\)")
FILE = re.compile(r"`((?:rust|python|tests|benchmarks|examples|docs)/[\w./-]+)`")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_names_of_files_lead_somewhere(page):
    text = page.read_text(encoding="utf-8")
    links = [page.parent / target for target in LINK.findall(text) if "://" not in target]
    for path in [*links, *(ROOT / name for name in FILE.findall(text))]:
        assert path.exists(), f"{page.name} points to {path}"


def test_tests_of_the_page_on_verification_exist():
    """Names without a folder are in tests/verification."""
    text = (ROOT / "docs" / "verification.md").read_text(encoding="utf-8")
    names = re.findall(r"`(test_\w+\.py)`", text)
    assert len(names) > 10
    assert not [name for name in names if not (ROOT / "tests" / "verification" / name).exists()]
