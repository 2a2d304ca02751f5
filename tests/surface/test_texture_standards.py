"""Texture levels, g-factor, lengths and direction of a texture: closed forms and surfalize."""

from __future__ import annotations

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.questions.inputs.page import texture_table
from gripscale.surface import HeightMap, Measured, Profile, texture, texture_levels
from gripscale.surface.texture import beside_label

from .surface_cases import DATA

STEP = 0.05e-3
CORRELATION = 6e-4
"""Length of the Gaussian autocorrelation across the ridges [m]."""


def ridges(degrees: float, ratio: float = 3.0, points: int = 256, step: float = 1e-4) -> HeightMap:
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
def test_lengths_of_a_texture_are_those_of_surfalize(degrees, length, aspect) -> None:
    """surfalize 0.19.2 (MIT) of the same levelled heights: cubic between points, ours linear.

    The step is a sixth of the length: (step/length)^2/8 of a Gaussian, 0.3 %, at the short one.
    """
    numbers = texture(ridges(degrees))
    assert numbers.autocorrelation_length == pytest.approx(length, rel=8e-3)
    assert numbers.texture_aspect_ratio == pytest.approx(aspect, rel=8e-3)


def test_length_of_a_measured_map_is_that_of_surfalize() -> None:
    """Its longest way bends round a corner, which the straight ways of the standard do not."""
    numbers = texture(gs.read_map(DATA / "surfaces" / "al3d-1.al3d"))
    assert numbers.autocorrelation_length == pytest.approx(12.394401e-6, rel=8e-3)


def test_length_of_a_gaussian_autocorrelation() -> None:
    """exp(-(t/l)^2) falls to 0.2 at l sqrt(ln 5); 256 points hold 40 lengths: 5 % of scatter."""
    length = texture(ridges(0.0, ratio=1.0)).autocorrelation_length
    assert length == pytest.approx(CORRELATION * np.sqrt(np.log(5.0)), rel=0.07)


@pytest.mark.parametrize("degrees", [20.0, 45.0, 110.0, 179.0])
def test_direction_of_ridges(degrees: float) -> None:
    """The spectrum of 8:1 is as wide as atan(1/8), 7 degrees; few waves make most of it."""
    found = np.degrees(texture(ridges(degrees, ratio=8.0)).texture_direction)
    assert (found - degrees + 90.0) % 180.0 - 90.0 == pytest.approx(0.0, abs=7.0)


def test_flat_map_has_no_length() -> None:
    x = np.arange(32) * 1e-4
    numbers = texture(HeightMap(x, x, np.zeros((32, 32))))
    for name in ("autocorrelation_length", "texture_aspect_ratio", "texture_direction"):
        assert np.isnan(numbers[name]), name


def cusps(sign: float) -> Profile:
    """Return parabolas that meet in cusps, upwards or downwards, 25 mm long."""
    x = np.arange(10_000) * STEP
    u = np.abs((x / 25e-3) % 1.0 - 0.5) / 0.5
    return Profile(x, sign * 1e-3 * u**2)


@pytest.mark.parametrize(("sign", "share"), [(1.0, 1.0 - 0.5**0.5), (-1.0, 0.5**0.5)])
def test_g_factor_of_cusps(sign: float, share: float) -> None:
    """u^2 > 1/2 for u > sqrt(1/2): single peaks below a half, plateaus above it.

    Averages over 0.5 mm lower the cusps by 4 %: 0.015 of the share. Eight crossings of the middle
    lie within a sample, 0.5 % of the segment. The share above the mean would be 0.42.
    """
    assert texture(cusps(sign)).g_factor == pytest.approx(share, abs=0.03)


def wave(wavelength: float, amplitude: float = 1e-4, length: float = 1.0) -> Profile:
    x = np.arange(round(length / STEP)) * STEP
    return Profile(x, amplitude * np.cos(2.0 * np.pi * x / wavelength))


@pytest.mark.parametrize("wavelength", [1e-3, 5e-3, 12.5e-3, 50e-3])
def test_level_of_a_wave(wavelength: float) -> None:
    """10 log10(A^2/2) re 1 um = 37.0 dB in its own band, from the definition.

    The window spreads it over three of 20 bands' points at 50 mm: within 0.05 dB.
    """
    levels = texture_levels(wave(wavelength)).level
    assert levels.sel(wavelength=wavelength) == pytest.approx(
        10.0 * np.log10(0.5 * 100.0**2), abs=0.05
    )
    others = levels.where(np.abs(np.log10(levels.wavelength / wavelength)) > 0.15, drop=True)
    assert (others < 0.0).all()


def test_levels_go_to_a_twelfth_of_the_length_and_four_steps() -> None:
    lengths = texture_levels(wave(5e-3, length=0.61)).wavelength.values
    assert lengths[0] == pytest.approx(50e-3)
    assert lengths[-1] == pytest.approx(0.25e-3)
    assert (np.diff(lengths) < 0.0).all()


def test_levels_of_white_noise_rise_by_the_bandwidth() -> None:
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


def test_short_profile_has_no_levels() -> None:
    with pytest.raises(InputError, match=r"longer than 2\.69 mm"):
        texture_levels(wave(1e-3, length=2e-3))
    assert Measured.of([wave(1e-3, length=2e-3)]).texture_levels is None


def test_a_road_far_from_that_of_the_tyre_label_says_so() -> None:
    """0.7 +- 0.3 mm, of the estimated texture depth 1.1 MPD (ISO 23671, ISO 13473-1:2019)."""
    assert beside_label(0.6e-3) == ""
    assert beside_label(float("nan")) == ""
    assert "0.33 mm" in beside_label(0.3e-3)
    coarse = Measured.of([wave(12.5e-3, 2e-3)])
    assert any("tyre label" in note for note in texture_table(coarse.texture).notes)
