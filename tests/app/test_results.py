"""What the page shows of a run is what the run left in its folder."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

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


def test_a_fit_before_any_run_has_no_diamonds(ran: Path) -> None:
    result = read_result(ran)
    for excited, drawn in ((None, False), (result.chain, True)):
        moduli, factor, *_ = rubber_charts(result.inputs, excited)
        assert ["Diamonds" in chart.caption for chart in (moduli, factor)] == [drawn, drawn]
