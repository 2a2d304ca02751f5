"""Surfaces, rubbers and grids the tests of the direct contact share."""

from dataclasses import dataclass

import numpy as np
import scipy.fft

import gripscale as gs
from gripscale.half_space.grid import Grid, periodic_heights
from gripscale.half_space.grid_sequence import GridSequence, Level, finer, levels
from gripscale.half_space.response import HalfSpace
from gripscale.model import Load
from gripscale.surface import HeightMap, Measured, Profile, SineStack, Surface, self_affine_profile
from tests.samples import ZENER

WAVELENGTH, AMPLITUDE, RELAXED, TIME = 1e-3, 1e-5, 3e6, 1e-2
SLOPE = 2.0 * np.pi * AMPLITUDE / WAVELENGTH
TIMES = np.geomspace(1e-9, 1e1, 41)
PROFILES = [self_affine_profile(0.8, 5e-3, 5e-4, length, 1e-4, seed=4) for length in (0.1, 0.2)]
SURFACE = Surface(
    SineStack([1e-2, 1e-3], [1e-3, 1e-4]),
    "made",
    measured=Measured([(profile, profile) for profile in PROFILES], [], None, ""),
)
LOAD = Load(pressure=1e5, speed=0.3, footprint=0.1)


def lossy(exponent: float) -> gs.Rubber:
    """A rubber with E* nearly as (i w)^exponent: its loss angle is exponent pi/2 everywhere."""
    return gs.Rubber(1e5, 2e5 * (TIMES / 1e-3) ** -exponent, TIMES, bulk_modulus=1e13)


def sine(points: int = 256) -> Profile:
    x = np.arange(points) * WAVELENGTH / points
    return Profile(x, AMPLITUDE * np.cos(2 * np.pi * x / WAVELENGTH))


def two_waves(step: float) -> Profile:
    """1024 points of a period with three waves, and seventeen on them."""
    turns = 2.0 * np.pi * np.arange(1024) / 1024
    z = 2e-4 * np.cos(3 * turns) + 3e-5 * np.cos(17 * turns + 1.0)
    return Profile(step * np.arange(1024), z)


def many_waves(points: int, count: int, height: float, seed: int) -> Profile:
    """A period of 0.1 m with waves as high as they are long, at random phases."""
    x = 0.1 * np.arange(points) / points
    phases = enumerate(np.random.default_rng(seed).random(count), start=1)
    z = sum(height / k * np.cos(2.0 * np.pi * (k * x / 0.1 + phase)) for k, phase in phases)
    return Profile(x, np.asarray(z))


def grooves(along: str, points: int = 256) -> HeightMap:
    """A map of one sine, along the way of sliding ("x") or across it ("y")."""
    line = sine(points)
    z = np.tile(line.z[:, None], (1, points))
    return HeightMap(line.x, line.x, z if along == "x" else z.T)


def isotropic_heights(points=128, length=0.0256, rms=3e-4, shortest=8e-4, seed=3):
    """Gaussian heights [m]: flat spectrum for waves above half the length, H = 0.8 below."""
    q1 = 2 * np.pi * np.fft.fftfreq(points, length / points)
    q = np.hypot(q1[:, None], q1[None, :])
    amplitude = np.where(
        (q > 0) & (q <= 2 * np.pi / shortest), np.maximum(q, 4 * np.pi / length) ** -1.8, 0
    )
    noise = np.random.default_rng(seed).standard_normal((points, points))
    z = np.fft.ifft2(amplitude * np.fft.fft2(noise)).real
    return z * (rms / z.std())


def isotropic_map(points=128, length=0.0256, **more) -> HeightMap:
    x = np.arange(points) * length / points
    return HeightMap(x, x, isotropic_heights(points, length, **more))


def solve(surface, **arguments):
    """Solve `surface` as one period, with a nominal pressure of 3 bar unless said otherwise."""
    arguments = {"pressure": 3e5, "speed": 0.3, "periodic": True} | arguments
    return gs.solve_rough_contact(arguments.pop("rubber", ZENER), surface, **arguments)


def on_grid(rubber, surface, *, pressure, speed, shape, shortest):
    """Solve on one grid alone, from nothing; `speed` may be negative."""
    heights = periodic_heights(surface, smallest_wavelength=shortest, periodic=True)
    climb = GridSequence(HalfSpace(rubber, speed), heights, pressure, 1)
    return climb.solve(Level(Grid(shape, heights.grid.lengths), heights.smallest_wavelength))


@dataclass(frozen=True)
class RandomCase:
    """A random rubber on a random surface, taken as one period with all its waves or a cut-off."""

    seed: int
    rubber: gs.Rubber
    surface: Profile | HeightMap
    pressure: float
    speed: float

    def solve(self, **more):
        return gs.solve_rough_contact(
            self.rubber,
            self.surface,
            pressure=self.pressure,
            speed=self.speed,
            periodic=True,
            workers=1,
            **more,
        )

    def finer_than(self, contact, halvings: int):
        """Return the numbers of a grid with a spacing halved so often."""
        heights = periodic_heights(self.surface, smallest_wavelength=None, periodic=True)
        climb = GridSequence(HalfSpace(self.rubber, self.speed), heights, self.pressure, 1)
        points = contact.grid.points * 2 ** (halvings * len(contact.grid.shape))
        for level in levels(heights):
            found = climb.solve(level)
        while level.grid.points < points:
            level = finer(level)
            found = climb.solve(level)
        return found.record


def random_case(seed: int, points_of_line=4096, points_of_map=64) -> RandomCase:
    """Return 1 to 24 Maxwell terms on a line or map, some flat-topped, at 1e-5 to 100 m/s."""
    random = np.random.default_rng(seed)
    terms = int(random.integers(1, 25))
    relaxed = 10 ** random.uniform(5, 7)
    times = 10 ** random.uniform(-8, 2, terms)
    moduli = relaxed * 10 ** random.uniform(-2, 3, terms)
    rubber = gs.Rubber(relaxed, moduli, times, bulk_modulus=max(2e9, 2 * (relaxed + moduli.sum())))
    shape = (points_of_line,) if random.random() < 0.5 else (points_of_map, points_of_map)
    grid = Grid(shape, (0.05,) * len(shape))
    hurst, corner = random.uniform(0.3, 1.0), 2 * np.pi / 0.05 * 10 ** random.uniform(0, 1)
    shortest = 4 * 0.05 / shape[0]
    q = grid.wavenumber
    amplitude = np.where(
        (q > 0) & (q <= 2 * np.pi / shortest),
        np.maximum(q, corner) ** -(hurst + 0.5 * len(shape)),
        0.0,
    )
    noise = scipy.fft.rfftn(random.standard_normal(shape))
    z = scipy.fft.irfftn(amplitude * noise, s=shape)
    if random.random() < 0.3:
        z = np.minimum(z, z.std() * random.uniform(-0.5, 1.0))
    slope = 10 ** random.uniform(-2, 0.3)
    z *= slope / np.sqrt(np.mean(grid.slope(z) ** 2))
    speed = 0.0 if random.random() < 0.1 else 10 ** random.uniform(-5, 2)
    modulus = abs(rubber.plane_strain_modulus(speed * 2 * np.pi / 1e-3))
    pressure = float(modulus * slope * 10 ** random.uniform(-3, 0.3))
    x = np.arange(shape[0]) * 0.05 / shape[0]
    surface = Profile(x, z) if len(shape) == 1 else HeightMap(x, x, z)
    return RandomCase(seed, rubber, surface, pressure, speed)
