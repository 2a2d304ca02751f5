"""Lines of which octaves are withheld and continued: measured lines and synthetic ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.fft

import gripscale as gs
from gripscale.continuation import contact_by_cut_off
from gripscale.half_space.grid import resampled
from gripscale.surface import self_affine_profile
from tests.samples import ROOT
from tests.verification.families import tread

LENGTH, STEP, PRESSURE, SPEED = 1.6384, 37.5e-6, 3e5, 0.3


@dataclass(frozen=True)
class Line:
    """A line with the speed it is slid at [m/s]."""

    name: str
    profile: gs.Profile
    speed: float = SPEED


@dataclass(frozen=True)
class Withheld:
    """What a continuation says of octaves that were measured."""

    line: str
    octaves: int
    contact_fraction: float
    """Found over true."""
    friction: float
    band: float
    """Relative half width of the band."""

    def holds(self, name: str) -> bool:
        """Return whether the truth lies in the band."""
        return bool(abs(np.log(getattr(self, name))) <= np.arcsinh(self.band))


def measured_lines() -> list[Line]:
    """Return the two stations of the shipped road, and a machined surface of another instrument."""
    folder = ROOT / "examples" / "data" / "road"
    lines = [
        Line(f"road, station {s}", _clean(folder / f"20211011_aylesbury_dec_station_{s}.dat"))
        for s in (0, 1)
    ]
    machined = gs.read_profile(ROOT / "examples" / "data" / "surfaces" / "mitutoyo_2_mock.xlsx")
    return [*lines, Line("machined", gs.clean(machined)[0], speed=0.01)]


def _clean(path: object) -> gs.Profile:
    return gs.clean(gs.read_profile(path), crop=(0.12, 1.78))[0]


def synthetic_lines() -> list[Line]:
    """Return lines of three kinds with other seeds than those the method was chosen on."""
    gaussian = [
        Line(f"Gaussian, H = {h}", self_affine_profile(h, 2e-3, 0.6e-3, LENGTH, STEP, seed))
        for h, seed in ((0.6, 5), (0.8, 3), (0.9, 6))
    ]
    caps = [Line("stones", stones(seed)) for seed in (11, 12, 13)]
    gusts = [
        Line(f"intermittent, {v}", intermittent(s, v))
        for s, v in ((11, 0.03), (12, 0.05), (13, 0.08))
    ]
    return [*gaussian, *caps, *gusts]


def stones(seed: int) -> gs.Profile:
    """Return overlapping tilted caps with a fine Gaussian texture: smooth faces and sharp edges."""
    random = np.random.default_rng(seed)
    points = int(LENGTH / STEP)
    x, z = STEP * np.arange(points), np.full(points, -3e-3)
    for centre in random.uniform(0.0, LENGTH, int(LENGTH / 6e-3)):
        radius, tilt = random.uniform(3e-3, 8e-3), random.normal(0.0, 0.25)
        u = (x - centre + 0.5 * LENGTH) % LENGTH - 0.5 * LENGTH
        on = np.abs(u) < radius
        top = random.normal(0.0, 0.7e-3) + 0.6 * (np.sqrt(radius**2 - u[on] ** 2) - radius)
        z[on] = np.maximum(z[on], top + tilt * u[on])
    texture = _octave(random, points, 3e-3, 2.0 * STEP, 0.75)
    return gs.Profile(x, z + 0.03e-3 * texture / texture.std())


def intermittent(seed: int, variance: float) -> gs.Profile:
    """Return a lognormal cascade: the amplitude of an octave is that above times a random one.

    `variance` is that of the logarithm of each factor; H = 0.8.
    """
    random = np.random.default_rng(seed)
    points, longest = int(LENGTH / STEP), 20e-3
    q = 2.0 * np.pi * scipy.fft.rfftfreq(points, STEP)
    z, log, octave = np.zeros(points), np.zeros(points), 0
    while longest / 2**octave > 2.0 * STEP:
        wave = longest / 2**octave
        noise = scipy.fft.rfft(random.standard_normal(points)) * np.exp(
            -0.5 * (0.25 * q * wave) ** 2
        )
        smooth = scipy.fft.irfft(noise, points)
        log += np.sqrt(variance) * smooth / smooth.std()
        waves = _octave(random, points, wave, 0.5 * wave, 0.0)
        z += 2.0 ** (-0.8 * octave) * np.exp(log) * waves / waves.std()
        octave += 1
    return gs.Profile(STEP * np.arange(points), 0.9e-3 * z / z.std())


def _octave(
    random: np.random.Generator, points: int, longest: float, shortest: float, hurst: float
) -> np.ndarray:
    """Return Gaussian waves between two wavelengths [m] of a self-affine line, of any scale."""
    q = 2.0 * np.pi * scipy.fft.rfftfreq(points, STEP)
    waves = scipy.fft.rfft(random.standard_normal(points))
    between = (q > 2.0 * np.pi / longest) & (q <= 2.0 * np.pi / shortest)
    slope = np.where(between, np.maximum(q, q[1]) ** (-0.5 - hurst), 0.0)
    return np.asarray(scipy.fft.irfft(waves * slope, points))


def coarser(line: gs.Profile, octaves: int) -> gs.Profile:
    """Return a line sampled with fewer points, without the waves they do not resolve."""
    points = line.x.size >> octaves
    z = np.interp(line.x, line.x[~np.isnan(line.z)], line.z[~np.isnan(line.z)])
    z = z - np.linspace(z[0], z[-1], z.size)
    waves = scipy.fft.rfft(z)
    length = line.step * line.x.size
    q = scipy.fft.rfftfreq(z.size, line.step)
    kept = np.where(q <= 1.0 / (line.resolution_limit * 2**octaves), waves, 0.0)
    return gs.Profile(length / points * np.arange(points), resampled(kept, z.shape, (points,)))


def judged(lines: list[Line], octaves: tuple[int, ...] = (1, 2, 3)) -> Iterator[Withheld]:
    """Yield contact and friction of lines whose last octaves were withheld, over the true ones."""
    for line in lines:
        load = {"pressure": PRESSURE, "speed": line.speed}
        limit = coarser(line.profile, 0).resolution_limit
        true = contact_by_cut_off(tread(), coarser(line.profile, 0), down_to=limit, **load)
        for count in octaves:
            found = contact_by_cut_off(tread(), coarser(line.profile, count), down_to=limit, **load)
            ratios = [
                float(found.values(name)[-1] / true.values(name)[-1])
                for name in ("contact_fraction", "friction_from_dissipation")
            ]
            yield Withheld(line.name, count, *ratios, float(found.band[-1]))
