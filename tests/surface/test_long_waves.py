"""Waves beyond the footprint: what the filter leaves, and when a case leaves them out."""

import numpy as np
import pytest
from scipy.special import spherical_jn

import gripscale as gs
from gripscale.surface.low_pass import PER_FOOTPRINT, long_waves, longest_held
from gripscale.surface.synthetic import self_affine_profile
from tests.samples import ZENER

from .surface_cases import profile_of

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
