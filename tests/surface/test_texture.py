"""Texture against closed forms, certified roughness and two other programs."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.questions.inputs.page import texture_table
from gripscale.surface import HeightMap, Measured, Profile, clean, texture, texture_levels
from gripscale.surface.texture import beside_label

from .surface_cases import DATA

A, LENGTH = 1e-3, 25e-3
STEP = 0.05e-3


def line(shape, length=0.5, step=STEP):
    """Return a profile of a function of the phase of waves of 25 mm."""
    x = np.arange(round(length / step)) * step
    return Profile(x, shape(2.0 * np.pi * x / LENGTH))


def test_heights_and_slope_of_a_sine_line():
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


def test_profile_depth_of_closed_forms():
    """Samples lie up to 0.25 mm off the highest points: 0.2 % of 25 mm, 0.8 % of 12.5 mm.

    Highest points: 3/2 A of cos + cos 2/2, and 3/4 A (at cos = -1/2) of the same upside down.
    """

    def humps(phase):
        return A * (np.cos(phase) + 0.5 * np.cos(2.0 * phase))

    for shape, depth in ((humps, 1.5 * A), (lambda phase: -humps(phase), 0.75 * A)):
        found = texture(line(shape))
        assert found.depth_segments == 5
        assert found.mean_profile_depth == pytest.approx(depth, rel=8e-3)


@pytest.mark.parametrize(("station", "depth"), [(0, 3.2953147e-3), (1, 3.0452668e-3)])
def test_profile_depth_of_the_shipped_road(station, depth):
    """captif-slp 0.22 (MIT), the program of the laboratory that measured the road, for the same
    cleaned heights with 15 % of them allowed to miss. It rounds heights to 1e-9 m."""
    profile = gs.read_profile(DATA / "road" / f"20211011_aylesbury_dec_station_{station}.dat")
    cleaned, _ = clean(profile, crop=(0.12, 1.78), spikes="iso13473")
    found = texture(cleaned)
    assert found.mean_profile_depth == pytest.approx(depth, abs=1e-9)
    assert found.depth_segments == 15 - station


def test_certified_roughness_of_a_line():
    """Rq = 3.959 um in the file, behind a filter of the instrument that is not applied here."""
    found = texture(gs.read_profile(DATA / "surfaces" / "mitutoyo_2_mock.xlsx"))
    assert found.rms_height == pytest.approx(3.959e-6, rel=5e-3)
    assert np.isnan(found.mean_profile_depth)
    assert found.depth_note == "shorter than 100 mm"


def test_measured_map_is_that_of_surfalize():
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


def test_missing_heights_have_no_weight():
    """A roof has one slope everywhere: holes change neither gradient nor area, to rounding."""
    x = np.linspace(-1.0, 1.0, 41)
    z = np.tile(-0.7 * np.abs(x)[:, None], (1, 41))
    z[5:9, 19:22] = z[-9:-5, 19:22] = np.nan  # in both flanks: the plane stays level
    found = texture(HeightMap(x, x, z))
    assert found.rms_gradient == pytest.approx(0.7, rel=1e-9)
    assert found.developed_area_ratio == pytest.approx(np.sqrt(1.49) - 1.0, rel=1e-9)
    assert found.mean_deviation == pytest.approx(np.nanmean(np.abs(z - np.nanmean(z))), rel=1e-9)


def test_segments_with_many_missing_heights_do_not_count():
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


def test_several_profiles_are_taken_together():
    low, high = (line(lambda phase, size=size: size * A * np.cos(phase)) for size in (1.0, 2.0))
    found = texture([low, high])
    assert found.depth_segments == 10
    assert found.mean_profile_depth == pytest.approx(1.5 * A, rel=3e-3)
    assert found.rms_height == pytest.approx(np.sqrt(2.5 / 2.0) * A, rel=1e-3)


def test_no_number_without_its_heights():
    coarse = line(lambda phase: A * np.cos(phase), step=2e-3)
    assert texture(coarse).depth_note == "step above 1 mm"
    flat = texture(line(lambda phase: 0.0 * phase))
    assert flat.rms_height == 0.0
    assert np.isnan(flat.skewness)
    with pytest.raises(InputError, match="must be a Profile or a list"):
        texture("road")


# Texture levels, g-factor, lengths and direction of a texture: closed forms and surfalize.

CORRELATION = 6e-4
"""Length of the Gaussian autocorrelation across the ridges [m]."""


def ridges(degrees, ratio=3.0, points=256, step=1e-4):
    """Return Gaussian heights `ratio` times as long along their ridges as across."""
    q = 2.0 * np.pi * np.fft.fftfreq(points, step)
    qx, qy = np.meshgrid(q, q, indexing="ij")
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    along, across = qx * cos + qy * sin, qy * cos - qx * sin
    squares = (across * CORRELATION) ** 2 + (along * ratio * CORRELATION) ** 2
    noise = np.random.default_rng(3).standard_normal((points, points))
    z = 1e-4 * np.fft.ifft2(np.exp(-0.125 * squares) * np.fft.fft2(noise)).real
    x = np.arange(points) * step
    return HeightMap(x, x, z)


@pytest.mark.parametrize(
    ("degrees", "length", "aspect"),
    [(20.0, 734.133e-6, 0.324992), (0.0, 749.550e-6, 0.372204), (110.0, 727.282e-6, 0.286030)],
)
def test_lengths_of_a_texture_are_those_of_surfalize(degrees, length, aspect):
    """surfalize 0.19.2 (MIT) of the same levelled heights: cubic between points, ours linear.

    The step is a sixth of the length: (step/length)^2/8 of a Gaussian, 0.3 %, at the short one.
    """
    numbers = texture(ridges(degrees))
    assert numbers.autocorrelation_length == pytest.approx(length, rel=8e-3)
    assert numbers.texture_aspect_ratio == pytest.approx(aspect, rel=8e-3)


def test_length_of_a_measured_map_is_that_of_surfalize():
    """Its longest way bends round a corner, which the straight ways of the standard do not."""
    numbers = texture(gs.read_map(DATA / "surfaces" / "al3d-1.al3d"))
    assert numbers.autocorrelation_length == pytest.approx(12.394401e-6, rel=8e-3)


@pytest.mark.parametrize("degrees", [20.0, 45.0, 110.0, 179.0])
def test_direction_of_ridges(degrees):
    """The spectrum of 8:1 is as wide as atan(1/8), 7 degrees; few waves make most of it."""
    found = np.degrees(texture(ridges(degrees, ratio=8.0)).texture_direction)
    assert (found - degrees + 90.0) % 180.0 - 90.0 == pytest.approx(0.0, abs=7.0)


def test_flat_map_has_no_length():
    x = np.arange(32) * 1e-4
    numbers = texture(HeightMap(x, x, np.zeros((32, 32))))
    for name in ("autocorrelation_length", "texture_aspect_ratio", "texture_direction"):
        assert np.isnan(numbers[name]), name


def cusps(sign):
    """Return parabolas that meet in cusps, upwards or downwards, 25 mm long."""
    x = np.arange(10_000) * STEP
    u = np.abs((x / 25e-3) % 1.0 - 0.5) / 0.5
    return Profile(x, sign * 1e-3 * u**2)


@pytest.mark.parametrize(("sign", "share"), [(1.0, 1.0 - 0.5**0.5), (-1.0, 0.5**0.5)])
def test_g_factor_of_cusps(sign, share):
    """u^2 > 1/2 for u > sqrt(1/2): single peaks below a half, plateaus above it.

    Averages over 0.5 mm lower the cusps by 4 %: 0.015 of the share. Eight crossings of the middle
    lie within a sample, 0.5 % of the segment. The share above the mean would be 0.42.
    """
    assert texture(cusps(sign)).g_factor == pytest.approx(share, abs=0.03)


def wave(wavelength, amplitude=1e-4, length=1.0):
    x = np.arange(round(length / STEP)) * STEP
    return Profile(x, amplitude * np.cos(2.0 * np.pi * x / wavelength))


@pytest.mark.parametrize("wavelength", [1e-3, 5e-3, 12.5e-3, 50e-3])
def test_level_of_a_wave(wavelength):
    """10 log10(A^2/2) re 1 um = 37.0 dB in its own band, from the definition.

    The window spreads it over three of 20 bands' points at 50 mm: within 0.05 dB.
    """
    levels = texture_levels(wave(wavelength)).level
    assert levels.sel(wavelength=wavelength) == pytest.approx(
        10.0 * np.log10(0.5 * 100.0**2), abs=0.05
    )
    others = levels.where(np.abs(np.log10(levels.wavelength / wavelength)) > 0.15, drop=True)
    assert (others < 0.0).all()


def test_levels_go_to_a_twelfth_of_the_length_and_four_steps():
    lengths = texture_levels(wave(5e-3, length=0.61)).wavelength.values
    assert lengths[0] == pytest.approx(50e-3)
    assert lengths[-1] == pytest.approx(0.25e-3)
    assert (np.diff(lengths) < 0.0).all()


def test_levels_of_white_noise_rise_by_the_bandwidth():
    """Of a flat spectrum a third of an octave holds ten times less per decade of wavelength.

    A band of 50 mm has 5 points at 1 m: 20 profiles scatter by 0.4 dB.
    """
    x = np.arange(20_000) * STEP
    rng = np.random.default_rng(1)
    lines = [Profile(x, 1e-5 * rng.standard_normal(x.size), name=f"{i}") for i in range(20)]
    levels = texture_levels(lines).level
    fall = float(levels.sel(wavelength=5e-4) - levels.sel(wavelength=5e-2))
    assert fall == pytest.approx(20.0, abs=1.2)
    in_band = (10.0**0.05 - 10.0**-0.05) * 2.0 * STEP / 5e-4  # share of the range to 1/(2 step)
    expected = 10.0 * np.log10(in_band * 10.0**2)
    assert levels.sel(wavelength=5e-4) == pytest.approx(expected, abs=0.1)


def test_short_profile_has_no_levels():
    with pytest.raises(InputError, match=r"longer than 2\.69 mm"):
        texture_levels(wave(1e-3, length=2e-3))
    assert Measured.of([wave(1e-3, length=2e-3)]).texture_levels is None


def test_a_road_far_from_that_of_the_tyre_label_says_so():
    """0.7 +- 0.3 mm, of the estimated texture depth 1.1 MPD (ISO 23671, ISO 13473-1:2019)."""
    assert beside_label(0.6e-3) == ""
    assert beside_label(float("nan")) == ""
    assert "0.33 mm" in beside_label(0.3e-3)
    coarse = Measured.of([wave(12.5e-3, 2e-3)])
    assert any("tyre label" in note for note in texture_table(coarse.texture).notes)
