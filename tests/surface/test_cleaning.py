from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gripscale.core.errors import InputError
from gripscale.surface import clean, read_profile
from gripscale.surface.cleaning import (
    crop_profile,
    mark_dropouts,
    mark_spikes,
    mark_steep_steps,
    subtract_trend,
)

from .surface_cases import ROAD, ROAD_ONLY, profile_of

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
