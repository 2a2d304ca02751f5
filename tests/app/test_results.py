"""What the page shows of a run is what the run left in its folder."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from gripscale.app.run_tabs import compared_runs
from gripscale.questions.inputs.charts_of_rubber import rubber_charts
from gripscale.questions.page_of_folder import read_result
from tests.run_case import run_case

from .conftest import CASE


@pytest.fixture(scope="module")
def ran(small: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a run."""
    place = tmp_path_factory.mktemp("ran")
    for name in ("road.txt", "dma.txt"):
        shutil.copy(small / name, place)
    (place / "case.toml").write_text(CASE.replace("../elsewhere/", ""))
    run_case(place / "case.toml", place / "out")
    return place / "out"


def test_runs_are_compared_by_their_answers(ran: Path) -> None:
    text = (ran / "case.toml").read_text()
    faster = text.replace('speed = "', 'speed = "1')
    runs = [
        SimpleNamespace(name=f"run-{number}", text=case, folder=ran, running=False)
        for number, case in enumerate((text, faster), start=1)
    ]
    table = compared_runs(SimpleNamespace(all=runs))
    columns = {column.name: list(column.values) for column in table.columns}
    assert columns["answer"] == [read_result(ran).lines[0]] * 2
    assert columns["changes"][0] == ""
    assert columns["changes"][1].startswith("load.speed = 1")


def test_a_fit_before_any_run_has_no_diamonds(ran: Path) -> None:
    result = read_result(ran)
    for excited, drawn in ((None, False), (result.chain, True)):
        moduli, factor, *_ = rubber_charts(result.inputs, excited)
        assert ["Diamonds" in chart.caption for chart in (moduli, factor)] == [drawn, drawn]
