"""The answer with errors of the inputs: the number of `run`, its interval widened by samples."""

import math

import numpy as np
import pytest
from scipy import stats

from gripscale.case_file import read_case
from gripscale.questions import Uncertainty
from gripscale.questions.answer.answer import answer
from gripscale.questions.uncertainty.question import SampledAnswer
from gripscale.questions.uncertainty.sampled_answer import OF_RUN, REST, sampled_error
from gripscale.questions.uncertainty.sources import SOURCES
from tests.samples import HALF_PLANE, THREE_WAVES, case_text

from .sampled import propagate

QUANTITIES = ("friction", "contact_fraction")


def only(*sources, **ranges):
    """Return an uncertainty of these sources and no others."""
    kept = {*sources, *ranges}
    return Uncertainty([name for name in SOURCES if name not in kept], ranges)


@pytest.fixture(scope="module")
def of_run(small_case):
    """Return the answer of `gripscale run`."""
    return answer(small_case).data


def sigma(data, name, label):
    """Return the standard error of one part of the interval."""
    return float(data[f"answer_{name}_part_error"][data.part_label.values.tolist().index(label)])


@pytest.fixture(scope="module")
def certain(small_case):
    """Return an uncertainty whose one source has one value, that of the case."""
    return propagate(small_case, only(bulk_modulus="2 GPa"), samples=10)


@pytest.mark.parametrize("name", QUANTITIES)
def test_without_errors_of_inputs_number_and_interval_are_those_of_run(certain, of_run, name):
    """The same contact is solved for both, so that only rounding is between them."""
    for end in ("", "_half_width", "_uncertainty", "_sampling_error"):
        mine, theirs = (float(data[f"answer_{name}{end}"]) for data in (certain, of_run))
        assert math.isfinite(mine)
        assert mine == pytest.approx(theirs, rel=1e-9)
    assert float(certain[f"answer_{name}_{OF_RUN}"]) == pytest.approx(
        float(of_run[f"answer_{name}_half_width"]), rel=1e-12
    )


@pytest.mark.verification
def test_processes_give_the_same_answer(small_case, certain):
    """With what it rests on, which comes from the waves and not from the measurement."""
    choice = only(bulk_modulus="2 GPa")
    data = propagate(small_case, choice, samples=10, client="processes", workers=2)
    assert float(certain.answer_steep_share) >= 0.0
    for name in map(str, certain.data_vars):
        if name.startswith("answer_"):
            np.testing.assert_array_equal(data[name].values, certain[name].values, name)


@pytest.fixture(scope="module")
def cut_off(small_case):
    """Return an uncertainty of the cut-off alone, known to an octave about the case."""
    return propagate(small_case, only("cut_off"), samples=10)


@pytest.fixture(scope="module")
def blocks(small_case):
    """Return an uncertainty of the stretch of road alone."""
    return propagate(small_case, only("profile"), samples=20)


@pytest.mark.parametrize("name", QUANTITIES)
def test_the_sampling_of_the_road_counts_once(blocks, of_run, name):
    """Drawn blocks take the place of the error from pieces.

    Both estimate one standard error, from 8 blocks and 10 pieces of this road: to 27 and 24 %, so
    that 2.5 is two and a half standard deviations of their ratio. All other parts are those of
    `run` to rounding: the error from pieces is not among them.
    """
    parts = blocks[f"answer_{name}_part_error"].values
    assert float(blocks[f"answer_{name}_uncertainty"]) == pytest.approx(math.hypot(*parts))
    drawn = math.hypot(*(sigma(blocks, name, label) for label in drawn_labels(blocks)))
    others = math.hypot(*parts[len(drawn_labels(blocks)) :])
    from_pieces = float(of_run[f"answer_{name}_sampling_error"])
    of_others = math.sqrt(float(of_run[f"answer_{name}_uncertainty"]) ** 2 - from_pieces**2)
    assert others == pytest.approx(of_others, rel=1e-9)
    assert from_pieces / 2.5 < drawn < 2.5 * from_pieces


def drawn_labels(data):
    """Return the parts that come from samples: the first, up to the grid."""
    labels = data.part_label.values.tolist()
    return labels[: labels.index("grid of the answer")]


