"""What the page shows of a run is what the run left in its folder."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from gripscale.app.elements import Cards, Folded, html, notice_elements
from gripscale.app.run_tabs import ComparedRun, answer_elements, runs_table
from gripscale.case_file import read_case_file
from gripscale.charts.bokeh_parts import model
from gripscale.charts.page_elements import Chart
from gripscale.core.finding import Finding, Severity
from gripscale.questions import page_of_folder
from gripscale.questions.answer.answer import answer
from gripscale.questions.chain.run_page import RunSource
from gripscale.questions.inputs.charts_of_rubber import rubber_charts
from gripscale.questions.page_of_folder import page_of
from gripscale.report.elements import Element, Text
from tests.run_case import run_case

from .conftest import CASE

MEASURED = """\
speed [m/s],temperature [C],friction,spread
0.1,20,0.5,0.02
1,20,0.7,0.03
1,40,0.6,
"""


@pytest.fixture(scope="module")
def ran(small: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a run whose case names measured friction."""
    place = tmp_path_factory.mktemp("ran")
    for name in ("road.txt", "dma.txt"):
        shutil.copy(small / name, place)
    (place / "friction.csv").write_text(MEASURED)
    text = CASE.replace("../elsewhere/", "") + '[measured]\nfriction = "friction.csv"\n'
    (place / "case.toml").write_text(text)
    run = run_case(read_case_file(place / "case.toml"), output=place / "out")
    answer(run.case).save(place / "out" / "answer.nc")
    return place / "out"


def results_elements(folder: Path) -> list[Element]:
    """Return everything below the head of the page of a run."""
    sections = page_of(page_of_folder.read_result(folder)).sections
    return [element for section in sections for element in section.elements]


def test_measured_friction_is_drawn_with_what_is_predicted(ran: Path) -> None:
    charts = {one.name: one.figure for one in results_elements(ran) if isinstance(one, Chart)}
    figure = model(charts["measured-friction"])
    sources = [one.data_source.data for one in figure.renderers]
    pairs = [zip(data["x"], data["y"], strict=True) for data in sources if "x" in data]
    points = [point for pair in pairs for point in pair]
    assert {(0.1, 0.5), (1.0, 0.7), (1.0, 0.6)} <= set(points)
    predicted = [y for x, y in points if x == 0.3]
    assert len(predicted) == 2, "the chain and the direct contact"
    assert all(np.isfinite(predicted))
    labels = [one.label.value for one in figure.legend[0].items]
    assert labels == [
        "measured, 20 °C",
        "measured, 40 °C",
        "dynamic, hysteresis",
        "direct contact, hysteresis",
    ]


def test_three_warnings_are_open_and_the_others_folded() -> None:
    error = Finding(Severity.ERROR, "no result")
    warnings = [Finding(Severity.WARNING, str(number)) for number in range(5)]
    *opened, folded = notice_elements([*warnings, error])
    assert opened == [error, *warnings[:2]]
    assert folded == Folded(warnings[2:])
    assert list(notice_elements(warnings[:3])) == warnings[:3]
    markup = html(folded).object
    assert "<summary>3 more warnings</summary>" in markup


def test_runs_are_compared_by_their_answers(ran: Path) -> None:
    result = page_of_folder.read_result(ran)
    assert isinstance(result, RunSource)
    run = SimpleNamespace(text=(ran / "case.toml").read_text())
    dynamic, *rest = result.predictions
    assert result.direct is not None
    direct = result.direct.assign(answer_friction_low=0.1, answer_friction_high=0.2)  # longer road
    compared = [ComparedRun(run, dynamic, direct)]
    compared += [ComparedRun(run, view, None) for view in rest]
    columns = {column.name: column.values for column in runs_table(compared).columns}
    assert columns["answer_friction"][0] == float(result.direct.answer_friction)
    assert columns["answer_friction_interval"][0].tolist() == [0.1, 0.2]
    assert "answer_contact_fraction_interval" not in columns
    assert columns["friction"][0] == dynamic.total("friction")
    names = list(columns)
    assert names.index("answer_friction") < names.index("friction")
    alone = runs_table([ComparedRun(run, dynamic, None)])
    assert "answer_friction" not in {column.name for column in alone.columns}


def test_runs_without_an_answer_to_rely_on_say_so(ran: Path) -> None:
    result = page_of_folder.read_result(ran)
    assert isinstance(result, RunSource)
    run = SimpleNamespace(text=(ran / "case.toml").read_text(), folder=ran)
    dynamic = result.predictions[0]
    rows = [ComparedRun(run, dynamic, result.direct), ComparedRun(run, dynamic, None)]
    states = next(column.values for column in runs_table(rows).columns if column.name == "status")
    assert list(states) == ["answer not to be relied on", "complete"]
    reason, numbers, *others = answer_elements(run)
    assert reason.sentence.startswith("Answer: none to rely on. The measured surface is too small")
    assert isinstance(numbers, Cards)
    assert len(others) == 3, "two warnings and the others folded"


def test_a_fit_before_any_run_has_no_diamonds(ran: Path) -> None:
    result = page_of_folder.read_result(ran)
    assert isinstance(result, RunSource)
    for excited, drawn in ((None, False), (result.predictions[0].data, True)):
        moduli, factor, *_ = rubber_charts(result.inputs, excited)
        assert ["Diamonds" in chart.caption for chart in (moduli, factor)] == [drawn, drawn]


def test_the_chain_is_judged_by_what_is_stored(ran: Path) -> None:
    texts = [one.text for one in results_elements(ran) if isinstance(one, Text)]
    judged = [text for text in texts if text.startswith("For comparison, the paper's chain")]
    assert len(judged) == 1
    assert "times that of the answer" in judged[0]
    assert not (ran / "report.txt").exists()
    (ran / "answer.nc").rename(ran / "away")
    assert not any("For comparison" in getattr(e, "text", "") for e in results_elements(ran))
    (ran / "away").rename(ran / "answer.nc")
