import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gripscale.core.errors import InputError
from gripscale.surface import HeightDifference, height_difference, self_affine_profile
from gripscale.surface.height_difference import find_plateau, log_weights

from .surface_cases import profile_of

HEIGHTS = arrays(
    float, st.integers(64, 90), elements=st.floats(-1.0, 1.0) | st.just(float("nan"))
).filter(lambda z: np.isfinite(z).sum() > 50)


def brute_force(profiles, shift):
    squares = [
        (p.z[i + shift] - p.z[i]) ** 2
        for p in profiles
        for i in range(len(p) - shift)
        if np.isfinite(p.z[i + shift]) and np.isfinite(p.z[i])
    ]
    return float(np.mean(squares)), len(squares)


@settings(max_examples=25, deadline=None)
@given(first=HEIGHTS, second=HEIGHTS)
def test_equals_the_sum_over_all_pairs(first, second):
    profiles = [profile_of(first), profile_of(second)]
    curve = height_difference(profiles, steepest=np.inf)
    for lag, value, pairs in zip(curve.lag, curve.value, curve.pairs, strict=True):
        expected, count = brute_force(profiles, round(lag / 1e-4))
        assert count == pairs
        # Differences of heights up to 1 about their mean lose at most 1e-16 absolutely.
        assert value == pytest.approx(expected, rel=1e-10, abs=1e-30)


def test_small_lags_keep_their_digits_far_below_the_plateau():
    # A smooth wave with C_z at one step 1e-9 of its plateau, on a height of 1 m.
    x = 1e-4 * np.arange(40_000)
    wave = np.cos(2 * np.pi * x / 0.7)
    curve = height_difference(profile_of(1e-3 * wave), max_lag=0.01)
    k = 2 * np.pi / 0.7
    assert curve.value[0] < 1e-6 * 1e-6
    for shift, value in ((1, curve.value[0]), (2, curve.value[1])):
        a = 1e-3 * wave
        assert value == pytest.approx(np.mean((a[shift:] - a[:-shift]) ** 2), rel=1e-10)
        # Mean over a whole number of waves and a bit: A^2 (1 - cos kl) within the end effect.
        assert value == pytest.approx(1e-6 * (1 - np.cos(k * shift * 1e-4)), rel=0.1)


def test_lags_are_whole_steps_to_a_quarter_of_the_length():
    curve = height_difference(profile_of(np.random.default_rng(1).standard_normal(1001)))
    steps = curve.lag / 1e-4
    assert np.allclose(steps, np.rint(steps), atol=1e-9)
    assert curve.lag[0] == pytest.approx(1e-4)
    assert curve.lag[-1] == pytest.approx(0.025)
    decade = (curve.lag > 1.0001e-3) & (curve.lag < 1.0001e-2)
    assert decade.sum() == pytest.approx(20, abs=1)


def test_band_covers_the_truth_as_often_as_it_says():
    # C_z at lags far below a block (1/16 of 200 cut-offs): nominally 95 % of bands hold it.
    # 60 profiles x 3 lags, correlated within a profile: 95 % - 4 standard errors of 60 tries.
    inside = []
    for seed in range(60):
        profile = self_affine_profile(0.7, 1e-3, 1e-3, 0.2, 5e-5, seed)
        curve = height_difference(profile, max_lag=4e-4, steepest=np.inf)
        for at in (0, 2, 5):
            truth = 1e-6 * (1.0 - np.exp(-((curve.lag[at] / 1e-3) ** 1.4)))
            inside.append(curve.lower[at] <= truth <= curve.upper[at])
    assert 0.84 <= np.mean(inside) < 1.0


def test_lines_side_by_side_are_one_block():
    """Each line eight times over says no more than once, and the band is as wide."""
    once = [self_affine_profile(0.8, 2e-3, 1e-3, 0.02, 1e-4, seed=seed) for seed in range(64)]
    curve = height_difference(once)
    again = height_difference([line for line in once for _ in range(8)])
    np.testing.assert_allclose(again.value, curve.value)
    np.testing.assert_allclose(again.upper, curve.upper)
    assert np.array_equal(again.pairs, 8 * curve.pairs)


def test_band_narrows_with_length():
    short, long = (
        height_difference(self_affine_profile(0.7, 1e-3, 1e-3, length, 1e-4, 5), max_lag=5e-4)
        for length in (0.2, 3.2)
    )
    ratio = np.log(short.upper / short.lower) / np.log(long.upper / long.lower)
    # Sixteen times the length: a quarter of the width, with 18 % scatter of each (15 freedoms).
    assert np.median(ratio) == pytest.approx(4.0, rel=0.6)


