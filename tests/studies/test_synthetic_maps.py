"""Synthetic isotropic maps share with measured lines what they say they do."""

import numpy as np
import pytest
from scipy import stats

from gripscale.core.errors import InputError
from gripscale.surface import Profile, clean, read_profile
from studies.isotropic_maps import line_statistics
from studies.isotropic_maps.construction import isotropic_maps
from studies.isotropic_maps.line_statistics import (
    BELL,
    CURVATURE,
    SLOPE,
    BellFilter,
    Distribution,
    Square,
    Term,
    periodic_lines,
    scaled,
)
from tests.surface.surface_cases import ROAD, ROAD_ONLY

SMALLEST = 1.6e-3
POINTS = 128
LENGTH = POINTS * SMALLEST / 4
STEP = LENGTH / POINTS
ROUGH = clean(read_profile(ROAD[0]), crop=ROAD_ONLY)[0]
MEASURED = periodic_lines([ROUGH], LENGTH)[0].heights
EVERY = np.interp(np.arange(0.0, ROUGH.length, STEP), ROUGH.x - ROUGH.x[0], MEASURED)
"""The measured line at the steps of a map."""


def one_map(construction, profile=ROUGH, seed=0):
    return next(
        isotropic_maps(
            profile,
            smallest_wavelength=SMALLEST,
            construction=construction,
            points=POINTS,
            seeds=[seed],
        )
    )


