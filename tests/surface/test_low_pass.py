"""Low passes: flanks that rubber follows, cut-offs without ringing, waves beyond the footprint."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import spherical_jn

import gripscale as gs
from gripscale.experiment.task import canonical_json
from gripscale.half_space import one_period
from gripscale.surface import Measured, find_cut_off, profile_spectrum, slope_by_wavelength
from gripscale.surface.low_pass import (
    PER_FOOTPRINT,
    followed,
    long_waves,
    longest_held,
    upper_envelope,
)
from gripscale.surface.synthetic import self_affine_profile
from tests.samples import ZENER

from .surface_cases import profile_of

FINE = 2e-5
POSITION = FINE * np.arange(2000)
PLATEAU = np.where(np.abs(POSITION - 2e-2) < 5e-3, 5e-3, 0.0)


def test_a_step_becomes_a_flank_of_the_stated_slope():
    """The plateau is kept, its foot filled by the slope; waves of two steps change nothing else."""
    line = one_period(gs.Profile(POSITION, PLATEAU), 2.0 * FINE, steepest=4.0)
    z = np.interp(POSITION, line.x, line.z)
    z -= z.min()
    edge = 5e-3 - np.abs(POSITION - 2e-2)
    cone = np.clip(5e-3 + 4.0 * np.minimum(edge, 0.0), 0.0, 5e-3)
    # the plateau ends at its last point, up to a step inside
    np.testing.assert_allclose(z, cone, atol=4.0 * 1.1 * FINE)


@pytest.mark.parametrize("cut", [1.6e-3, 0.4e-3, 0.08e-3])
def test_a_cut_off_does_not_ring_beside_a_step(cut):
    """A sharp cut overshoots by 8.9 % of the step; the Gaussian not, but for 1/16 of the waves that
    four points in the cut-off do not carry: 0.6 % of a jump, less of a flank."""
    for steepest in (4.0, np.inf):
        line = one_period(gs.Profile(POSITION, PLATEAU), cut, steepest=steepest)
        fine = np.fft.irfft(np.fft.rfft(line.z), 16 * len(line)) * 16.0
        middle = np.abs(np.linspace(0.0, 4e-2, fine.size, endpoint=False) - 2e-2) < 1e-3
        assert abs(fine.max() - fine[middle].mean()) < 0.006 * 5e-3


def test_a_map_of_cones_is_its_own_envelope():
    """A point above a plane becomes a cone, over the periods too; what is gentle stays as it is."""
    z = np.zeros((40, 50))
    z[3, 45] = 1e-3
    raised = upper_envelope(z, (2e-5, 3e-5), 2.0)
    along, across = np.meshgrid(np.arange(40), np.arange(50), indexing="ij")
    x = 2e-5 * np.minimum((along - 3) % 40, (3 - along) % 40)
    y = 3e-5 * np.minimum((across - 45) % 50, (45 - across) % 50)
    straight = np.maximum(1e-3 - 2.0 * np.hypot(x, y), 0.0)
    # distances along the grid and its diagonals are up to 13 % longer where steps are as 2 to 3
    assert (raised <= straight + 1e-15).all()
    assert (raised >= np.maximum(1e-3 - 2.0 * 1.135 * np.hypot(x, y), 0.0) - 1e-15).all()
    np.testing.assert_allclose(
        upper_envelope(raised, (2e-5, 3e-5), 2.0), raised, rtol=0.0, atol=1e-15
    )
    gentle = 1e-5 * np.sin(2.0 * np.pi * along / 40)
    assert (upper_envelope(gentle, (2e-5, 3e-5), 2.0) == gentle).all()


def test_gentle_lines_are_kept():
    """But for the straight line through the first and the last point, whose rise is a step's."""
    wave = gs.Profile(POSITION, 1e-4 * np.cos(2.0 * np.pi * POSITION / 4e-3))
    line = one_period(wave)
    step = wave.z[0] - wave.z[-1]
    np.testing.assert_allclose(line.z, one_period(wave, steepest=np.inf).z, atol=1e-15)
    np.testing.assert_allclose(line.z, wave.z, atol=2.0 * abs(step))


