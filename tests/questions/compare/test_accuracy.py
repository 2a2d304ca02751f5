"""More windows are solved while they narrow the estimate, and no longer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

from gripscale.questions.compare.comparison import windows_left
from gripscale.questions.compare.ladder import MOST_WINDOWS, chosen
from tests.questions.compare.test_corrections import SUBJECT

Make = Callable[..., xr.Dataset]
FAILED = {"prediction_status": "profile too rough", "prediction_status_word": "profile too rough"}


@pytest.fixture
def left(solved: Make, together: Make) -> Callable[..., bool]:
    """Ask whether windows are left to solve, their ratios to small strain being given."""

    def ask(*ratios: float | None, wanted: int = 3, half_width: float = 0.2) -> bool:
        names = [f"window {number}" for number in range(len(ratios))]
        small = solved(*((0.05, 0.1, name) for name in names))
        finite = solved(
            *(
                FAILED | {"subject": name} if ratio is None else (0.05 * ratio, 0.1 * ratio, name)
                for ratio, name in zip(ratios, names, strict=True)
            )
        )
        samples = together(windows_half_plane=small, windows_finite_strain=finite)
        widths = {
            f"answer_{name}_half_width": half_width for name in ("friction", "contact_fraction")
        }
        comparison: Any = SimpleNamespace(
            samples=samples, setups=[SimpleNamespace(windows=wanted)], data=xr.Dataset(widths)
        )
        return windows_left(comparison, 0.1)

    return ask


def test_three_that_agree_are_enough(left: Callable[..., bool]) -> None:
    assert not left(0.98, 0.98, 0.97)


def test_one_that_failed_is_replaced(left: Callable[..., bool]) -> None:
    assert left(0.98, None, 0.97)
    assert not left(0.98, None, 0.97, 0.98, wanted=4)


def test_scatter_asks_for_more_until_the_rest_hides_it(left: Callable[..., bool]) -> None:
    assert left(0.9, 1.0, 0.8)
    assert not left(0.9, 1.0, 0.8, half_width=0.6)


def test_no_more_than_there_are(left: Callable[..., bool]) -> None:
    assert not left(0.9, 1.0, 0.8, wanted=4)


def test_the_first_windows_are_spread_over_the_profile() -> None:
    (member, _), length = chosen(["windows"]), SUBJECT.lines[0].length
    every = member.draws(replace(SUBJECT, windows=MOST_WINDOWS))
    starts = [float(spec.subject.split()[-2]) for spec in every]
    assert len(starts) == MOST_WINDOWS
    assert len(set(starts)) == MOST_WINDOWS
    for count in (2, 4, 8):
        gaps = np.diff(sorted(starts[:count]))
        assert gaps.min() > 0.8 * length / count * (1.0 - 1.0 / MOST_WINDOWS)