@pytest.fixture(scope="module")
def quick():
    """Fewer filters and batches than a real map gets."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(line_statistics, "STATISTICS", 48)
        patch.setattr(line_statistics, "STAGES", ((4, 50), (2, 50), (1, 50)))
        yield


@pytest.fixture(scope="module")
def matched(quick):
    return one_map("lines")


def both_ways(z):
    return np.concatenate([z.T, z])


def roughness_by_height(lines):
    """Rms second difference at the lowest third of the points over that at the highest."""
    bend = lines[..., 2:] - 2.0 * lines[..., 1:-1] + lines[..., :-2]
    height = lines[..., 1:-1]
    low, high = np.quantile(height, [1 / 3, 2 / 3])
    return bend[height < low].std() / bend[height > high].std()


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0])
def test_a_filter_on_a_map_is_that_on_its_lines(angle):
    square = Square(64, 6.4e-3)
    one = BellFilter((Term(CURVATURE, 2e-4, 1e-4, 1.5), Term(SLOPE, 3e-4), Term(BELL, 1e-4)))
    qx, qy = 2.0 * np.pi / square.length * np.array([3.0, -5.0])
    x = square.step * np.arange(64)
    phase = qx * x[:, None] + qy * x
    k = np.array([qx * np.cos(angle) + qy * np.sin(angle)])
    expected = (one.at(k)[0] * np.exp(1j * phase)).real
    answer = square.heights(one.along(square, angle) * square.spectrum(np.cos(phase)))
    nodes = 2.0 * np.sqrt(2.0) * np.pi / square.step / 2**14
    nearest = one.at(k + 0.5 * nodes * np.array([-1.0, 1.0]))
    assert np.abs(answer - expected).max() < 1.01 * np.abs(nearest - one.at(k)).max()
    assert np.abs(nearest - one.at(k)).max() < 0.01 * np.abs(one.at(k))[0]


def test_filters_are_derivatives_of_a_bell():
    x, k = 1e-4 * np.arange(8192), 2 * np.pi * 40 / 0.8192
    line = periodic_lines([Profile(x, 1e-3 * np.cos(k * x))], 0.1)[0]
    for order in (BELL, SLOPE, CURVATURE):
        width = 1e-3
        rms = scaled([Term(order, width)], [line]).scale
        expected = 1e-3 * (k * width) ** order * np.exp(-0.5 * (k * width) ** 2) * np.sqrt(0.5)
        # the straight line through the ends of the cosine, one step short of its period
        assert rms == pytest.approx(expected, rel=1e-3)


def test_correction_gives_the_wanted_distribution():
    random = np.random.default_rng(0)
    wanted = random.exponential(size=200_000)
    values = random.standard_normal((300, 300)).astype(np.float32)
    moved = values + Distribution.of(wanted).correction(values)
    # of 90,000 values, after 200,000: Kolmogorov distance of chance sqrt(1/9e4 + 1/2e5) = 0.004
    assert stats.ks_2samp(moved.ravel(), wanted).statistic < 0.012
    assert stats.spearmanr(values, moved, axis=None).statistic > 0.9999


@pytest.mark.parametrize("other", [32, 128])
def test_waves_of_both_squares_are_kept(other):
    square, second = Square(64, 1.0), Square(other, 1.0)
    x = np.arange(64) / 64
    z = np.cos(2 * np.pi * (3 * x[:, None] - 7 * x)) + np.sin(2 * np.pi * 5 * x)
    finer = np.arange(other) / other
    expected = np.cos(2 * np.pi * (3 * finer[:, None] - 7 * finer)) + np.sin(2 * np.pi * 5 * finer)
    moved = second.heights(square.onto(square.spectrum(z), second))
    assert np.abs(moved - expected).max() < 1e-12


def test_spectrum_maps_have_the_correlation_of_the_lines():
    lag = 2 ** np.arange(1, 5)
    expected = [_along(n) for n in lag]
    maps = isotropic_maps(
        ROUGH, smallest_wavelength=SMALLEST, construction="spectrum", points=POINTS, seeds=range(8)
    )
    found = np.mean([[_periodic(z.z, n) for n in lag] for z in maps], axis=0)
    # measured in 32 periods of a map, drawn in 8 maps of some ten stones each way
    assert np.abs(found / expected - 1.0).max() < 0.15


def test_heights_maps_have_the_heights_of_the_lines():
    z = one_map("heights").z
    ranks = np.linspace(0.001, 0.999, 50)
    found, wanted = np.quantile(z, ranks), np.quantile(MEASURED, ranks)
    # sixteen of the map's heights lie beyond the last rank
    assert np.abs(found - wanted).max() < 0.02 * MEASURED.std()


@pytest.mark.verification
def test_lines_maps_have_the_heights_and_the_correlation(matched):
    lines = both_ways(matched.z)
    assert lines.std() == pytest.approx(MEASURED.std(), rel=0.1)
    assert stats.skew(lines, axis=None) == pytest.approx(stats.skew(MEASURED), abs=0.25)
    for lag in (1, 4, 16):
        # a map is some ten stones wide: its own scatter is 10 %
        assert _periodic(matched.z, lag) == pytest.approx(_along(lag), rel=0.15)


@pytest.mark.verification
def test_lines_maps_know_where_the_roughness_sits(matched):
    # 1.80 as measured; a map with all its batches comes nearer than this quick one, at 1.39
    assert roughness_by_height(EVERY) > 1.7
    assert roughness_by_height(both_ways(matched.z)) > 1.3
    assert roughness_by_height(both_ways(one_map("spectrum").z)) < 1.1
    assert roughness_by_height(both_ways(one_map("heights").z)) < 1.25


@pytest.mark.verification
def test_lines_maps_are_alike_both_ways(matched):
    along, across = matched.z.T, matched.z
    assert roughness_by_height(along) == pytest.approx(roughness_by_height(across), rel=0.15)
    slopes = [np.diff(lines, axis=1).std() for lines in (along, across)]
    assert slopes[0] == pytest.approx(slopes[1], rel=0.1)


@pytest.mark.verification
def test_equal_seeds_give_equal_maps(matched, quick):
    told = []
    maps = isotropic_maps(
        ROUGH,
        smallest_wavelength=SMALLEST,
        points=POINTS,
        seeds=[0, 1],
        on_batch=lambda seed, share: told.append((seed, share)),
    )
    assert np.array_equal(matched.z, next(maps).z)
    assert matched.name.startswith("synthetic")
    assert matched.step == pytest.approx((SMALLEST / 4, SMALLEST / 4))
    assert {seed for seed, _ in told} == {0}
    shares = [share for _, share in told]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    spectra = [one_map("spectrum", seed=seed).z for seed in (0, 1)]
    assert not np.allclose(*spectra)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"profile": []}, "profile must be a Profile"),
        ({"smallest_wavelength": 1e-4}, "smallest_wavelength must be at least 4 steps"),
        ({"points": 200}, "points must be a multiple of 16"),
        ({"points": 4096}, "profiles must be 4 times as long as a map"),
        ({"seeds": [-1]}, "seeds must be a whole number"),
    ],
)
def test_bad_arguments_are_refused(change, says):
    arguments = {"profile": ROUGH, "smallest_wavelength": SMALLEST, "points": POINTS} | change
    with pytest.raises(InputError, match=says):
        next(isotropic_maps(arguments.pop("profile"), **arguments))


def _along(lag):
    return np.mean((EVERY[lag:] - EVERY[:-lag]) ** 2)


def _periodic(z, lag):
    return np.mean([(np.roll(z, lag, axis=axis) - z) ** 2 for axis in (0, 1)])
