"""Each statement is judged by its number: made-up numbers that keep it, and ones that break it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from reproduction import judge_area, judge_friction
from reproduction.inputs import DENSE, FAST, FASTEST, ROAD, SBR, SPEED, TREAD
from reproduction.panels import Solved, speed_name
from reproduction.statement import Statement, as_markdown

WAVELENGTHS = 20e-3 / 3.0 ** np.arange(5)


def prediction(area: Any, friction: Any = None, factor: float = 3.0, **per_wave: Any) -> xr.Dataset:
    """Return a prediction with the given running areas and frictions of the waves."""
    area = np.asarray(area, dtype=float)
    friction = np.zeros(area.size) if friction is None else np.asarray(friction, dtype=float)
    columns = {
        "wavelength": 20e-3 / factor ** np.arange(area.size),
        "running_contact_fraction": area,
        "friction": friction,
        "running_friction": np.cumsum(friction),
        "slope": np.full(area.size, 0.5),
        **{name: np.asarray(values, dtype=float) for name, values in per_wave.items()},
    }
    data = {name: ("scale", values) for name, values in columns.items()}
    scale = np.arange(1, area.size + 1)
    return xr.Dataset(data | {"prediction_status": "converged"}, coords={"scale": scale})


def verdicts(statements: list[Statement]) -> list[bool]:
    for statement in statements:
        assert statement.holds in (True, False)
        assert statement.criterion
        assert statement.number
        assert statement.holds or statement.figure
    return [statement.holds for statement in statements]


SETTLING = [0.3, 0.15, 0.11, 0.095, 0.09]


def three(worst: list[float]) -> Solved:
    good = prediction(SETTLING)
    return {DENSE: {"a": good, "b": good, "c": prediction(worst)}}


def test_progression() -> None:
    assert verdicts(judge_area.judge_progression("fig5a", three(SETTLING))) == [True, True]
    away = [0.3, 0.15, 0.10, 0.07, 0.06]
    same, _ = judge_area.judge_progression("fig5a", three(away))
    assert not same.holds
    assert "without the pair that fits worst the others are 0% apart" in same.why_not
    steeper = [0.3, 0.25, 0.2, 0.13, 0.072]
    assert not judge_area.judge_progression("fig5a", three(steeper))[1].holds


def test_motion() -> None:
    rest = {DENSE: {"a": prediction(SETTLING)}}
    moving = {DENSE: {"a": prediction([0.2, 0.08, 0.05, 0.035])}}  # its last wave failed
    assert verdicts(judge_area.judge_motion(rest, moving)) == [True]
    assert verdicts(judge_area.judge_motion(moving, rest)) == [False]
    flatter = {DENSE: {"a": prediction([0.1, 0.08, 0.07, 0.068, 0.067])}}
    assert verdicts(judge_area.judge_motion(rest, flatter)) == [False]


def test_speed_and_area() -> None:
    def over_speed(*areas: list[float]) -> Solved:
        static = {"static": prediction([0.01, 0.01, 0.01])}
        return {TREAD: static | {f"{i} mm/s": prediction(area) for i, area in enumerate(areas)}}

    falling = over_speed([0.3, 0.1, 0.05], [0.25, 0.08, 0.03], [0.2, 0.06])
    assert verdicts(judge_area.judge_speed(falling)) == [True]
    assert verdicts(judge_area.judge_speed(over_speed([0.3, 0.1], [0.2, 0.11]))) == [False]
    assert verdicts(judge_area.judge_speed(over_speed([0.3, 0.1], [0.1, 0.05]))) == [False]


def test_stiffness() -> None:
    def compounds(modulus: list[float], area: list[float]) -> Solved:
        sbr = prediction([0.5, 0.3], modulus=[1e6, 2e6])
        return {speed_name(SPEED): {TREAD: prediction(area, modulus=modulus), SBR: sbr}}

    assert verdicts(judge_area.judge_stiffness(compounds([5e6, 6e6], [0.2, 0.1]))) == [True]
    assert verdicts(judge_area.judge_stiffness(compounds([5e6, 6e6], [0.2, 0.4]))) == [False]
    assert verdicts(judge_area.judge_stiffness(compounds([5e6, 1e6], [0.2, 0.1]))) == [False]


def test_surfaces() -> None:
    coarse = prediction([0.2, 0.1, 0.06, 0.05, 0.04])
    for last, holds in ((0.055, True), (0.0785, False), (0.2, False)):
        dense = prediction([0.4, 0.2, 0.12, 0.1, last])
        solved = {"300 mm/s": {ROAD: coarse, DENSE: dense}}
        assert verdicts(judge_area.judge_surfaces("fig7a", solved)) == [holds]


def test_worst_fit_departs_at_small_waves_only() -> None:
    good = prediction(SETTLING, [0.02, 0.03, 0.05, 0.08, 0.12])

    def with_worst(*friction: float) -> Solved:
        worst = prediction([0.3, 0.1, 0.05], friction, factor=9.0)
        return {DENSE: {"a": good, "b": good, "c": worst}}

    assert verdicts(judge_friction.judge_factors_friction(with_worst(0.02, 0.055, 0.2))) == [True]
    assert verdicts(judge_friction.judge_factors_friction(with_worst(0.02, 0.055, 0.13))) == [False]
    assert verdicts(judge_friction.judge_factors_friction(with_worst(0.02, 0.09, 0.2))) == [False]


def test_maximum_of_friction_comes_sooner(inputs: Any) -> None:
    def speeds(*frictions: list[float]) -> Solved:
        lines = {f"{i} mm/s": prediction(SETTLING, each) for i, each in enumerate(frictions)}
        return {SBR: lines}

    slow, middle, fast = (
        [0.02, 0.03, 0.05, 0.08, 0.1],
        [0.03, 0.05, 0.08, 0.11, 0.1],
        [0.05, 0.08, 0.1, 0.09, 0.07],
    )
    judge = judge_friction.judge_speed_friction
    assert verdicts(judge(speeds(slow, middle, fast), inputs)) == [True, True]
    assert verdicts(judge(speeds(slow, fast, middle), inputs)) == [True, False]
    rises, sooner = judge(speeds(slow, slow), inputs)
    assert (rises.holds, sooner.holds) == (True, False)
    assert "different inputs: the loss factor of this compound" in sooner.why_not
    assert verdicts(judge(speeds([0.05, 0.02, 0.06, 0.07, 0.08], fast), inputs))[0] is False


def test_compounds(inputs: Any) -> None:
    def at(lead: list[float], loss: list[float]) -> dict[str, xr.Dataset]:
        tread = np.full(5, 0.1)
        return {
            TREAD: prediction(SETTLING, tread, loss_factor=np.full(5, 0.2)),
            SBR: prediction(SETTLING, tread + lead, loss_factor=loss),
        }

    lossier = [0.2, 0.19, 0.3, 0.4, 0.5]
    together = at([0.01, -0.01, 0.1, 0.2, 0.02], lossier)
    names = [speed_name(speed) for speed in (SPEED, FAST, FASTEST)]
    judge = judge_friction.judge_compounds
    assert verdicts(judge(dict.fromkeys(names, together), inputs)) == [True] * 7
    apart = at([0.1, -0.01, -0.1, 0.15, 0.2], lossier)
    judged = judge({names[0]: apart, names[1]: together, names[2]: together}, inputs)
    assert verdicts(judged) == [False, False, True, True, False, True, True]
    assert "the lead falls from 0.200 to 0.020" in judged[4].why_not


def test_steeper_surface(inputs: Any) -> None:
    def surfaces(coarse: xr.Dataset, dense: xr.Dataset) -> Solved:
        return {"300 mm/s": {ROAD: coarse, DENSE: dense}}

    more, less = prediction([0.2, 0.05], [0.1, 0.2]), prediction([0.3, 0.1], [0.05, 0.1])
    judge = judge_friction.judge_surface_friction
    assert verdicts(judge(surfaces(more, less), inputs)) == [True]
    assert verdicts(judge(surfaces(less, more), inputs)) == [False]


def test_table_holds_every_statement() -> None:
    kept = Statement("fig6a", "area | falls", "here", "less than 1", "0.5", True)
    broken = Statement("fig7a", "less", "there", "more", "2", False, "different inputs: steeper")
    page = as_markdown([kept, broken])
    assert "1 of 2 statements hold" in page
    assert "| fig6a | area \\| falls | here | less than 1 | 0.5 | **holds** |" in page
    assert "**does not hold**: different inputs: steeper |" in page
