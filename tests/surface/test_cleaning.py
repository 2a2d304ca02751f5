"""Profiles and maps cleaned: each step does what it says, reports it, and leaves the rest alone."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.surface import HeightMap, clean, read_profile
from gripscale.surface.cleaning import (
    crop_map,
    crop_profile,
    mark_dropouts,
    mark_spikes,
    mark_steep_steps,
    subtract_form,
    subtract_trend,
    trim_map,
)

from .surface_cases import DATA, ROAD, ROAD_ONLY, profile_of

STEP = 1e-4
HEIGHTS = arrays(float, st.integers(20, 60), elements=st.floats(-5e-4, 5e-4))


def flat(**at):
    z = np.zeros(30)
    for index, height in at.items():
        z[int(index[1:])] = height
    return profile_of(z, STEP)


def missing(profile):
    return np.flatnonzero(np.isnan(profile.z)).tolist()


@pytest.mark.parametrize("width", [1, 2, 3])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_run_that_goes_out_and_back_is_a_spike(width, sign):
    z = np.zeros(30)
    z[10 : 10 + width] = sign * 3.0 * STEP
    marked, report = mark_spikes(profile_of(z, STEP))
    assert missing(marked) == list(range(10, 10 + width))
    assert (report.made_missing, report.missing) == (width, width)
    assert mark_spikes(profile_of(0.999 * z, STEP))[1].made_missing == 0


def test_edges_and_wide_stones_stay():
    z = np.zeros(40)
    z[10:14] = 8.0 * STEP
    z[20:] = 30.0 * STEP
    assert mark_spikes(profile_of(z, STEP))[1].made_missing == 0


def test_a_spike_on_an_edge_is_held_to_both_sides():
    """Beside an edge a spike stands off the higher side, too; one that does not is part of it."""
    z = np.where(np.arange(30) < 15, 0.0, 10.0 * STEP)
    z[14] = 14.0 * STEP
    assert missing(mark_spikes(profile_of(z, STEP))[0]) == [14]
    z[14] = 12.0 * STEP
    assert mark_spikes(profile_of(z, STEP))[1].made_missing == 0


def test_gaps_and_ends_are_bridged():
    """Slopes run to the nearest height over a gap; at an end one side decides."""
    assert missing(mark_spikes(flat(_9=np.nan, _10=7.0 * STEP, _11=np.nan))[0]) == [9, 10, 11]
    assert missing(mark_spikes(flat(_9=np.nan, _10=5.9 * STEP, _11=np.nan))[0]) == [9, 11]
    assert missing(mark_spikes(flat(_0=3.0 * STEP, _29=-4.0 * STEP))[0]) == [0, 29]


def test_both_points_of_a_steep_pair_are_spikes():
    marked, report = mark_steep_steps(flat(_10=3.0 * STEP))
    assert missing(marked) == [9, 10, 11]
    assert (report.made_missing, report.missing) == (3, 3)
    marked, _ = mark_steep_steps(flat(_10=2.999 * STEP))
    assert missing(marked) == []


def test_a_gap_hides_a_spike():
    profile = flat(_9=np.nan, _10=7.0 * STEP, _11=np.nan)
    assert missing(mark_steep_steps(profile)[0]) == [9, 11]


@settings(max_examples=60, deadline=None)
@given(z=HEIGHTS)
def test_no_steep_neighbours_remain_and_the_rest_is_untouched(z):
    profile = profile_of(z, STEP)
    if (np.abs(np.diff(z)) >= 3.0 * profile.step).all():
        return
    try:
        marked, report = mark_steep_steps(profile)
    except InputError:
        return  # all points were spikes
    assert not (np.abs(np.diff(marked.z)) >= 3.0 * profile.step).any()
    kept = np.isfinite(marked.z)
    assert np.array_equal(marked.z[kept], profile.z[kept])
    assert report.made_missing == (~kept).sum()
    assert missing(mark_steep_steps(marked)[0]) == missing(marked)  # one pass is complete


@settings(max_examples=40, deadline=None)
@given(z=HEIGHTS, offset=st.floats(-1e-2, 1e-2), slope=st.floats(-1.0, 1.0))
def test_a_line_added_is_a_line_taken_out(z, offset, slope):
    profile = profile_of(z, STEP)
    tilted = profile_of(z + offset + slope * profile.x, STEP)
    # Rounding of heights up to 1e-2 m: a few units in 1e-18 m, and as many from the sums.
    assert np.allclose(subtract_trend(tilted)[0].z, subtract_trend(profile)[0].z, atol=1e-16)
    assert abs(subtract_trend(tilted)[0].z.mean()) < 1e-16


def test_trend_ignores_and_keeps_missing_points():
    x = STEP * np.arange(30)
    z = 0.1 + 0.02 * x
    z[4] = np.nan
    levelled, _ = subtract_trend(profile_of(z, STEP))
    assert missing(levelled) == [4]
    assert np.nanmax(np.abs(levelled.z)) < 1e-16
    assert np.nanmean(subtract_trend(profile_of(z, STEP), "mean")[0].z) == pytest.approx(
        0, abs=1e-16
    )
    assert np.nanmax(subtract_trend(profile_of(z, STEP), "none")[0].z) == np.nanmax(z)


def test_crop_keeps_both_limits():
    profile = profile_of(np.arange(40.0), 1.0)
    cropped, report = crop_profile(profile, (10.0, 29.0))
    assert (cropped.x[0], cropped.x[-1], report.removed) == (10.0, 29.0, 20)


def test_heights_outside_the_valid_range_are_missing():
    profile = flat(_3=-9999.0, _4=np.nan, _5=2.0)
    marked, report = mark_dropouts(profile, (-1.0, 2.0))
    assert missing(marked) == [3, 4]
    assert report.made_missing == 1
    assert missing(profile) == [4]


def counted_in_the_file(path):
    """Count dropouts and spikes between the plates line by line, without the package."""
    lines = path.read_bytes().decode("latin-1").split("DATA*****")[1].split("\n")[2:]
    rows = [line.split() for line in lines if line.strip()]
    z = [float(z) for _, x, z in rows if 120.0 <= float(x) <= 1780.0]
    steep = [abs(b - a) >= 3.0 * 0.0374890 for a, b in pairwise(z)]
    spikes = sum(one or other for one, other in zip([False, *steep], [*steep, False], strict=True))
    return len(z), sum(height != height for height in z), spikes


@pytest.mark.parametrize(
    ("path", "expected"), [(ROAD[0], (44280, 2216, 1630)), (ROAD[1], (44280, 2654, 1947))]
)
def test_measured_road_counts(path, expected):
    """SOURCE.txt: dropouts 5-6 %, spikes about 4 %."""
    _, report = clean(read_profile(path), crop=ROAD_ONLY, spikes="iso13473")
    assert [step.step for step in report] == ["crop", "dropouts", "spikes", "trend"]
    counts = report["crop"].points, report["dropouts"].missing, report["spikes"].made_missing
    assert counts == expected == counted_in_the_file(path)
    assert report["trend"].points == 44280
    isolated = clean(read_profile(path), crop=ROAD_ONLY)[1]["spikes"]
    assert 0 < isolated.made_missing < 0.1 * expected[2]
    assert len(str(report).splitlines()) == 5


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"crop": (0.2, 0.1)}, r"crop must have its first number below"),
        ({"crop": (0.1, 0.2)}, "crop must leave at least 16 points"),
        ({"crop": 0.1}, "crop must be two numbers"),
        ({"crop": (float("nan"), 1.0)}, r"crop\[0\] must be a finite number"),
        ({"valid_range": (1.0, 2.0)}, "all missing"),
        ({"spike_slope": 0.0}, "spike_slope must be greater than zero"),
        ({"spike_slope": 1e-12}, "unit of heights or of distances looks wrong.*makes all of them"),
        ({"detrend": "cubic"}, "detrend must be one of linear, mean, none"),
    ],
)
def test_bad_arguments_are_refused(arguments, says):
    rough = profile_of(np.tile([0.0, 1e-5], 15), STEP)
    with pytest.raises(InputError, match=says):
        clean(rough, **arguments)


ACROSS = 2e-4


def map_of(z):
    return HeightMap(STEP * np.arange(z.shape[0]), ACROSS * np.arange(z.shape[1]), z)


def rough(shape=(24, 20), seed=0):
    return 1e-5 * np.random.default_rng(seed).standard_normal(shape)


def test_the_steps_in_their_order():
    z = rough() + 0.1 * STEP * np.arange(24)[:, None]
    z[0] = np.nan
    z[10, 10] += 20 * ACROSS
    z[5, 5] = -9.0
    cleaned, report = gs.clean_map(
        map_of(z), crop=((0.0, 22e-4), None), valid_range=(-1.0, 1.0), form=2
    )
    steps = [(step.step, step.points, step.removed, step.made_missing) for step in report]
    assert steps == [
        ("crop", 460, 20, 0),
        ("dropouts", 460, 0, 1),
        ("trim", 440, 20, 0),
        ("spikes", 440, 0, 1),
        ("form", 440, 0, 0),
    ]
    assert report["form"].missing == cleaned.missing == 2
    assert cleaned.x[0] == pytest.approx(STEP)
    assert np.nanmean(cleaned.z) == pytest.approx(0.0, abs=1e-18)
    slope = report["form"].note.split("slopes ")[1].split()[0]
    assert float(slope) == pytest.approx(0.1, rel=0.01)  # of rough heights
    assert len(str(report).splitlines()) == 6
    bare, report = gs.clean_map(map_of(rough()), trim=None, spikes=None, form=None)
    assert [step.step for step in report] == ["dropouts"]
    np.testing.assert_array_equal(bare.z, rough())


def test_crop_keeps_both_limits_of_each_way():
    cropped, report = crop_map(map_of(rough()), ((2e-4, 20e-4), (0.0, 30e-4)))
    assert (cropped.x[0], cropped.x[-1]) == pytest.approx((2e-4, 20e-4))
    assert cropped.z.shape == (19, 16)
    assert report.removed == 24 * 20 - 19 * 16


def test_a_turned_measurement_is_trimmed_to_its_middle():
    """Within a tilted square each border line left has at most half of it missing, and it is the
    largest such part: the next line outwards has more."""
    x = np.linspace(-1.0, 1.0, 60)
    away = np.abs(x[:, None] + 0.3 * x) + np.abs(x - 0.3 * x[:, None])
    z = np.where(away > 1.3, np.nan, rough((60, 60)))
    cut, report = trim_map(map_of(z))
    inside = np.isnan(cut.z)
    borders = [inside[0], inside[-1], inside[:, 0], inside[:, -1]]
    assert max(line.mean() for line in borders) <= 0.5
    assert 0 < report.removed < z.size / 2
    first, last = (round(cut.x[i] / STEP) for i in (0, -1))
    low, high = (round(cut.y[i] / ACROSS) for i in (0, -1))
    assert np.isnan(z[first - 1, low : high + 1]).mean() > 0.5
    assert np.isnan(z[last + 1, low : high + 1]).mean() > 0.5


def test_gaps_inside_stay():
    z = rough()
    z[8:12, 8:12] = np.nan
    cut, report = trim_map(map_of(z))
    assert (report.removed, cut.missing) == (0, 16)


@pytest.mark.parametrize("size", [(1, 1), (1, 2), (2, 2), (3, 3)])
def test_spikes_of_few_points_are_found_and_nothing_else(size):
    z = rough()
    limit = 3.0 * ACROSS
    z[7 : 7 + size[0], 9 : 9 + size[1]] += limit + 1e-4
    marked, report = mark_spikes(map_of(z))
    expected = np.zeros(z.shape, dtype=bool)
    expected[7 : 7 + size[0], 9 : 9 + size[1]] = True
    np.testing.assert_array_equal(np.isnan(marked.z), expected)
    assert report.made_missing == expected.sum()


def test_spikes_downwards_at_borders_and_by_gaps():
    z = rough()
    z[0, 0] = z[23, 8] = z[12, 12] = -3.1 * ACROSS
    z[11, 11:14] = np.nan
    marked, _ = mark_spikes(map_of(z))
    assert np.isnan(marked.z[[0, 23, 12], [0, 8, 12]]).all()
    assert marked.missing == 6


def test_an_edge_of_a_stone_is_no_spike():
    """A step ten times too steep for a profile: a straight edge stays, point by point."""
    z = rough()
    z[12:] += 30.0 * ACROSS
    assert mark_spikes(map_of(z))[1].made_missing == 0
    assert mark_spikes(map_of(z).lines()[4])[1].made_missing == 0


@pytest.mark.parametrize("axis", [0, 1])
def test_a_crest_one_step_wide_is_no_spike(axis):
    z = rough()
    np.moveaxis(z, axis, 0)[12] += 30.0 * ACROSS
    assert mark_spikes(map_of(z))[1].made_missing == 0


def test_the_form_is_that_of_all_terms_at_once():
    """Against one table of all terms at all points."""
    z = rough() + 1e-3 * np.sin(np.arange(24.0))[:, None]
    z[3:9, 2:5] = np.nan
    x, y = np.meshgrid(np.linspace(-1, 1, 24), np.linspace(-1, 1, 20), indexing="ij")
    known = np.isfinite(z)
    table = np.stack([x**m * y**n for m in range(4) for n in range(4 - m)], axis=-1)
    rest = z[known] - table[known] @ np.linalg.lstsq(table[known], z[known], rcond=None)[0]
    found, _ = subtract_form(map_of(z), 3)
    np.testing.assert_allclose(found.z[known], rest, atol=1e-15)


def test_a_shallow_sphere_is_a_paraboloid():
    """Radius 50 mm under 2.3 x 3.8 mm: what is left is the fourth order, r^4/(8 R^3)."""
    x, y = (STEP * (np.arange(24) - 11.5))[:, None], ACROSS * (np.arange(20) - 9.5)
    sphere = 0.05 - np.sqrt(0.05**2 - x**2 - y**2)
    left, _ = subtract_form(map_of(sphere), 2)
    assert np.ptp(sphere) > 4e-5
    assert np.abs(left.z).max() < (x.max() ** 2 + y.max() ** 2) ** 2 / (8 * 0.05**3)


def test_a_measured_map_has_its_documented_roughness():
    cleaned, report = gs.clean_map(gs.read_map(DATA / "surfaces" / "al3d-1.al3d"))
    assert cleaned.z.std() == pytest.approx(0.29e-6, abs=0.005e-6)  # SOURCE.txt, two digits
    assert report["spikes"].made_missing == 0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"crop": (0.1, 0.2)}, r"crop along x must be two numbers"),
        ({"crop": 0.1}, "crop must be limits along x and along y, or None; got 0.1"),
        ({"crop": (None, (2e-4, 1e-4))}, "crop along y must have its first number below"),
        ({"crop": (None, (0.0, 1e-3))}, "at least 16 points along y; .* leaves 6 of a map"),
        ({"valid_range": (1.0, 2.0)}, "all missing"),
        ({"valid_range": (1.0, float("nan"))}, r"valid_range\[1\] must be a finite number"),
        ({"trim": 1.5}, "trim must be at most 1; got 1.5"),
        ({"trim": -0.5}, "trim must not be negative"),
        ({"spike_slope": 0.0}, "spike_slope must be greater than zero"),
        ({"form": 9}, "form must be a whole number from 0 to 8; got 9"),
        ({"form": 1.5}, "form must be a whole number"),
        ({"form": "plane"}, "form must be a finite number"),
    ],
)
def test_bad_arguments_of_maps_are_refused(arguments, says):
    with pytest.raises(InputError, match=says):
        gs.clean_map(map_of(rough()), **arguments)


def test_maps_with_too_little_are_refused():
    z = np.full((24, 20), np.nan)
    z[4:9, 4:9] = 0.0
    with pytest.raises(InputError, match="trim must leave at least 16 points a way; lines with a"):
        gs.clean_map(map_of(z))
    with pytest.raises(InputError, match="form 8 must have at least 45 heights; got 25"):
        gs.clean_map(map_of(z), trim=None, form=8)
    half = map_of(np.vstack([rough(), np.full((16, 20), np.nan)]))
    with pytest.raises(InputError, match=r"crop must leave some heights; .* has none"):
        gs.clean_map(half, crop=((24e-4, 1.0), None))
    with pytest.raises(InputError, match="surface must be a HeightMap; got Profile"):
        gs.clean_map(gs.Profile(np.arange(16.0), np.zeros(16)))
