"""The table a person reads: its numbers, its units, its width."""

from __future__ import annotations

import pytest

from gripscale.chain import ChainError, Prediction, predict
from gripscale.report import as_text, prediction_table, significant, totals

from .stand_ins import THREE, Scripted, Spring

LOAD = {"pressure": 3e5, "speed": 0.25, "footprint": 0.1}


def solved(**changes: float) -> Prediction:
    return predict(Spring(), THREE, solver=Scripted([0.5, 0.25, 0.125]), **{**LOAD, **changes})


def row(text: str, wave: int) -> list[str]:
    return next(line.split() for line in text.splitlines() if line.split()[:1] == [str(wave)])


def test_a_wave_fills_its_row() -> None:
    text = as_text(prediction_table(solved(), "Dynamic", 120), width=120)
    assert row(text, 2) == [
        *("2", "4.00", "0.500", "0.79", "0.600", "5.00", "0.75*"),
        *("0.250", "0.1250", "0.250", "0.375", "0.188", "0.50-1.50", "6", "converged"),
    ]
    assert "3 waves: real contact area A_r/A_0 = 0.0156, friction mu = 0.875" in text
    assert "(0.656 from dissipation)" in text
    assert "at most 25.00% apart" in text
    assert "* the wave, or a harmonic of it" in text


@pytest.mark.parametrize("width", [80, 100, 120])
def test_nothing_is_cut_off(width: int) -> None:
    text = as_text(prediction_table(solved(), "Dynamic", width), width=width)
    assert max(map(len, text.splitlines())) <= width
    assert "…" not in text
    for cell in ("0.600", "5.00", "0.1250", "0.375", "0.188", "0.50-1.50", "converged"):
        assert cell in text


def test_hundred_columns_hold_one_table_and_eighty_two() -> None:
    headings = [
        as_text(prediction_table(solved(), "Dynamic", width), width=width).count("#")
        for width in (100, 80)
    ]
    assert headings == [1, 2]


def test_nothing_at_rest_has_friction() -> None:
    text = as_text(prediction_table(solved(speed=0.0), "Static", 120), width=120)
    assert row(text, 1)[6] == "-"
    assert row(text, 1)[9:12] == ["-", "-", "-"]
    assert "no friction at rest" in text


def test_failed_wave_has_no_totals() -> None:
    solver = Scripted([0.5, 0.5, 0.5], statuses=["converged", "iteration limit", "converged"])
    with pytest.raises(ChainError) as caught:
        predict(Spring(), THREE, solver=solver, **LOAD)
    partial = caught.value.partial
    assert totals(partial) == "No totals: wave 2 did not converge (iteration limit)."
    assert "iteration limit" in as_text(prediction_table(partial, "Dynamic", 100), width=100)


@pytest.mark.parametrize("width", [80, 100])
def test_long_status_is_wrapped_not_cut_off(width: int) -> None:
    status = "active set not settled after 200 iterations, and the load step was cut 14 times"
    solver = Scripted([0.5, 0.5, 0.5], statuses=["converged", status, "converged"])
    with pytest.raises(ChainError) as caught:
        predict(Spring(), THREE, solver=solver, **LOAD)
    text = as_text(prediction_table(caught.value.partial, "Dynamic", width), width=width)
    table = text[: text.index("No totals")]
    assert set(status.split()) <= set(table.split())
    assert max(map(len, table.splitlines())) <= width


def test_brackets_are_text_not_markup() -> None:
    assert as_text("lag [mm], [bold]", "x") == "lag [mm], [bold]\nx\n"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.079281, "0.0793"),
        (26.99, "27.0"),
        (4545.0, "4545"),
        (1.5e-7, "1.50e-07"),
        (2.5e9, "2.50e+09"),
        (float("nan"), "-"),
        (float("inf"), "inf"),
    ],
)
def test_significant_digits(value: float, text: str) -> None:
    assert significant(value) == text
