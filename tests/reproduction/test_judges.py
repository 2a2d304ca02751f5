"""Each statement is judged by its number: made-up numbers that keep it, and ones that break it."""

import numpy as np
import xarray as xr

from gripscale.reproduction import judges
from gripscale.reproduction.figures import TITLES, pair_name
from gripscale.reproduction.inputs import (
    COARSE,
    DENSE,
    FAST,
    FILLED_TREAD,
    R20,
    R60,
    SBR,
    SPEED,
)
from gripscale.reproduction.judges import Evidence
from gripscale.reproduction.run import CLAIMS, judged
from gripscale.reproduction.statement import Statement, as_markdown, number_holding

WAVELENGTHS = 20e-3 / 3.0 ** np.arange(5)


def prediction(area, friction=None, factor=3.0, **per_wave):
    """Return a prediction with the given running areas and frictions of the waves."""
    area = np.asarray(area, dtype=float)
    friction = np.zeros(area.size) if friction is None else np.asarray(friction, dtype=float)
    columns = {
        "wavelength": 20e-3 / factor ** np.arange(area.size),
        "running_contact_fraction": area,
        "friction": friction,
        "running_friction": np.cumsum(friction),
        "contact_fraction": area / np.append(1.0, area[:-1]),
        "slope": np.full(area.size, 0.5),
        "loss_factor": np.linspace(0.1, 0.5, area.size),
        "modulus": np.full(area.size, 5e6),
        **{name: np.asarray(values, dtype=float) for name, values in per_wave.items()},
    }
    data = {name: ("scale", values) for name, values in columns.items()}
    scale = np.arange(1, area.size + 1)
    return xr.Dataset(
        data | {"prediction_status": "converged", "nominal_speed": 0.0}, coords={"scale": scale}
    )


def judge(figure, inputs, solved, rest=None):
    return judged(figure, Evidence(inputs, solved, rest or {}))


def verdicts(statements):
    for statement in statements:
        assert statement.figure
        assert statement.criterion
        assert statement.number
        assert bool(statement.why_not) == (statement.holds is not True)
    return [statement.holds for statement in statements]


SETTLING = [0.3, 0.15, 0.11, 0.095, 0.09]
DENSE_PAIRS = ("3.5/2.4", "3/2.2", "6/3")
"""The last fits worst."""


def three(worst):
    areas = (SETTLING, SETTLING, worst)
    lines = {name: prediction(area) for name, area in zip(DENSE_PAIRS, areas, strict=True)}
    return {DENSE: lines}


def test_progression(inputs):
    assert verdicts(judge("fig5a", inputs, three(SETTLING))) == [True, True]
    same, _ = judge("fig5a", inputs, three([0.3, 0.15, 0.10, 0.07, 0.06]))
    assert same.holds is False
    assert "without 6/3, which fits C_z worst, the others are 0% apart" in same.why_not
    assert judge("fig5a", inputs, three([0.3, 0.25, 0.2, 0.13, 0.072]))[1].holds is False


def test_a_curve_settles_if_it_is_level_before_as_many_decades_again(inputs):
    def settling(*slopes):
        area = 0.3 * 3.0 ** -np.append(0.0, np.cumsum(slopes))
        *_, settles = judge("fig5a", inputs, three(area))
        return settles

    # Factor 3, four waves: 3 steps so far. The slope falls over the 2 steps between its middles;
    # from 0.4 to 0.2 it is zero 2 steps after the last middle, 1.5 steps after the last wave.
    found = settling(0.4, 0.3, 0.2)
    assert found.holds
    assert f"6/3: 0.40 to 0.20, level {1.5 * np.log10(3.0):.1f} decades on" in found.number
    assert settling(0.44, 0.36, 0.28 - 1e-6).holds  # 0.28/0.16 * 2 - 0.5 = 3 steps
    found = settling(0.44, 0.36, 0.28 + 1e-3)
    assert found.holds is False
    assert "from each wave to the next, 2.00 times in 6/3, of 1.4 decades" in found.why_not
    assert settling(0.41, 0.40, 0.39).holds is False
    assert settling(0.3, 0.3, 0.4).holds is False


