"""The block on whole profiles as a model: what it answers, and when it does not."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.status import Status
from gripscale.half_space import BlockOnProfile
from gripscale.half_space import model as half_space_model
from gripscale.model import Load, Model
from gripscale.surface import Measured, Profile, SineStack, Surface
from tests.samples import ZENER as RUBBER

LOAD = Load(5e4, 0.1, 0.1)
X = np.arange(64) * (20e-3 / 64)


def line(phase, length=20e-3):
    place = 2.0 * np.pi * X / X[-1] * (63 / 64)
    z = 2e-4 * np.cos(2.0 * place) + 5e-5 * np.cos(5.0 * place + phase)
    return Profile(X * (length / 20e-3), z * (length / 20e-3))


def surface_of(*lines):
    sines = SineStack([10e-3, 4e-3], [2e-4, 5e-5])
    return Surface(sines, "", measured=Measured.of(lines))


def test_it_is_a_model():
    assert isinstance(BlockOnProfile(), Model)


def test_profiles_count_by_their_length():
    answer = BlockOnProfile(periodic=True).predict(
        RUBBER, surface_of(line(0.0), line(2.0, length=40e-3)), LOAD
    )
    each = [
        gs.solve_profile(RUBBER, one, pressure=5e4, speed=0.1, load_time=1.0, periodic=True)
        for one in (line(0.0), line(2.0, length=40e-3))
    ]
    assert answer.prediction_status == "converged"
    np.testing.assert_array_equal(answer.friction, [one.friction for one in each])
    expected = (each[0].friction + 2.0 * each[1].friction) / 3.0
    assert float(answer.total_friction) == pytest.approx(expected, rel=1e-9)
    assert float(answer.weight.sum()) == pytest.approx(1.0)


def test_what_does_not_converge_is_named_and_has_no_totals(monkeypatch):
    good = gs.solve_profile(RUBBER, line(0.0), pressure=5e4, speed=0.1, periodic=True)
    bad = replace(good, status=Status.ITERATION_LIMIT)
    monkeypatch.setattr(half_space_model, "solve_profile", lambda *_, **__: bad)
    answer = BlockOnProfile(periodic=True).predict(RUBBER, surface_of(line(0.0)), LOAD)
    assert np.isnan(answer.total_friction)
    assert "profile 1 of 1: iteration limit" in str(answer.prediction_status.item())


def test_waves_by_hand_have_no_profile():
    bare = Surface(SineStack([10e-3], [2e-4]), "")
    with pytest.raises(gs.InputError, match="needs a profile"):
        BlockOnProfile().predict(RUBBER, bare, LOAD)


def test_only_the_profiles_matter():
    surface = surface_of(line(0.0))
    part = surface.only(BlockOnProfile().needs)
    assert (part.waves, part.end, part.correlation) == (None, None, None)
    alone = BlockOnProfile().predict(RUBBER, part, LOAD)
    assert float(alone.total_friction) == float(
        BlockOnProfile().predict(RUBBER, surface, LOAD).total_friction
    )
