"""The answer of a study: how its numbers run, with intervals where the surface was measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from gripscale.case_file import read_case
from gripscale.io.table import significant
from gripscale.questions import Study, Variation
from gripscale.questions.page_of_folder import write_report
from gripscale.questions.vary.charts import totals_figure
from gripscale.questions.view import course
from gripscale.surface import Profile, self_affine_profile
from tests.samples import HALF_PLANE, case_text, write_road

from .reading import Page

ROAD = case_text(
    'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "2 mm"', solver=HALF_PLANE
)

FRICTION = {"long_name": "friction coefficient", "symbol": "μ"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("road")
    road = self_affine_profile(0.8, 3e-3, 4e-4, length=0.4, step=2e-4, seed=1)
    write_road(folder / "road.txt", Profile(road.x, road.z))
    (folder / "case.toml").write_text(ROAD)
    return folder


@pytest.fixture(scope="module")
def solved(folder: Path) -> xr.Dataset:
    """Two speeds, one of them that of the case."""
    study = Study(read_case(folder / "case.toml"), {"speed": [0.3, 3.0]})
    assert study.model.name == "direct"
    return study.run(folder / "study")


def test_lines_say_numbers_load_and_factors(solved: xr.Dataset) -> None:
    answer, held, factors, rests = Variation(solved).lines
    first, last = (significant(float(value)) for value in solved.answer_friction)
    assert answer.startswith(f"Answer: friction coefficient μ from {first} (")
    assert f" at 0.3 m/s to {last} (" in answer
    assert answer.endswith(" at 0.3 m/s (90 % intervals).")
    assert held == "  for 3 bar, roughness down to 2 mm, 2 predictions, none without a result"
    assert factors.startswith("  from direct contact of the measured surface × large strain")
    assert rests.endswith("intervals leave out errors of the master curve")


def test_table_and_figure_have_the_interval(solved: xr.Dataset) -> None:
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


def test_page_begins_with_the_answer(solved: xr.Dataset, folder: Path) -> None:
    page = Page(write_report(folder / "study" / "study.nc", folder / "page.html"))
    low, high = (significant(float(value)) for value in solved.answer_friction)
    head = page.text.partition("Inputs and their origin")[0]  # up to the table of contents
    assert f"{low} to {high}" in head
    assert "answer; ±" in head
    assert "Answer: friction coefficient μ from" in head
    figures = [a["id"] for _, a in page.tags if (a.get("id") or "").startswith("figure-")]
    assert figures[0] == "figure-totals"


def test_the_chain_says_that_the_surface_could_answer(folder: Path) -> None:
    study = Study(read_case(folder / "case.toml"), {"speed": [0.3, 3.0]}, model="chain")
    data = study.run(folder / "chain")
    assert "answer_friction" not in data
    answer, _, advice = Variation(data).lines
    assert answer.startswith("Answer by the chain of sine waves, without an interval: friction")
    assert "`--model direct`" in advice


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ([0.1, 0.2, 0.3], "from 0.100 at 0.1 m/s to 0.300 at 10 m/s"),
        ([0.2, 0.1, 0.3], "from 0.100 at 1 m/s to 0.300 at 10 m/s"),
        ([np.nan, 0.2, 0.1], "from 0.100 at 10 m/s to 0.200 at 1 m/s"),
        ([np.nan, np.nan, np.nan], ""),
    ],
)
def test_course_of_a_number(values: list[float], words: str) -> None:
    speed = xr.Variable("speed", [0.1, 1.0, 10.0], {"units": "m/s"})
    data = xr.Dataset({"total_friction": ("speed", values, FRICTION)}, {"speed": speed})
    assert course(data, "total_friction") == (f"friction coefficient μ {words}" if words else "")


def test_names_are_said_by_lowest_and_highest() -> None:
    data = xr.Dataset(
        {"total_friction": (("rubber", "speed"), [[0.1, 0.2], [0.4, 0.3]], FRICTION)},
        {
            "rubber": np.array(["a", "b"], dtype=object),
            "speed": ("speed", [0.1, 1.0], {"units": "m/s"}),
        },
    )
    words = "friction coefficient μ from 0.100 at a, 0.1 m/s to 0.400 at b, 0.1 m/s"
    assert course(data, "total_friction") == words
