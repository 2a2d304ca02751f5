"""Windows as models: the same surfaces for both, no more of them than narrow the estimate."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.chain import Chain
from gripscale.core.status import Status
from gripscale.experiment import Task
from gripscale.half_space import BlockOnProfile, surface_of_sines
from gripscale.half_space.model import DirectContact
from gripscale.model import Load
from gripscale.questions.answer.samples import sample_numbers
from gripscale.questions.compare.comparison import windows_left
from gripscale.questions.compare.ladder import LADDER, MOST_WINDOWS, ComparisonSetup, chosen
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Measured, SineStack, Surface, self_affine_profile
from gripscale.theory import HalfPlane
from studies.finite_strain_pairs import solve_both_ways
from tests.samples import GENTLE_SINES as STACK

RUBBER = Rubber(1e6, [9e6], [0.01])
LINE = surface_of_sines(STACK, 20e-3, 1)
SURFACE = Surface(STACK, "", measured=Measured.of([LINE]))
LOAD = Load(5e4, 0.1, 0.1, math.inf)
ROAD = self_affine_profile(0.8, 5e-3, 1e-3, 0.3, 1e-4, seed=4)
MEASURED = Measured.of([ROAD])
SUBJECT = ComparisonSetup(RUBBER, Surface(STACK, "", measured=MEASURED), LOAD, Chain(HalfPlane()))


def test_both_models_answer_as_the_pair_does():
    (pair,) = solve_both_ways(RUBBER, [LINE], pressure=LOAD.pressure, speed=LOAD.speed).pairs
    block, half_space = (
        sample_numbers(model.predict(RUBBER, SURFACE, LOAD), Task(RUBBER, SURFACE, LOAD, model))
        for model in (BlockOnProfile(periodic=True), DirectContact(periodic=True))
    )
    assert block.prediction_status == half_space.prediction_status == "converged"
    for name in ("contact_fraction", "friction", "friction_from_dissipation"):
        assert getattr(block, name) == pytest.approx(getattr(pair.block, name), rel=1e-12)
        # another first grid: the linear solver's tolerance is what is left
        assert getattr(half_space, name) == pytest.approx(getattr(pair.half_space, name), rel=1e-6)
    assert block.contact_fraction_error == pytest.approx(pair.block.contact_fraction_error)
    assert half_space.friction_error == pytest.approx(pair.half_space.friction_error)
    assert half_space.curve_friction.notnull().all()


def test_mesh_too_coarse_counts_as_failed(monkeypatch):
    good = gs.solve_profile(RUBBER, LINE, pressure=5e4, speed=0.1, periodic=True)
    bad = replace(good, status=Status.FRICTIONS_DISAGREE)
    monkeypatch.setattr("gripscale.half_space.model.solve_profile", lambda *_, **__: bad)
    model = BlockOnProfile(periodic=True)
    task = Task(RUBBER, SURFACE, LOAD, model)
    sample = sample_numbers(model.predict(RUBBER, SURFACE, LOAD), task)
    assert "frictions disagree" in str(sample.prediction_status.item())
    assert math.isnan(sample.friction)


def test_windows_are_the_same_for_both():
    small, finite = chosen(["windows"])
    assert finite.follows == small.name
    drawn = [member.draws(SUBJECT) for member in (small, finite)]
    assert [one.subject for one in drawn[0]] == [one.subject for one in drawn[1]]
    assert len({one.subject for one in drawn[0]}) == SUBJECT.windows
    assert chosen([]) == [member for member in LADDER if member.group != "below"]
    short = Surface(SineStack([0.3], [1e-3]), "", measured=MEASURED)
    assert small.draws(replace(SUBJECT, surface=short)) == []


def test_a_map_is_one_sample_of_the_direct_contact():
    x = np.arange(16) * 1e-4
    measured = HeightMap(x, x, np.random.default_rng(1).normal(0.0, 1e-5, (16, 16)), name="mine")
    mapped = Surface(STACK, "", measured=Measured.of(measured))
    (draw,) = chosen(["direct"])[0].draws(replace(SUBJECT, surface=mapped))
    assert draw.subject == "mine"
    assert draw.surface.measured.map is measured


FAILED = dict.fromkeys(("prediction_status", "prediction_status_word"), "profile too rough")


@pytest.fixture
def left(solved, together):
    """Ask whether windows are left to solve, their ratios to small strain being given."""

    def ask(*ratios, wanted=3, half_width=0.2):
        names = [f"window {number}" for number in range(len(ratios))]
        small = solved(*((0.05, 0.1, name) for name in names))
        rows = [
            FAILED | {"subject": name} if ratio is None else (0.05 * ratio, 0.1 * ratio, name)
            for ratio, name in zip(ratios, names, strict=True)
        ]
        samples = together(windows_half_plane=small, windows_finite_strain=solved(*rows))
        ends = ("answer_friction_half_width", "answer_contact_fraction_half_width")
        widths = dict.fromkeys(ends, half_width)
        comparison = SimpleNamespace(
            samples=samples, setups=[SimpleNamespace(windows=wanted)], data=xr.Dataset(widths)
        )
        return windows_left(comparison, 0.1)

    return ask


@pytest.mark.parametrize(
    ("ratios", "options", "more"),
    [
        ([0.98, 0.98, 0.97], {}, False),
        ([0.98, None, 0.97], {}, True),
        ([0.98, None, 0.97, 0.98], {"wanted": 4}, False),
        ([0.9, 1.0, 0.8], {}, True),
        ([0.9, 1.0, 0.8], {"half_width": 0.6}, False),
        ([0.9, 1.0, 0.8], {"wanted": 4}, False),
    ],
    ids=["agree", "failed", "replaced", "scatter", "hidden by the rest", "no more there"],
)
def test_more_windows_are_solved_while_they_narrow_the_estimate(left, ratios, options, more):
    assert left(*ratios, **options) is more


def test_the_first_windows_are_spread_over_the_profile():
    (member, _), length = chosen(["windows"]), SUBJECT.lines[0].length
    every = member.draws(replace(SUBJECT, windows=MOST_WINDOWS))
    starts = [float(spec.subject.split()[-2]) for spec in every]
    assert len(starts) == MOST_WINDOWS
    assert len(set(starts)) == MOST_WINDOWS
    for count in (2, 4, 8):
        gaps = np.diff(sorted(starts[:count]))
        assert gaps.min() > 0.8 * length / count * (1.0 - 1.0 / MOST_WINDOWS)