def test_motion(inputs):
    def in_motion(rest, moving):
        solved, still = ({DENSE: dict.fromkeys(DENSE_PAIRS, prediction(a))} for a in (moving, rest))
        return verdicts(judge("fig5b", inputs, solved, still))[2:]

    moving = [0.2, 0.08, 0.05, 0.035]  # its last wave failed
    assert in_motion(SETTLING, moving) == [True]
    assert in_motion([*moving, 0.03], SETTLING) == [False]
    assert in_motion(SETTLING, [0.1, 0.08, 0.07, 0.068, 0.067]) == [False]


def test_speed_and_area(inputs):
    def over_speed(*areas):
        lines = {"static": prediction([0.01, 0.01, 0.01])}
        lines |= {f"{i} mm/s": prediction(area) for i, area in enumerate(areas)}
        return verdicts(judge("fig6a", inputs, {FILLED_TREAD: lines}))

    assert over_speed([0.3, 0.1, 0.05], [0.25, 0.08, 0.03], [0.2, 0.06]) == [True]
    assert over_speed([0.3, 0.1], [0.2, 0.11]) == [False]
    assert over_speed([0.3, 0.1], [0.1, 0.05]) == [False]


def test_stiffness(inputs):
    def stiff(modulus, area):
        sbr = prediction([0.5, 0.3], modulus=[1e6, 2e6])
        lines = {FILLED_TREAD: prediction(area, modulus=modulus), SBR: sbr}
        panel = pair_name((FILLED_TREAD, SBR), FAST)
        return verdicts(judge("fig6b", inputs, {panel: lines}))

    assert stiff([5e6, 6e6], [0.2, 0.1]) == [True]
    assert stiff([5e6, 6e6], [0.2, 0.4]) == [False]
    assert stiff([5e6, 1e6], [0.2, 0.1]) == [None]
    assert stiff([0.5e6, 0.6e6], [0.6, 0.4]) == [True]  # the other one is stiffer


def test_surfaces(inputs):
    coarse = prediction([0.2, 0.1, 0.06, 0.05, 0.04])
    for last, holds in ((0.055, True), (0.0785, False), (0.2, False)):
        solved = {"300 mm/s": {COARSE: coarse, DENSE: prediction([0.4, 0.2, 0.12, 0.1, last])}}
        assert verdicts(judge("fig7b", inputs, solved)) == [holds]


def test_worst_fit_departs_at_small_waves_only(inputs):
    good = prediction(SETTLING, [0.02, 0.03, 0.05, 0.08, 0.12])

    def with_worst(*friction):
        worst = prediction([0.3, 0.1, 0.05], friction, factor=9.0)
        lines = dict(zip(DENSE_PAIRS, (good, good, worst), strict=True))
        return verdicts(judge("fig8a", inputs, {DENSE: lines}))

    assert with_worst(0.02, 0.055, 0.2) == [True]
    assert with_worst(0.02, 0.055, 0.13) == [False]
    assert with_worst(0.02, 0.09, 0.2) == [False]


PEAKED = [0.2, 0.3, 0.4, 0.5, 0.4]
"""A loss factor with its maximum before the smallest wave."""


def test_maximum_of_friction_comes_sooner(inputs):
    def at_speeds(*frictions, loss=PEAKED):
        lines = {
            f"{i} mm/s": prediction(SETTLING, each, loss_factor=loss)
            for i, each in enumerate(frictions)
        }
        return judge("fig8b", inputs, {SBR: lines})

    slow, middle, fast = (
        [0.02, 0.03, 0.05, 0.08, 0.1],
        [0.03, 0.05, 0.08, 0.11, 0.1],
        [0.05, 0.08, 0.1, 0.09, 0.07],
    )
    assert verdicts(at_speeds(slow, middle, fast)) == [True, True]
    assert verdicts(at_speeds(slow, fast, middle)) == [True, False]
    assert verdicts(at_speeds(slow, slow)) == [True, False]
    rises, sooner = at_speeds(slow, middle, fast, loss=[0.1, 0.2, 0.3, 0.4, 0.5])
    assert (rises.holds, sooner.holds) == (True, None)
    assert "the loss factor of unfilled SBR is largest at 1.9e+06 rad/s" in sooner.why_not
    rises, _ = at_speeds([0.05, 0.02, 0.06, 0.07, 0.08], fast)
    assert rises.holds is False
    assert "at 0 mm/s the wave of 6.67 mm has 40% of the friction of the first" in rises.why_not