ONE, OTHER = profile_of(np.arange(50.0)), profile_of(np.arange(50.0), 2e-4)
LONELY = profile_of(np.where(np.arange(50) % 25, np.nan, 1.0))


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: height_difference(ONE, max_lag=1e-5), "max_lag must be at least one step"),
        (lambda: height_difference(ONE, max_lag=1.0), "max_lag must be .* within the profile"),
        (lambda: height_difference(ONE, max_lag=-1.0), "max_lag must be greater than zero"),
        (lambda: height_difference([ONE, OTHER]), r"same step .* at index 1"),
        (lambda: height_difference([]), "Profile or a list"),
        (lambda: height_difference(3), "Profile or a list"),
        (lambda: height_difference(LONELY), "at least 16 pairs"),
        (lambda: HeightDifference([1.0, 2.0], [1.0]), "same length"),
        (lambda: HeightDifference([1.0, 1.0], [1.0, 1.0]), "must increase; got 1 m at index 1"),
        (lambda: HeightDifference([0.0, 1.0], [1.0, 1.0]), "lag must be greater than zero"),
        (lambda: HeightDifference([1.0, 2.0], [1.0, -1.0]), "value must not be negative"),
        (lambda: HeightDifference([], []), "at least 1"),
        (lambda: HeightDifference([1.0, 2.0], [1, 2], upper=[1.0]), "upper must have 2 entries"),
        *(
            (
                lambda share=share: height_difference(ONE, top_height_fraction=share),
                "top_height_fraction must be",
            )
            for share in (0.0, -0.5, 1.1, np.nan)
        ),
    ],
)
def test_bad_input_is_refused(call, says):
    with pytest.raises(InputError, match=says):
        call()


def test_a_curve_without_band_has_none():
    curve = HeightDifference([1.0, 2.0], [1.0, 2.0])
    assert curve.pairs.tolist() == [0, 0]
    assert np.isnan(curve.lower).all()


def test_the_top_height_fraction_alone_counts():
    # Tops at 0 and valleys at -5: between tops nothing differs, whatever the valleys do.
    z = np.where(np.arange(4000) % 8 < 5, 0.0, -5e-3) + 1e-4 * np.sin(0.01 * np.arange(4000))
    profile = profile_of(z)
    above = height_difference(profile, top_height_fraction=0.5)
    by_hand = profile_of(np.where(z >= np.median(z), z, np.nan))
    # the same pairs, off their mean by another constant: round-off of the difference is left
    np.testing.assert_allclose(above.value, height_difference(by_hand).value, rtol=1e-12)
    assert above.value.max() < 1e-7 < np.median(height_difference(profile).value)
    whole = height_difference(profile, top_height_fraction=1.0)
    np.testing.assert_array_equal(whole.value, height_difference(profile).value)


LAG = np.geomspace(1e-4, 1.0, 81)


def test_the_level_is_the_median_of_what_has_settled():
    value = np.minimum(LAG / 1e-2, 1.0) ** 1.5
    value[-8:] = np.linspace(1.1, 1.3, 8)  # a drift over less than half a decade
    plateau = find_plateau(HeightDifference(LAG, value))
    # Less than half of the plateau drifts: its median is not moved at all.
    assert plateau.level == pytest.approx(1.0, rel=1e-12)


def test_it_begins_where_the_mean_of_the_rest_is_nearly_reached():
    value = np.minimum(LAG / 1e-2, 1.0) ** 1.5
    plateau = find_plateau(HeightDifference(LAG, value))
    # 90 % of 1 is reached at 0.9^(1/1.5) of the cut-off: between the last two lags before it.
    assert 0.88e-2 < plateau.lag < 1.001e-2


def test_the_curve_of_a_sine_settles_at_its_mean_over_phases():
    lag = np.geomspace(1e-4, 1.0, 400)
    value = 4.0 * (1.0 - np.cos(2.0 * np.pi * lag / 1e-2))
    plateau = find_plateau(HeightDifference(lag, value))
    # Cosines are positive as often as negative, but in log lag the first hump, from a quarter to
    # three quarters of a wave, is the widest: half a decade of two and a half, hence 20 %.
    assert plateau.level == pytest.approx(4.0, rel=0.2)
    assert plateau.lag == pytest.approx(0.25e-2, rel=0.1)


@pytest.mark.parametrize("exponent", [0.6, 1.0, 2.0])
def test_a_curve_that_rises_to_its_end_has_none(exponent):
    assert find_plateau(HeightDifference(LAG, LAG**exponent)) is None


def test_decades_count_alike():
    weight = log_weights(np.array([1.0, 10.0, 100.0, 1000.0]))
    assert weight == pytest.approx([0.5, 1.0, 1.0, 0.5])
    assert log_weights(np.array([3.0])) == pytest.approx([1.0])
