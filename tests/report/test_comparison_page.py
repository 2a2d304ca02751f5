"""Models side by side, as a page, read without a browser."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import xarray as xr

from gripscale.questions.page_of_folder import write_report

from .reading import Page

FIGURES = {"figure-comparison", "figure-by-wavelength", "figure-over-speed"}


def figures(page: Page) -> set[str]:
    ids = {a.get("id") or "" for _, a in page.tags}
    return {one for one in ids if one.startswith("figure-")}


def test_page_has_table_estimate_figures_and_what_failed(
    compared_folder: Path, compared: list[xr.Dataset]
) -> None:
    page = Page(write_report(compared_folder))
    assert figures(page) == FIGURES
    rows = page.body("ladder")
    assert [row[0] for row in rows] == [str(label) for label in compared[0].label.values]
    friction = float(compared[0].total_friction[1])
    assert float(rows[1][5]) == pytest.approx(friction, rel=0.005)
    assert all(cell for row in rows for cell in row)
    assert re.search(r"finite strain: friction -2.0 %, area \+\d.\d %; profile to surf", page.text)
    assert [a for _, a in page.tags if a.get("class") == "notice warning"], "it stands without it"
    assert "3 m/s, direct contact, measured surface: 1 of 2 samples failed" in page.text
    path = write_report(compared_folder / "over_speed.nc", compared_folder / "one.html")
    assert figures(Page(path)) == {one for one in FIGURES if "speed" in one}
