"""Lines in the block and in the half-space as models: the answers of the solvers themselves."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

import gripscale as gs
from gripscale.comparison.ladder import LADDER, chosen
from gripscale.comparison.lines import BlockOnLine, HalfSpaceOnLine
from gripscale.comparison.rung import Subject
from gripscale.comparison.sample import sample_of
from gripscale.errors import InputError
from gripscale.model import NominalLoad
from gripscale.rough import solve_both_ways, surface_of_sines
from gripscale.rubber import Rubber
from gripscale.surface import Measured, PreparedSurface, SineStack, self_affine_profile
from gripscale.theory import HalfPlane

RUBBER = Rubber(1e6, [9e6], [0.01])
STACK = SineStack([10e-3, 4e-3], [2e-4, 5e-5])
LINE = surface_of_sines(STACK, 20e-3, 1)
SURFACE = PreparedSurface(STACK, "", measured=Measured.of([LINE]))
LOAD = NominalLoad(5e4, 0.1, 0.1, math.inf)


def test_both_models_answer_as_the_pair_does() -> None:
    (pair,) = solve_both_ways(RUBBER, [LINE], pressure=LOAD.pressure, speed=LOAD.speed).pairs
    block = sample_of(BlockOnLine().predict(RUBBER, SURFACE, LOAD), RUBBER)
    half_space = sample_of(HalfSpaceOnLine().predict(RUBBER, SURFACE, LOAD), RUBBER)
    assert block.converged
    assert half_space.converged
    for name in ("contact_fraction", "friction", "friction_from_dissipation"):
        assert getattr(block, name) == getattr(pair.block, name)
        assert getattr(half_space, name) == getattr(pair.half_space, name)
    assert block.contact_fraction_error == pytest.approx(pair.block.contact_fraction_error)
    assert half_space.friction_error == pair.half_space.friction_error
    assert half_space.curve is not None


def test_mesh_too_coarse_counts_as_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    good = gs.solve_profile(RUBBER, LINE, pressure=5e4, speed=0.1, periodic=True)
    bad = replace(good, friction_from_dissipation=9.0 * good.friction)
    monkeypatch.setattr("gripscale.comparison.lines.solve_profile", lambda *_, **__: bad)
    sample = sample_of(BlockOnLine().predict(RUBBER, SURFACE, LOAD), RUBBER)
    assert sample.status == "the block's two frictions differ by 89%"
    assert math.isnan(sample.friction)


def test_several_profiles_are_no_line() -> None:
    two = PreparedSurface(STACK, "", measured=Measured.of([LINE, LINE]))
    with pytest.raises(InputError, match=r"only profile of its surface; got 2"):
        HalfSpaceOnLine().predict(RUBBER, two, LOAD)


def test_windows_are_the_same_for_both_and_asked_for_by_name() -> None:
    road = self_affine_profile(0.8, 5e-3, 1e-3, 0.2, 1e-4, seed=4)
    surface = PreparedSurface(STACK, "", measured=Measured.of([road]))
    subject = Subject(RUBBER, surface, LOAD, HalfPlane())
    small, finite = chosen(["windows"])
    assert finite.follows == small.name
    drawn = [rung.draws(subject) for rung in (small, finite)]
    assert [one.of for one in drawn[0]] == [one.of for one in drawn[1]]
    assert len({one.of for one in drawn[0]}) == 8
    assert {small, finite}.isdisjoint(chosen([]))
    assert chosen(["all"]) == list(LADDER)
    short = PreparedSurface(SineStack([0.3], [1e-3]), "", measured=Measured.of([road]))
    assert small.draws(replace(subject, surface=short)) == []
