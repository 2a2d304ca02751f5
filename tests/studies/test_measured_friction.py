"""The page beside measured friction states what its study finds."""

import re

import numpy as np
import pytest

from studies import dry_law
from studies import measured_friction as study
from tests.samples import ROOT

PAGE = (ROOT / "docs" / "beside-measured-friction.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", dry_law.COMPOUNDS)
def test_a_compound_from_the_other_four(name: str) -> None:
    row = dry_law.each_left_out(dry_law.points(), dry_law.COMPOUNDS)[name]
    stated = re.search(rf"\| {name}[^|]* \| {row.inside} of {row.points} \| (\d+) %", PAGE)
    assert stated is not None
    assert float(stated[1]) == pytest.approx(100.0 * row.rms, abs=0.5)


def test_nine_in_ten_dry_points_are_held() -> None:
    """The interval is one of 90 %; of 29 points fewer than 24 would be chance once in fifty."""
    rows = dry_law.each_left_out(dry_law.points(), dry_law.COMPOUNDS).values()
    held, points = sum(row.inside for row in rows), sum(row.points for row in rows)
    assert f"{held} of\n{points} points" in PAGE
    assert held / points >= 0.85


@pytest.mark.parametrize("surface", study.SURFACES)
def test_hysteresis_is_below_soapy_water(surface: str) -> None:
    low, high, inside, points = study.shortfall(surface)
    row = next(line for line in PAGE.splitlines() if line.startswith(f"| {surface}"))
    assert f"{low:.2g} to {high:.2g} | {inside} of {points}" in row


def test_order_of_compounds() -> None:
    right, count = study.order()
    assert f"{right} of {count} pairs" in PAGE


def test_the_dry_law_is_no_better_than_another_compound() -> None:
    other = study.other_compound(dry_law.points())
    assert f"the same speed | | {100.0 * other:.0f} % |" in PAGE


def test_figures_show_every_compound() -> None:
    titles = [axes.get_title() for axes in study.draw_dry(dry_law.points()).axes]
    assert set(dry_law.COMPOUNDS) < set(titles)
    measured = [
        line.get_ydata()
        for axes in study.draw_soapy().axes
        for line in axes.get_lines()
        if line.get_label() in study.SURFACES
    ]
    assert sum(np.isfinite(np.asarray(y, float)).sum() for y in measured) == 20
