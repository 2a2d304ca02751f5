"""Derivatives of the friction of a case: profiles together, shifted frequencies, command, page."""

import math
from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.case_file.prepare import read_case
from gripscale.conditions import Conditions
from gripscale.core.errors import InputError
from gripscale.half_space import DirectContact
from gripscale.questions import FrictionSensitivity
from gripscale.questions.sensitivity.friction_sensitivity import (
    FEEDBACK,
    KELVIN_STEP,
    LOSS,
    STORAGE,
)
from gripscale.questions.sensitivity.question import Sensitivity
from gripscale.surface import Measured, Surface, self_affine_profile
from tests.samples import (
    SHIFTED_LOAD,
    SHIFTED_RUBBER,
    SHIFTED_SINES,
    THERMAL,
    case_text,
    write_short_road,
)


def measured(*profiles):
    """A surface of profiles, with waves that only state the cut-off."""
    return Surface(SHIFTED_SINES, "", measured=Measured([(p, p) for p in profiles], [], None, ""))


@pytest.fixture(scope="module")
def roads():
    """Two roads of different length and roughness."""
    return [
        self_affine_profile(0.8, 4e-3, rms, length=length, step=1e-4, seed=seed)
        for rms, length, seed in ((2e-4, 0.06, 1), (4e-4, 0.12, 2))
    ]


def test_profiles_share_the_derivatives_by_their_friction(roads):
    together = FrictionSensitivity().predict(SHIFTED_RUBBER, measured(*roads), SHIFTED_LOAD)
    alone = [
        FrictionSensitivity().predict(SHIFTED_RUBBER, measured(road), SHIFTED_LOAD)
        for road in roads
    ]
    friction = np.array(
        [
            float(each.total_friction_from_dissipation) * float(each.weight.sum()) * length
            for each, length in zip(alone, (0.06, 0.12), strict=True)
        ]
    )
    share = friction / friction.sum()
    for name in (LOSS, STORAGE):
        sums = [float(each[name].sum()) for each in alone]
        # the periods of the grids are one step longer than the profiles
        assert float(together[name].sum()) == pytest.approx(share @ sums, rel=1e-3)
        assert sums[0] != pytest.approx(sums[1], rel=1e-3)


def test_frequencies_are_those_of_the_master_curve(roads):
    """30 K warmer the same waves excite a_T of the frequencies of the master curve."""
    surface = measured(roads[0])
    cold = FrictionSensitivity().predict(SHIFTED_RUBBER, surface, SHIFTED_LOAD)
    warm = FrictionSensitivity(conditions=Conditions(temperature=323.15)).predict(
        SHIFTED_RUBBER, surface, SHIFTED_LOAD
    )
    a = float(SHIFTED_RUBBER.shift.a(323.15, 293.15))
    moved = math.log(float(warm.frequency[-1] / cold.frequency[-1]))
    assert moved == pytest.approx(math.log(a), abs=math.log(10.0) / 4.0)  # one band
    assert a < 0.1


def test_feedback_is_a_difference_of_whole_solutions(roads):
    """Warmer rubber is warmed less by its friction: the effect of a kelvin falls."""
    conditions = Conditions(temperature=293.15, heat=THERMAL)
    surface, load = measured(roads[0]), replace(SHIFTED_LOAD, speed=5.0)
    model = FrictionSensitivity(conditions=conditions, with_feedback=True)
    answer = model.predict(SHIFTED_RUBBER, surface, load)
    kept = float(answer["d_ln_friction_d_temperature"])
    anew = float(answer[f"d_ln_friction_d_temperature{FEEDBACK}"])
    assert 0.0 < anew / kept < 0.95
    high, low = (
        DirectContact(
            tolerance=None,
            conditions=replace(conditions, temperature=293.15 + sign * KELVIN_STEP),
        ).predict(SHIFTED_RUBBER, surface, load)
        for sign in (1.0, -1.0)
    )
    frictions = [float(each.total_friction_from_dissipation) for each in (high, low)]
    expected = math.log(frictions[0] / frictions[1]) / (2.0 * KELVIN_STEP)
    assert anew == pytest.approx(expected, rel=1e-12)


CASE = case_text(
    'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "1 mm"',
    'file = "dma.txt"\nterms = 4\nreference_temperature = "20 C"\n'
    'shift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }',
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a case of a short road."""
    path = tmp_path_factory.mktemp("sensitivity")
    write_short_road(path)
    (path / "case.toml").write_text(CASE)
    return path


@pytest.fixture(scope="module")
def data(folder):
    """Derivatives at three temperatures."""
    return gs.sensitivity(
        read_case(folder / "case.toml"),
        folder=folder / "result",
        vary={"temperature": "0 C,20 C,60 C"},
    ).data


def test_bands_that_are_not_excited_count_nothing(folder, data):
    assert len(list((folder / "result").rglob("*.nc"))) == 3  # what a second run finds
    assert np.isfinite(data[LOSS].values).all()
    assert (data[LOSS].values == 0.0).any()
    assert Sensitivity(data).table().columns[1].values == pytest.approx(
        data[LOSS].sum("frequency").values.tolist()
    )
    decades = Sensitivity(data).decades_table()
    for i in range(3):
        total = float(data[LOSS].isel(temperature=i).sum())
        column = next(c for c in decades.columns if c.name == f"{LOSS}_{i}")
        assert sum(column.values) == pytest.approx(total)


def test_rules_of_thumb_are_shifted_to_the_master_curve(data):
    log_a = -8.0 * (273.15 - 293.15) / (120.0 + 273.15 - 293.15)
    wet = data.rule_frequency.sel(rule="wet grip")
    assert float(wet) == pytest.approx(20.0 * np.pi * 10.0**log_a, rel=1e-9)
    assert ((data.rule_share >= 0.0) & (data.rule_share <= 1.2)).all()


def test_refuses_rest_and_other_inputs(folder, tmp_path):
    with pytest.raises(InputError, match="speed must be above zero"):
        gs.sensitivity(read_case(folder / "case.toml"), folder=tmp_path, vary={"speed": [0.0, 1.0]})
    with pytest.raises(InputError, match="vary must be"):
        gs.sensitivity(
            read_case(folder / "case.toml"), folder=tmp_path, vary={"cut_off": [2e-3, 3e-3]}
        )


def test_says_why_there_is_no_answer(data):
    why = np.full(3, "profile 1 of 1: active set not settled", dtype=object)
    missing = data.drop_vars([LOSS, STORAGE]).assign(prediction_status=("temperature", why))
    assert not list(Sensitivity(missing).parts())
    (only,) = Sensitivity(missing).lines
    assert only.startswith("Answer: none.")
    assert "active set" in only