def test_compounds(inputs):
    def at(lead, loss):
        friction = np.full(5, 0.1)
        one = prediction(SETTLING, friction, loss_factor=np.full(5, 0.2))
        other = prediction(SETTLING, friction + lead, loss_factor=loss)
        return {FILLED_TREAD: one, SBR: other, R20: one, R60: other}

    def pairs(*solved):
        names = [pair_name(pair, v) for pair in inputs.pairs for v in (SPEED, FAST)]
        return judge("fig9a", inputs, dict(zip(names, solved, strict=True)))

    lossier = [0.2, 0.19, 0.3, 0.4, 0.3]
    together = at([0.01, -0.01, 0.1, 0.2, 0.02], lossier)
    assert verdicts(pairs(*[together] * 4)) == [True] * 12
    apart = at([0.1, -0.01, -0.1, 0.15, 0.2], lossier)
    unreached = at([0.01, -0.01, 0.1, 0.2, 0.02], [0.2, 0.19, 0.3, 0.4, 0.5])
    crossed = at([0.01, -0.01, 0.1, 0.2, -0.3], [0.2, 0.19, 0.5, 0.4, 0.15])
    judgements = pairs(apart, together, unreached, crossed)
    assert verdicts(judgements) == [
        *(False, True, True, True),
        *(False, True, True, True),
        *(False, True, None, False),
    ]
    assert "the loss factor of R60, 0 °C is largest at" in judgements[10].why_not
    assert "they meet between 0.74 and 0.25 mm and cross" in judgements[11].why_not


def test_steeper_surface(inputs):
    def steep(coarse, dense):
        solved = {"300 mm/s": {COARSE: coarse, DENSE: dense}}
        return verdicts(judge("fig9b", inputs, solved))

    more, less = prediction([0.2, 0.05], [0.1, 0.2]), prediction([0.3, 0.1], [0.05, 0.1])
    assert steep(more, less) == [True]
    assert steep(less, more) == [False]
    assert steep(prediction([0.2, 0.05], [0.04, 0.2]), less) == [False]  # less at the first wave


def test_table_holds_every_statement():
    kept = Statement("fig6a", "area | falls", "less than 1", "here", "0.5", True, "")
    broken = Statement("fig7b", "less", "more", "there", "2", False, "steeper")
    unknown = Statement("fig7b", "less", "more", "beyond", "1", None, "no wave gets there")
    assert number_holding([kept, broken]) == "1 of 2 statements hold"
    assert number_holding([kept, broken, unknown]).endswith(
        "hold, 1 cannot be judged with these inputs"
    )
    page = as_markdown([kept, broken, unknown], lambda figure: f"## {figure}")
    assert "**Area | falls.** Holds if: less than 1." in page
    assert "| here | 0.5 | **holds** |" in page
    assert "| there | 2 | **does not hold**: steeper |" in page
    assert "| beyond | 1 | **not judged**: no wave gets there |" in page
    assert page.count("**Less.**") == 1


def test_every_row_of_the_table_names_a_judge_and_its_figures():
    """The numbers of the criteria are those the judges use."""
    for row in CLAIMS:
        assert set(row["figures"].split()) <= set(TITLES)
        assert callable(getattr(judges, row["judge"]))
        assert "{" not in row["criterion"].format(**vars(judges))
    assert len(CLAIMS) == len({row["said"] for row in CLAIMS}) == 17
