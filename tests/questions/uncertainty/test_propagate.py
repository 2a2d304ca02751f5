"""Samples to quantiles: resumed, failures said, the same samples at each speed."""

import shutil
from collections import Counter

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.core.errors import InputError
from gripscale.core.units import display_unit_of
from gripscale.io import netcdf
from gripscale.questions import Uncertainty
from gripscale.questions.uncertainty.question import SampledAnswer

from .sampled import propagate

QUICK = Uncertainty(without=["waves"])
TWELVE = {"samples": 12, "models": ["chain"]}


@pytest.fixture(scope="module")
def run(small_case, tmp_path_factory):
    """Twelve samples of the chain, where they are, and how many tasks were stored or not."""
    target = tmp_path_factory.mktemp("run")
    told = []
    asked = TWELVE | {"folder": target, "workers": 2}
    data = propagate(small_case, QUICK, **asked, on_task=lambda task: told.append(task.stored))
    return data, target, Counter(told)


ANSWERED = 14
"""Tasks of `run`: twelve samples, the case, and the direct contact of the one profile."""


def test_quantiles_are_those_of_the_samples(run):
    data, _, told = run
    assert told == {False: ANSWERED}
    assert int(data.failed.sum()) == 0
    friction = data.friction.values[0]
    assert np.unique(friction).size == 12
    expected = np.quantile(friction, data["quantile"].values, method="median_unbiased")
    np.testing.assert_allclose(data.friction_quantile.values[0], expected)
    assert data.cut_off.dims == ("sample",)
    assert data.cut_off.attrs["units"] == "m"
    assert display_unit_of(data.attrs, "pressure").unit == "bar"
    assert "display_units" in data.attrs


def test_a_second_run_solves_nothing(folder, run):
    data, target, _ = run
    told = []
    case = read_case(folder / "case.toml")
    asked = TWELVE | {"folder": target}
    again = propagate(case, QUICK, **asked, on_task=lambda task: told.append(task.stored))
    assert told == [True] * ANSWERED
    np.testing.assert_array_equal(again.friction, data.friction)


def test_the_answer_without_the_errors_comes_before_the_samples(small_case, run, tmp_path):
    """It is that of a run: its interval holds no error of the inputs."""
    _, target, _ = run
    shutil.copytree(target / "predictions", tmp_path / "predictions")
    told = []
    asked = TWELVE | {"folder": tmp_path, "on_answer": told.append, "on_task": told.append}
    propagate(small_case, QUICK, **asked)
    (at,) = (i for i, each in enumerate(told) if isinstance(each, xr.Dataset))
    assert 0 < at < len(told) - 12
    assert len(told) == ANSWERED + 1
    own = gs.answer(small_case)
    assert float(told[at].answer_friction) == pytest.approx(own.friction, rel=1e-12)
    width = float(told[at].answer_friction_half_width)
    assert width == pytest.approx(float(own.data.answer_friction_half_width), nan_ok=True)


@pytest.fixture(scope="module")
def half_failing(small_case, tmp_path_factory):
    """Ten samples, and where they are; half of the cut-offs lie far beyond the largest wave."""
    target = tmp_path_factory.mktemp("half")
    choice = Uncertainty(without=["waves"], ranges={"cut_off": "1 mm,1000 m"})
    return propagate(small_case, choice, samples=10, models=["chain"], folder=target), target


def test_failures_are_counted_and_said(half_failing):
    data, _ = half_failing
    assert int(data.failed.sum()) == 5
    assert np.isfinite(data.friction.values).sum() == 5
    assert SampledAnswer(data).failure.startswith(
        "5 of 10 samples have no answer and count in no quantile; the first: "
    )
    assert np.isfinite(data.friction_quantile).all()


def test_few_failures_are_a_warning(half_failing):
    """Up to a quarter of the samples of a model: the others stand for all."""
    data, _ = half_failing
    few = data.assign(failed=0 * data.failed + 2)
    assert not SampledAnswer(few).failure
    (notice,) = SampledAnswer(few).findings
    assert notice.severity == "warning"
    assert SampledAnswer(data.assign(failed=0 * data.failed + 3)).failure


def test_a_refusal_while_solving_ends_the_run(folder):
    """A rubber left with 1 Pa cannot carry 3 bar once loaded for long: the chain refuses it."""
    case = folder / "loaded_for_long.toml"
    text = (folder / "case.toml").read_text()
    case.write_text(text.replace("footprint =", 'load_time = "infinite"\nfootprint ='))
    choice = Uncertainty(without=["waves", "modulus"], ranges={"equilibrium_modulus": "1 Pa,6 MPa"})
    with pytest.raises(InputError, match=r"equilibrium_modulus \[Pa\] must be"):
        propagate(read_case(case), choice, samples=10, models=["chain"])


@pytest.fixture(scope="module")
def over_speed(small_case, tmp_path_factory):
    """The samples of `run` at two speeds, and where they are."""
    target = tmp_path_factory.mktemp("over_speed")
    speeds = {"speed": [0.1, 0.3]}
    return propagate(small_case, QUICK, **TWELVE, vary=speeds, folder=target), target


def test_the_same_samples_at_each_speed(run, over_speed):
    data, _ = over_speed
    assert data.friction.dims == ("model", "speed", "sample")
    np.testing.assert_allclose(data.friction.sel(speed=0.3).values, run[0].friction.values)
    assert np.corrcoef(data.friction.values[0])[0, 1] > 0.8


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"samples": 5}, "samples"),
        ({"models": ["persson"]}, "model"),
        ({"models": []}, "models"),
        ({"vary": {"thickness": "5 mm,6 mm"}}, "varies one of speed, pressure"),
        ({"tolerance": 0.0}, "tolerance"),
    ],
)
def test_what_cannot_be_asked_for(small_case, wrong, said):
    with pytest.raises(InputError, match=said):
        propagate(small_case, QUICK, **wrong)


def called(shell, folder, target, *options, code=0):
    words = ("uncertainty", folder / "case.toml", "--model", "chain", "--without", "waves")
    return shell(*words, "--output", target, *options, code=code)


ENOUGH = 21
"""Samples for the shares of the three sources that are two terms each."""


def test_the_command_draws_answer_and_distributions(shell, folder, tmp_path):
    without = [word for name in ("cleaning", "profile", "modulus") for word in ("--without", name)]
    called(shell, folder, tmp_path, "--samples", ENOUGH, *without)
    names = {path.name for path in (tmp_path / "figures").iterdir()}
    assert names == {"answer.png", "distributions.png"}
    data = netcdf.load_dataset(tmp_path / "uncertainty.nc")
    assert data.sizes["sample"] == ENOUGH
    assert data.friction_share.notnull().all()


def test_the_command_draws_a_band_over_speed(shell, folder, over_speed):
    _, target = over_speed
    called(shell, folder, target, "--samples", 12, "--vary", "speed=0.1,0.3")
    assert (target / "figures" / "over_speed.png").is_file()


def test_the_command_ends_with_3_where_samples_failed(shell, folder, half_failing):
    _, target = half_failing
    done = called(shell, folder, target, "--samples", 10, "--range", "cut_off=1 mm,1000 m", code=3)
    assert "5 of 10 samples have no answer" in done.output