def test_the_variance_of_the_samples_is_in_the_interval(cut_off, certain):
    """The mean square of ln y about the case."""
    data = cut_off
    friction = data.friction_from_dissipation.values[0]
    case = float(data.friction_from_dissipation_case[0])
    square = float(np.mean(np.log(friction / case) ** 2))
    assert square > 1e-4
    before, after = (float(d.answer_friction_uncertainty) ** 2 for d in (certain, data))
    assert after - before == pytest.approx(square, rel=1e-6)
    assert sigma(data, "friction", "cut-off of the roughness") ** 2 == pytest.approx(
        square, rel=0.1
    ), "a smooth effect of one number: the fit explains nearly all of it"
    sentences = " ".join(SampledAnswer(data).lines)
    assert "Answer: hysteresis friction μ = " in sentences
    assert "interval: with the errors of the inputs, from 10 samples" in sentences
    table, measured = (
        p for p in SampledAnswer(data).parts() if getattr(p, "name", "") in ("parts", "next")
    )
    assert "cut-off of the roughness" in table.columns[0].texts()
    assert measured.columns[0].texts()[0] == "none"
    # a profile to where the roughness ends leaves the interval without that part
    columns = {column.name: column.values for column in measured.columns}
    widths = dict(zip(columns["measurement"], columns["friction_width"], strict=True))
    rest = after - sigma(data, "friction", "cut-off of the roughness") ** 2
    left = math.asinh(widths["a finer profile, to where the roughness ends"])
    assert left / math.asinh(widths["none"]) == pytest.approx(math.sqrt(rest / after))
    assert list(widths.values())[1:] == sorted(list(widths.values())[1:])


def test_the_grid_is_drawn_into_the_samples_and_not_twice_into_the_answer(small_case, certain):
    data = propagate(small_case, only("grid"), samples=20)
    error = data.friction_grid_error.values[0]
    assert np.ptp(error) == pytest.approx(0.0, abs=1e-12), "one contact, solved once"
    solved = float(data.friction_case[0])
    np.testing.assert_allclose(
        data.friction.values[0], solved * np.exp(error * data.grid_place.values)
    )
    low, high = np.log(data.friction_quantile.values[0, [0, -1]] / solved)
    # 5 and 95 % of what is spread evenly from -1 to 1 are 0.9; twenty samples lie a twentieth apart
    assert low == pytest.approx(-0.9 * error[0], abs=0.1 * error[0])
    assert high == pytest.approx(0.9 * error[0], abs=0.1 * error[0])
    for name in QUANTITIES:
        width = float(data[f"answer_{name}_half_width"])
        assert width == pytest.approx(float(certain[f"answer_{name}_half_width"]), rel=1e-9)
        assert sigma(data, name, "grid of the answer") > 0.0


def test_at_several_loads_each_has_its_answer(small_case, cut_off):
    data = propagate(small_case, only("cut_off"), samples=10, vary={"speed": [0.1, 0.3]})
    assert data.answer_friction.dims == ("speed",)
    for name in ("answer_friction", "answer_contact_fraction_half_width"):
        assert float(data[name].sel(speed=0.3)) == pytest.approx(float(cut_off[name]))
    table = next(part for part in SampledAnswer(data).parts() if not isinstance(part, str))
    assert table.columns[0].texts() == ["0.1 m/s", "0.3 m/s"]


def test_without_samples_of_the_direct_contact_the_interval_is_that_of_run(small_case, of_run):
    data = propagate(small_case, only("cut_off"), samples=10, models=["chain"])
    for name in QUANTITIES:
        width = float(of_run[f"answer_{name}_half_width"])
        assert float(data[f"answer_{name}_half_width"]) == pytest.approx(width, rel=1e-9)
    assert "the direct contact was not sampled" in " ".join(SampledAnswer(data).lines)


def test_waves_by_hand_are_answered_by_the_chain(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(case_text("", solver=HALF_PLANE).replace("[surface]\n\n", THREE_WAVES))
    data = propagate(read_case(case), samples=12)
    assert data.model.values.tolist() == ["chain"]
    assert float(data.answer_friction) == float(data.friction_case[0])
    logs = np.log(data.friction.values[0] / float(data.answer_friction))
    spread = math.sqrt(float(np.mean(logs**2)))
    assert float(data.answer_friction_half_width) == pytest.approx(
        math.sinh(stats.t.ppf(0.95, 11) * spread)
    )
    text = " ".join(SampledAnswer(data).lines)
    assert "by the chain of waves" in text
    assert "no measured surface judges it" in text


def test_parts_add_up_and_have_their_freedom():
    """ln y = a + 2 b about a case that lies off the mean; `a` was drawn from few blocks."""
    random = np.random.default_rng(3)
    a, b = 0.1 * random.standard_normal((2, 400))
    values = np.exp(a - a.mean() + 2.0 * (b - b.mean()) + 0.3)
    drawn = {"profile": a[:, None], "other": b[:, None]}
    error = sampled_error(values, 1.0, drawn, {"profile": 7.0})
    total = float(np.mean(np.log(values) ** 2))
    assert sum(error.variance.values()) == pytest.approx(total)
    # standard errors of variances of 400 draws are 7 %
    assert error.variance["profile"] == pytest.approx(0.01, rel=0.2)
    assert error.variance["other"] == pytest.approx(0.04, rel=0.2)
    # 0.3^2, and twice the covariance of the draws by chance: 0.002
    assert error.variance[REST] == pytest.approx(0.3**2, abs=0.005)
    squares = {float(e.freedom): float(e.sigma) ** 2 for e in error.errors}
    assert squares[7.0] == pytest.approx(error.variance["profile"] + error.variance[REST])
    assert squares[399.0] == pytest.approx(error.variance["other"])