REFUSED = [
    ({"steepest": 0.0}, "steepest must be greater than zero; got 0"),
    ({"smallest_wavelength": 1e-5}, "smallest_wavelength must be at least two steps of the line"),
    ({"smallest_wavelength": 1.0}, "smallest_wavelength must be at most the period 0.04 m"),
]


@pytest.mark.parametrize(("change", "sentence"), REFUSED)
def test_bad_input_is_named(change, sentence):
    with pytest.raises(gs.InputError, match=sentence):
        one_period(gs.Profile(POSITION, PLATEAU), **change)


# Lines and maps are described without the flanks that rubber cannot follow, as in a case.

X = 1e-4 * np.arange(4000)
EDGES = np.where((np.arange(4000) // 400) % 2, 2e-3, 0.0)
ROUGH = 1e-5 * np.random.default_rng(3).standard_normal((60, 50)).cumsum(axis=0)
LINE = gs.Profile(X, EDGES + 1e-5 * np.random.default_rng(2).standard_normal(4000).cumsum())
MAP = gs.HeightMap(X[:60], X[:50], np.where(ROUGH > 0.0, 1e-3, 0.0) + ROUGH)


@pytest.mark.parametrize("heights", [LINE, MAP], ids=["line", "map"])
def test_numbers_by_hand_are_those_of_a_case(heights):
    """Of heights with edges; filled twice they are the same object, whose numbers are the same."""
    case = Measured.of(heights if isinstance(heights, gs.HeightMap) else [heights])
    once = followed(heights)
    assert followed(once) is once
    for of in (gs.height_difference, profile_spectrum, slope_by_wavelength):
        by_hand = canonical_json(of(heights))
        assert canonical_json(of(once)) == by_hand != canonical_json(of(heights, steepest=np.inf))
    assert canonical_json(gs.height_difference(case.followed)) == canonical_json(
        gs.height_difference(heights)
    )
    assert find_cut_off(case.slopes, "instrument") == find_cut_off(heights, "instrument")


@pytest.mark.parametrize("heights", [LINE, MAP], ids=["line", "map"])
def test_gaps_stay_and_make_nothing_steep(heights):
    """A wide gap beside an edge and many small ones; what is filled twice is the same object."""
    gaps = np.random.default_rng(4).random(heights.z.shape) < 0.05
    gaps[20:35] = True
    gappy = replace(heights, z=np.where(gaps, np.nan, heights.z))
    once = followed(gappy)
    assert (np.isnan(once.z) == gaps).all()
    assert followed(once) is once
    assert np.nanmax(np.abs(np.diff(once.z, axis=0))) <= 4e-4 * (1.0 + 1e-9)


def test_the_texture_of_standards_keeps_all_flanks():
    """The edges of the line rise by 20; its rms slope by ISO 21920-2 has them."""
    raw = np.diff(LINE.z - np.polyval(np.polyfit(X, LINE.z, 1), X)) / 1e-4
    assert gs.surface.texture(LINE).rms_slope == pytest.approx(np.sqrt(np.mean(raw**2)), rel=1e-9)


# Waves beyond the footprint: what the filter leaves, and when a case leaves them out.

STEP, CUT = 1e-3, 0.15


def wave(length, points=20_000):
    return np.sin(2.0 * np.pi * STEP * np.arange(points) / length)


def unevenness(points):
    """Return waves of metres, mean square falling as a power of the wavenumber (ISO 8608)."""
    q = np.fft.rfftfreq(points, STEP)
    size = np.where((q > 0.0) & (q < 5.0), 1.0 / np.maximum(q, 1e-9), 0.0)
    phase = np.exp(2j * np.pi * np.random.default_rng(1).random(q.size))
    heights = np.fft.irfft(size * phase, points)
    return 8e-3 * heights / heights.std()


@pytest.mark.parametrize(("ratio", "left"), [(1.0, 0.5), (0.5, 1.0 / 16.0), (2.0, 0.5**0.25)])
def test_of_a_wave_of_the_cut_off_half_is_long(ratio, left):
    heights = wave(ratio * CUT)
    middle = slice(5000, 15_000)
    kept = long_waves(profile_of(heights, STEP), CUT)[middle]
    assert kept == pytest.approx(left * heights[middle], abs=1e-3)


def test_a_tilted_line_is_long_to_its_ends_and_beside_gaps():
    heights = 0.05 * STEP * np.arange(2000) + 3.0
    heights[700:760] = heights[0:3] = np.nan
    heights[[1000, 1002]] = np.nan
    kept = long_waves(profile_of(heights, STEP), CUT)
    measured = np.isfinite(heights)
    assert kept[measured] == pytest.approx(heights[measured], abs=1e-6)


def test_the_line_below_a_block_leaves_a_quarter_of_the_mean_square_at_the_cut_off():
    x = np.pi / PER_FOOTPRINT
    left = 1.0 - spherical_jn(0, x) ** 2 - 3.0 * spherical_jn(1, x) ** 2
    assert left == pytest.approx(0.25, abs=0.01)
    # the same from windows of a wave, each without its line
    points = 300
    windows = wave(PER_FOOTPRINT * points * STEP, 200_017)[: 600 * points].reshape(-1, points)
    line = np.polynomial.polynomial.polyfit(np.arange(points), windows.T, 1)
    rest = windows - np.polynomial.polynomial.polyval(np.arange(points), line)
    assert rest.var() / windows.var() == pytest.approx(left, abs=0.02)


def test_waves_of_metres_are_left_out_of_a_road_in_steps_of_a_millimetre():
    texture = self_affine_profile(
        hurst=0.8, xi_parallel=0.005, xi_perpendicular=7e-4, step=STEP, length=20.0, seed=2
    )
    road = gs.Profile(texture.x, texture.z + unevenness(len(texture)), "road")
    load = {"pressure": "3 bar", "speed": 1.0}
    case = gs.Case(road, ZENER, cleaning={}, **load)
    alone = gs.Case(texture, ZENER, **load)
    found, wanted = (each.surface.measured.self_affine for each in (case, alone))
    assert found.hurst == pytest.approx(wanted.hurst, abs=0.03)
    lags = alone.surface.correlation.lag < 0.01
    correlation = case.surface.correlation.value[lags]
    assert correlation == pytest.approx(alone.surface.correlation.value[lags], rel=0.05)
    assert alone.surface.measured.longest is None
    assert case.cleaning["longest_wavelength"] == pytest.approx(0.15)
    (sentence,) = (str(f) for f in case.findings() if "longest_wavelength" in str(f))
    assert "Waves beyond 150 mm are left out: they hold 99 % of the mean square height" in sentence
    everything = gs.Case(road, ZENER, longest_wavelength="1 km", **load)
    assert everything.surface.sines.wavelength[0] > 1.0
    assert not any("are left out" in str(finding) for finding in everything.findings())


def test_a_case_with_long_waves_left_out_is_saved_with_the_length(tmp_path):
    z = 1e-3 * wave(1.0, 4000) + 1e-4 * np.random.default_rng(3).standard_normal(4000)
    road = gs.Profile(STEP * np.arange(4000), z, "road")
    load = {"pressure": "3 bar", "speed": 1.0, "footprint": "80 mm"}
    case = gs.Case(road, ZENER, cleaning={}, **load)
    again = gs.read_case(case.save(tmp_path / "case.toml"))
    assert "longest_wavelength = 0.12" in again.origin.text
    assert again.surface.sines.wavelength == pytest.approx(case.surface.sines.wavelength, rel=1e-9)


def test_profiles_no_longer_than_what_a_footprint_holds_keep_their_waves():
    line = profile_of(wave(0.2, 150), STEP)
    assert longest_held([line], 0.1) is None
    assert longest_held([line], 0.05) == pytest.approx(0.075)
