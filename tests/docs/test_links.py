"""Every relative link and figure in the Markdown pages exists."""

import re

import pytest

from tests.samples import ROOT

PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
LINK = re.compile(r"\]\(([^)#]+)(?:#[^)]*)?\)")


def test_the_pages_are_found():
    names = {page.name for page in PAGES}
    assert {"README.md", "method.md", "verification.md", "limits.md", "inputs.md"} <= names


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for target in LINK.findall(page.read_text(encoding="utf-8")):
        if "://" not in target:
            assert (page.parent / target).exists(), f"{page.name} points to {target}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_named_in_the_text_exist(page):
    text = page.read_text(encoding="utf-8")
    for name in re.findall(r"`((?:rust|python|tests|benchmarks|examples|docs)/[\w./-]+)`", text):
        assert (ROOT / name).exists(), f"{page.name} names {name}"


def test_tests_of_the_page_on_verification_exist():
    """Names without a folder are in tests/verification."""
    text = (ROOT / "docs" / "verification.md").read_text(encoding="utf-8")
    names = re.findall(r"`(test_\w+\.py)`", text)
    assert len(names) > 10
    assert not [name for name in names if not (ROOT / "tests" / "verification" / name).exists()]
