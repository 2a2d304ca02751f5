"""The page of a study, read without a browser."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from gripscale.case_file import read_case
from gripscale.core.status import Status
from gripscale.io import netcdf
from gripscale.questions import Study, Variation
from gripscale.questions import page_of_folder as results
from gripscale.questions.inputs.page import input_sections
from gripscale.questions.page_of_folder import write_report
from gripscale.questions.vary.charts import stacked_panels, study_pictures
from gripscale.report.elements import Facts
from tests.samples import EXAMPLES

from .reading import Page


@pytest.fixture(scope="module")
def page(study_file: Path) -> Page:
    """The page of the folder of the study."""
    return Page(write_report(study_file.parent))


def test_page_begins_with_the_answer_of_its_model(page: Page) -> None:
    assert "Study: tread on <contact>" in page.text
    head = page.text.partition("Inputs and their origin")[0]
    assert "Answer by the model, without an interval: friction coefficient μ from 0." in head
    assert "4 predictions, 1 without a result" in head


def test_failed_prediction_is_loud(page: Page) -> None:
    alerts = [a for _, a in page.tags if a.get("role") == "alert"]
    assert len(alerts) == 1
    assert "1 of 4 predictions failed; the first: wave 3 of 3" in page.text
    assert "gripscale docs reading-results#statuses-and-what-to-do-about-them" in page.text
    assert Status.ITERATION_LIMIT.advice in page.text
    marked = [tag for tag, a in page.tags if "bad" in (a.get("class") or "").split()]
    assert marked.count("th") == 1  # a head in each row
    assert marked.count("td") == len(page.body("study")[0]) - 1


def test_page_speaks_in_words_and_has_its_inputs(page: Page) -> None:
    shown = page.text.partition("Case file")[0].partition("Command")[0]
    shown = shown.replace(Status.ITERATION_LIMIT.advice, "")  # names a setting
    assert not re.findall(r"\b[a-z]+_[a-z]\w+", shown.replace("A_r", "").replace("λ_min", ""))
    assert "{" not in shown
    titles = [a["id"] for tag, a in page.tags if tag in ("section", "details") and "id" in a]
    assert titles[:4] == ["results", "inputs", "method", "again"]
    for words in ("Nominal pressure 3 bar", "Sliding speed varied", "Footprint 100 mm"):
        assert words in page.text


def test_inputs_of_a_study_are_read_from_its_attributes(study_file: Path) -> None:
    """Whatever the text of its case says."""
    source = results.read_result(study_file)
    assert isinstance(source, Variation)
    attrs = {"display_units": '{"pressure": "kPa"}', "case": "no = toml = at all"}
    load = input_sections(source.data.assign_attrs(attrs))[0].elements[0]
    assert isinstance(load, Facts)
    facts = dict(load.pairs)
    assert (facts["Nominal pressure"], facts["Footprint"]) == ("300 kPa", "100 mm")


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study over seven speeds at two pressures, of a case with the half-plane."""
    folder = tmp_path_factory.mktemp("solved")
    case = EXAMPLES / "measured_friction" / "case.toml"
    vary = {"speed": "0.01:10:log7", "pressure": "1 bar,3 bar"}
    return netcdf.save(Study(read_case(case), vary).run(folder), folder / "study.nc")


def test_parts_of_friction_are_stacked_to_the_whole(solved: Path) -> None:
    data = netcdf.load_dataset(solved).isel(pressure=0)
    panels = stacked_panels(data)
    for name, whole in (("stacked", data.total_friction), ("decades", 1.0)):
        *bands, total = panels[name].marks
        assert len(bands) > 1
        assert all((band.high >= band.low).all() for band in bands)
        np.testing.assert_allclose(total.y, whole + 0.0 * data.total_friction, rtol=1e-9)
    assert {"stacked", "decades"} <= {picture.name for picture in study_pictures(data)}
