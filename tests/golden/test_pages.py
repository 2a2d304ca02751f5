"""What holds of the page of every command: one file, asks for nothing, texts for all it shows."""

from __future__ import annotations

import re

import pytest

from tests.report.reading import Page

from .experiments import COMMANDS, Experiments

PAGES = [name for name in COMMANDS if not name.startswith(("fit_", "keys"))]


@pytest.fixture(scope="module", params=PAGES)
def page(request: pytest.FixtureRequest, experiments: Experiments) -> Page:
    return Page(experiments.folder / request.param / "report.html")


def test_a_page_is_one_file_that_asks_for_nothing(page: Page, experiments: Experiments) -> None:
    named = [attrs.get("src") or attrs.get("href") for _, attrs in page.tags]
    assert [value for value in named if value and not value.startswith(("data:", "#"))] == []
    policy = next(a["content"] or "" for _, a in page.tags if "http-equiv" in a)
    assert "default-src 'none'" in policy
    scripts = policy.partition("script-src ")[2].partition(";")[0].split()
    assert len(scripts) == 2
    assert all(source.startswith("'sha256-") for source in scripts)
    assert len(page.source) < 3e6
    assert str(experiments.folder) not in page.source


def test_what_a_page_shows_has_texts(page: Page) -> None:
    pictures = [attrs for tag, attrs in page.tags if tag == "img"]
    assert all(attrs.get("alt") for attrs in pictures)
    plots = [attrs for _, attrs in page.tags if attrs.get("class") == "plot"]
    assert all(attrs.get("aria-label") and attrs.get("role") == "img" for attrs in plots)
    for name, rows in page.tables.items():
        assert all(row and all(row) for row in rows[1:]), name
    assert not re.search(r"\{\{|\}\}|\bnan\b", page.text), "left behind by a template or a number"
