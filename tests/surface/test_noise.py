"""White noise of the sensor: estimated, and stated where it changes the contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core import Severity
from gripscale.surface import HeightMap, Profile
from gripscale.surface.plausibility import noise_finding, sensor_noise
from studies.shipped import road
from tests.samples import ROOT

STEP, POINTS = 1e-4, 2**14
SURFACES = ROOT / "examples" / "data" / "surfaces"


def rough(shape: tuple[int, ...], seed: int = 0) -> np.ndarray:
    """Return heights of rms 0.2 mm, H = 0.8 along x, from 12.8 mm down to two steps."""
    q = np.fft.rfftfreq(shape[-1], STEP)
    size = np.where(q > 1.0 / 12.8e-3, np.maximum(q, 1.0) ** -1.3, 0.0)
    waves = np.fft.rfft(np.random.default_rng(seed).standard_normal(shape)) * size
    z = np.fft.irfft(waves, shape[-1])
    return 2e-4 * z / z.std()


def with_noise(line: Profile, rms: float, seed: int = 1) -> Profile:
    return replace(line, z=line.z + rms * np.random.default_rng(seed).standard_normal(len(line)))


@pytest.mark.parametrize("rms", [5e-5, 2e-4])
def test_the_noise_of_a_rough_line_is_found(rms: float) -> None:
    """1600 heights in the smoothest stretches tell a variance to 6 %; the choice takes 10 %."""
    line = Profile(STEP * np.arange(POINTS), rough((POINTS,)))
    assert sensor_noise([with_noise(line, rms)])[0] == pytest.approx(rms, rel=0.2)


@pytest.mark.parametrize("seed", range(4))
def test_roughness_is_no_noise(seed: int) -> None:
    line = Profile(STEP * np.arange(POINTS), rough((POINTS,), seed))
    assert noise_finding([line], 2.0 * STEP) is None
    with_jumps = line.z + 1e-3 * (np.arange(POINTS) % 700 < 300)
    assert noise_finding([replace(line, z=with_jumps)], 2.0 * STEP) is None


def test_measured_roads_and_surfaces_as_they_are_have_none() -> None:
    assert noise_finding([road(0), road(1)], 1e-4) is None
    assert noise_finding([gs.read_profile(SURFACES / "mitutoyo_2_mock.xlsx")], 1e-5) is None


def test_dropouts_add_none() -> None:
    """A tenth of the heights is missing, and the noise of the rest is the same."""
    line = with_noise(Profile(STEP * np.arange(POINTS), rough((POINTS,))), 1e-4)
    gaps = np.random.default_rng(5).random(POINTS // 16) < 0.1
    z = np.where(np.repeat(gaps, 16), np.nan, line.z)
    assert sensor_noise([replace(line, z=z)])[0] == pytest.approx(1e-4, rel=0.2)


def test_noise_of_a_map() -> None:
    x, y = STEP * np.arange(1024), STEP * np.arange(64)
    z = rough((64, 1024)).T
    noise = 1e-4 * np.random.default_rng(2).standard_normal(z.shape)
    assert sensor_noise(HeightMap(x, y, z + noise).lines())[0] == pytest.approx(1e-4, rel=0.2)
    assert noise_finding(HeightMap(x, y, z).lines(), 2.0 * STEP, STEP) is None


def test_short_lines_tell_nothing() -> None:
    line = Profile(STEP * np.arange(200), 1e-4 * np.random.default_rng(0).standard_normal(200))
    assert sensor_noise([line])[0] == 0.0


@pytest.mark.parametrize(("rms", "stated", "cut_off"), [(1e-5, "8.5", "0.16"), (2e-5, "19", "0.3")])
def test_a_case_doubts_noisy_heights(rms: float, stated: str, cut_off: str) -> None:
    """Noise on the shipped road: named with its number, its effect and a cut-off without it."""
    lines = [with_noise(road(station), rms, station) for station in (0, 1)]
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": 1e-4}
    rubber = gs.Rubber(3e6, [2e7], [1e-3], bulk_modulus=2e9)
    noisy, clean = (
        gs.Case(profiles, rubber, cleaning={}, **load) for profiles in (lines, [road(0), road(1)])
    )
    (doubt,) = (f for f in noisy.surface.doubts if "noise" in str(f))
    assert not any("noise" in str(f) for f in clean.surface.findings)
    assert doubt.severity == Severity.DOUBT
    assert sensor_noise(noisy.surface.measured.cleaned)[0] == pytest.approx(rms, rel=0.15)
    assert f"white noise of {stated} µm" in str(doubt)
    assert f"With a cut-off of {cut_off}" in str(doubt)
