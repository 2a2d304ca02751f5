"""The answer of a study: how its numbers run, with intervals of a measured surface; its page."""

import re

import numpy as np
import pytest
import xarray as xr

from gripscale.case_file import read_case
from gripscale.core.status import Status
from gripscale.io import netcdf
from gripscale.io.table import significant
from gripscale.questions import Study, Variation
from gripscale.questions.inputs.page import input_sections
from gripscale.questions.page_of_folder import read_result, write_report
from gripscale.questions.vary.charts import stacked_panels, study_pictures, totals_figure
from gripscale.questions.view import course
from gripscale.report.elements import Facts
from gripscale.surface import Profile, self_affine_profile
from tests.samples import EXAMPLES, HALF_PLANE, case_text, write_road

from .reading import Page

ROAD = case_text(
    'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "2 mm"', solver=HALF_PLANE
)

FRICTION = {"long_name": "friction coefficient", "symbol": "μ"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("road")
    road = self_affine_profile(0.8, 3e-3, 4e-4, length=0.4, step=2e-4, seed=1)
    write_road(folder / "road.txt", Profile(road.x, road.z))
    (folder / "case.toml").write_text(ROAD)
    return folder


@pytest.fixture(scope="module")
def solved(folder):
    """Two speeds, one of them that of the case."""
    study = Study(read_case(folder / "case.toml"), {"speed": [0.3, 3.0]})
    assert study.model.name == "direct"
    return study.run(folder / "study")


def test_lines_cards_and_page_lead_with_the_range_and_its_factors(solved, folder):
    answer, held, factors, _ = Variation(solved).lines
    low, high = (significant(float(value)) for value in solved.answer_friction)
    assert answer.startswith(f"Answer: friction coefficient μ from {low} (")
    assert f" at 0.3 m/s to {high} (" in answer
    assert answer.endswith(" at 0.3 m/s (90 % intervals).")
    assert held == "  for 3 bar, roughness down to 2 mm, 2 predictions, none without a result"
    assert factors.startswith("  from direct contact of the measured surface × large strain")
    friction, area = Variation(solved).cards()
    assert friction.value == f"{low} to {high}"
    assert friction.detail.endswith("(90 %)")
    assert area.label == "Real contact area A_r/A_0"
    page = Page(write_report(folder / "study" / "study.nc", folder / "page.html"))
    head = page.text.partition("Inputs and their origin")[0]  # up to the table of contents
    assert f"{low} to {high}" in head
    assert "Answer: friction coefficient μ from" in head


def test_table_and_figure_have_the_interval(solved):
    names = [column.name for column in Variation(solved).table().columns]
    assert names[1:5] == [
        "answer_friction",
        "answer_friction_interval",
        "answer_contact_fraction",
        "answer_contact_fraction_interval",
    ]
    figure = totals_figure(solved)
    bands = [place for axes in figure.axes for place in axes.collections]
    assert len(bands) == 2
    top = max(path.vertices[:, 1].max() for path in bands[1].get_paths())
    assert top == pytest.approx(float(solved.answer_friction_high.max()))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ([0.1, 0.2, 0.3], "from 0.100 at 0.1 m/s to 0.300 at 10 m/s"),
        ([0.2, 0.1, 0.3], "from 0.100 at 1 m/s to 0.300 at 10 m/s"),
        ([np.nan, 0.2, 0.1], "from 0.100 at 10 m/s to 0.200 at 1 m/s"),
        ([np.nan, np.nan, np.nan], ""),
    ],
)
def test_course_of_a_number(values, words):
    speed = xr.Variable("speed", [0.1, 1.0, 10.0], {"units": "m/s"})
    data = xr.Dataset({"total_friction": ("speed", values, FRICTION)}, {"speed": speed})
    assert course(data, "total_friction") == (f"friction coefficient μ {words}" if words else "")


@pytest.fixture(scope="module")
def page(study_file):
    """The page of the folder of the study."""
    return Page(write_report(study_file.parent))


def test_failed_prediction_is_loud(page):
    alerts = [a for _, a in page.tags if a.get("role") == "alert"]
    assert len(alerts) == 1
    assert "Study: tread on <contact>" in page.text
    assert "1 of 4 predictions failed; the first: wave 3 of 3" in page.text
    assert Status.ITERATION_LIMIT.advice in page.text
    marked = [tag for tag, a in page.tags if "bad" in (a.get("class") or "").split()]
    assert marked.count("th") == 1  # a head in each row
    assert marked.count("td") == len(page.body("study")[0]) - 1


def test_page_speaks_in_words_and_has_its_inputs(page):
    shown = page.text.partition("Case file")[0].partition("Command")[0]
    shown = shown.replace(Status.ITERATION_LIMIT.advice, "")  # names a setting
    assert not re.findall(r"\b[a-z]+_[a-z]\w+", shown.replace("A_r", "").replace("λ_min", ""))
    assert "{" not in shown
    titles = [a["id"] for tag, a in page.tags if tag in ("section", "details") and "id" in a]
    assert titles[:4] == ["results", "inputs", "method", "again"]
    assert "Answer by the model, without an interval: friction coefficient μ from 0." in shown
    for words in ("Nominal pressure 3 bar", "Sliding speed varied", "Footprint 100 mm"):
        assert words in page.text


def test_inputs_of_a_study_are_read_from_its_attributes(study_file):
    """Whatever the text of its case says."""
    source = read_result(study_file)
    assert isinstance(source, Variation)
    attrs = {"display_units": '{"pressure": "kPa"}', "case": "no = toml = at all"}
    load = input_sections(source.data.assign_attrs(attrs))[0].elements[0]
    assert isinstance(load, Facts)
    facts = dict(load.pairs)
    assert (facts["Nominal pressure"], facts["Footprint"]) == ("300 kPa", "100 mm")


@pytest.fixture(scope="module")
def over_speeds(tmp_path_factory):
    """A study over seven speeds at two pressures, of a case with the half-plane."""
    folder = tmp_path_factory.mktemp("over_speeds")
    case = EXAMPLES / "measured_friction" / "case.toml"
    vary = {"speed": "0.01:10:log7", "pressure": "1 bar,3 bar"}
    return netcdf.save(Study(read_case(case), vary).run(folder), folder / "study.nc")


def test_parts_of_friction_are_stacked_to_the_whole(over_speeds):
    data = netcdf.load_dataset(over_speeds).isel(pressure=0)
    panels = stacked_panels(data)
    for name, whole in (("stacked", data.total_friction), ("decades", 1.0)):
        *bands, total = panels[name].marks
        assert len(bands) > 1
        assert all((band.high >= band.low).all() for band in bands)
        np.testing.assert_allclose(total.y, whole + 0.0 * data.total_friction, rtol=1e-9)
    assert {"stacked", "decades"} <= {picture.name for picture in study_pictures(data)}
