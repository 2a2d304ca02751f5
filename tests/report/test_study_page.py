"""The page of a study, read without a browser."""

from __future__ import annotations

from pathlib import Path

import pytest

from gripscale.report import write_report

from .reading import Page


@pytest.fixture(scope="module")
def page(study_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Page:
    return Page(write_report(study_file, tmp_path_factory.mktemp("page") / "study.html"))


def test_axes_and_their_values_are_named(page: Page) -> None:
    rows = page.body("axes")
    assert rows[0] == ["speed", "sliding speed", "m/s", "2", "0.03, 3"]
    assert rows[1][0] == "rubber"
    assert rows[1][-1] == "tread, <b>SBR</b>"


def test_totals_have_every_prediction_and_no_empty_cell(page: Page) -> None:
    rows = page.body("totals")
    assert len(rows) == 4
    assert all(cell for row in rows for cell in row)
    assert rows[3][2] == "–"


def test_failed_prediction_is_loud(page: Page) -> None:
    alerts = [a for _, a in page.tags if a.get("role") == "alert"]
    assert len(alerts) == 1
    assert "speed 3, rubber <b>SBR</b>: NOT converged: wave 3 of 3" in page.text
    marked = [tag for tag, a in page.tags if "bad" in (a.get("class") or "").split()]
    assert marked.count("th") == 1
    assert marked.count("td") == len(page.body("totals")[0]) - 1


def test_command_that_makes_the_study_is_given(page: Page) -> None:
    assert "gripscale study case.toml --vary speed=0.03,3 --vary 'rubber=tread," in page.text


def test_curves_over_the_numeric_axis_and_the_waves(page: Page) -> None:
    names = {a["id"] for _, a in page.tags if (a.get("id") or "").startswith("figure-")}
    assert names == {
        "figure-total_contact_fraction-over-speed",
        "figure-total_friction-over-speed",
        "figure-friction_by_decade-over-decade",
        "figure-running_contact_fraction-per-wave",
        "figure-running_friction-per-wave",
        "figure-contact_fraction-per-wave",
    }


def test_folder_of_a_study_is_found(study_file: Path) -> None:
    path = write_report(study_file.parent)
    assert "Study of <contact>" in Page(path).text
    path.unlink()
