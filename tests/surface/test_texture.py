"""Texture against closed forms, certified roughness and two other programs."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.special

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.surface import HeightMap, Profile, clean, texture

from .surface_cases import DATA

A, LENGTH = 1e-3, 25e-3
STEP = 0.05e-3


def line(shape, length=0.5, step=STEP) -> Profile:
    """Return a profile of a function of the phase of waves of 25 mm."""
    x = np.arange(round(length / step)) * step
    return Profile(x, shape(2.0 * np.pi * x / LENGTH))


def sine_map(points=256, waves=4, slope=0.5) -> HeightMap:
    x = np.arange(points) * 1e-5
    q = 2.0 * np.pi * waves / (points * 1e-5)
    return HeightMap(x, x, np.tile(slope / q * np.cos(q * x)[:, None], (1, points)))


def test_heights_and_slope_of_a_sine_line() -> None:
    """Whole periods; the subtracted line and the end between the last point and the first leave
    1e-3, the difference between neighbours (q step)^2/24."""
    found = texture(line(lambda phase: A * np.cos(phase)))
    assert found.rms_height == pytest.approx(A / np.sqrt(2.0), rel=1e-3)
    assert found.mean_deviation == pytest.approx(2.0 * A / np.pi, rel=1e-3)
    assert found.skewness == pytest.approx(0.0, abs=1e-3)
    assert found.kurtosis == pytest.approx(1.5, rel=1e-3)
    assert found.total_height == pytest.approx(2.0 * A, rel=1e-3)
    assert found.rms_slope == pytest.approx(2.0 * np.pi / LENGTH * A / np.sqrt(2.0), rel=1e-3)
    assert np.isnan(found.rms_gradient)
    assert found.rms_height.attrs["units"] == "m"


def test_profile_depth_of_closed_forms() -> None:
    """Samples lie up to 0.25 mm off the highest points: 0.2 % of 25 mm, 0.8 % of 12.5 mm.

    Highest points: 3/2 A of cos + cos 2/2, and 3/4 A (at cos = -1/2) of the same upside down.
    """

    def humps(phase: np.ndarray) -> np.ndarray:
        return A * (np.cos(phase) + 0.5 * np.cos(2.0 * phase))

    for shape, depth in ((humps, 1.5 * A), (lambda phase: -humps(phase), 0.75 * A)):
        found = texture(line(shape))
        assert found.depth_segments == 5
        assert found.mean_profile_depth == pytest.approx(depth, rel=8e-3)


def test_profile_depth_is_the_mean_of_both_halves_of_level_segments() -> None:
    """Waves of A and 3 A in the halves of each segment, on a slope: the mean is 2 A.

    Troughs are at the step from A to 3 A, where the filter rings, and crests 12.5 mm off.
    """
    half = 0.05 / LENGTH * 2.0 * np.pi
    profile = line(lambda phase: -A * np.where(phase % (2 * half) < half, 1, 3) * np.cos(phase))
    tilted = Profile(profile.x, profile.z + 0.3 * profile.x)
    assert texture(tilted).mean_profile_depth == pytest.approx(2.0 * A, rel=0.01)


def test_waves_below_the_filter_do_not_make_depth() -> None:
    """Second order forwards and backwards: 1/2 at 2.4 mm, times what averaging over 0.5 mm leaves.

    5 %: in the first and the last of 20 segments the filter begins and ends.
    """
    x = np.arange(40_000) * STEP

    def depth(wavelength: float) -> float:
        # gentle slopes: the standard takes steps steeper than 3 out
        profile = Profile(x, 0.1 * A * np.cos(2.0 * np.pi * x / wavelength))
        return 10.0 * float(texture(profile).mean_profile_depth)

    averaged = np.sinc(0.5 / 2.4)
    assert depth(2.4e-3) == pytest.approx(0.5 * averaged * A, rel=0.05)
    assert depth(1.1e-3) < 0.03 * A


@pytest.mark.parametrize(("station", "depth"), [(0, 3.2953147e-3), (1, 3.0452668e-3)])
def test_profile_depth_of_the_shipped_road(station, depth) -> None:
    """captif-slp 0.22 (MIT), the program of the laboratory that measured the road, for the same
    cleaned heights with 15 % of them allowed to miss. It rounds heights to 1e-9 m."""
    profile = gs.read_profile(DATA / "road" / f"20211011_aylesbury_dec_station_{station}.dat")
    cleaned, _ = clean(profile, crop=(0.12, 1.78), spikes="iso13473")
    found = texture(cleaned)
    assert found.mean_profile_depth == pytest.approx(depth, abs=1e-9)
    assert found.depth_segments == 15 - station


def test_certified_roughness_of_a_line() -> None:
    """Rq = 3.959 um in the file, behind a filter of the instrument that is not applied here."""
    found = texture(gs.read_profile(DATA / "surfaces" / "mitutoyo_2_mock.xlsx"))
    assert found.rms_height == pytest.approx(3.959e-6, rel=5e-3)
    assert np.isnan(found.mean_profile_depth)
    assert found.depth_note == "shorter than 100 mm"


def test_measured_map_is_that_of_surfalize() -> None:
    """surfalize 0.19.2 (MIT), of the same levelled heights. The two take the same triangles for
    Sdr; in Sdq points on the border weigh more there."""
    found = texture(gs.read_map(DATA / "surfaces" / "al3d-1.al3d"))
    expected = {
        "mean_deviation": 0.23019610806765e-6,
        "rms_height": 0.28982210278363e-6,
        "skewness": -0.0049765253707,
        "kurtosis": 3.0712779005932,
        "peak_height": 1.07622216705753e-6,
        "pit_depth": 1.01009362537128e-6,
        "total_height": 2.08631579242880e-6,
        "developed_area_ratio": 0.0039977987819575,
    }
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=1e-9), name
    assert found.rms_gradient == pytest.approx(0.08968701464497, rel=1e-3)


def test_gradient_and_area_of_a_sine_map() -> None:
    """sqrt(1 + s^2 cos^2) has the mean 2/pi E(-s^2); neighbours leave (q step)^2/24 = 4e-4."""
    found = texture(sine_map(slope=0.5))
    area = 2.0 / np.pi * scipy.special.ellipe(-(0.5**2)) - 1.0
    assert found.rms_gradient == pytest.approx(0.5 / np.sqrt(2.0), rel=5e-3)
    assert found.developed_area_ratio == pytest.approx(area, rel=1e-2)
    assert found.kurtosis == pytest.approx(1.5, rel=1e-2)


def test_gaussian_heights_have_no_skewness() -> None:
    """Four standard errors, sqrt(6/N) and sqrt(24/N)."""
    z = np.random.default_rng(5).standard_normal((300, 300))
    found = texture(HeightMap(np.arange(300.0), np.arange(300.0), z))
    assert found.skewness == pytest.approx(0.0, abs=4.0 * np.sqrt(6.0) / 300.0)
    assert found.kurtosis == pytest.approx(3.0, abs=4.0 * np.sqrt(24.0) / 300.0)


def test_missing_heights_have_no_weight() -> None:
    """A roof has one slope everywhere: holes change neither gradient nor area, to rounding."""
    x = np.linspace(-1.0, 1.0, 41)
    z = np.tile(-0.7 * np.abs(x)[:, None], (1, 41))
    z[5:9, 19:22] = z[-9:-5, 19:22] = np.nan  # in both flanks: the plane stays level
    found = texture(HeightMap(x, x, z))
    assert found.rms_gradient == pytest.approx(0.7, rel=1e-9)
    assert found.developed_area_ratio == pytest.approx(np.sqrt(1.49) - 1.0, rel=1e-9)
    assert found.mean_deviation == pytest.approx(np.nanmean(np.abs(z - np.nanmean(z))), rel=1e-9)


def test_segments_with_many_missing_heights_do_not_count() -> None:
    """Interpolated flanks of a sine: 1 % at gaps of 0.5 mm."""
    profile = line(lambda phase: A * np.cos(phase))
    z = profile.z.copy()
    z[100::200] = np.nan
    z[2100:2500] = np.nan  # 20 of the 100 mm of the second segment
    found = texture(Profile(profile.x, z))
    assert found.depth_segments == 4
    assert found.mean_profile_depth == pytest.approx(A, rel=0.01)
    z[(np.arange(z.size) // 400) % 2 == 0] = np.nan
    assert texture(Profile(profile.x, z)).depth_note == "more than 15% of heights missing"


def test_several_profiles_are_taken_together() -> None:
    low, high = (line(lambda phase, size=size: size * A * np.cos(phase)) for size in (1.0, 2.0))
    found = texture([low, high])
    assert found.depth_segments == 10
    assert found.mean_profile_depth == pytest.approx(1.5 * A, rel=3e-3)
    assert found.rms_height == pytest.approx(np.sqrt(2.5 / 2.0) * A, rel=1e-3)


def test_no_number_without_its_heights() -> None:
    coarse = line(lambda phase: A * np.cos(phase), step=2e-3)
    assert texture(coarse).depth_note == "step above 1 mm"
    flat = texture(line(lambda phase: 0.0 * phase))
    assert flat.rms_height == 0.0
    assert np.isnan(flat.skewness)
    with pytest.raises(InputError, match="must be a Profile or a list"):
        texture("road")
