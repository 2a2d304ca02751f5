"""Stated errors of lines against grids four times finer, and of maps two to four times."""

import numpy as np
import pytest
import scipy.fft

import gripscale as gs
from gripscale.half_space.grid import Grid
from gripscale.surface import Profile
from gripscale.surface.low_pass import transmission
from tests.half_space.rough_cases import RandomCase, isotropic_map, lossy
from tests.verification.families import tread

pytestmark = pytest.mark.verification

LINES, LENGTH, STEP = 100, 0.1024, 1e-4
SHORTEST = 8 * STEP
SURFACES, RUBBERS = ("self-affine", "stones", "plateaus"), ("elastic", "tread", "lossy")
FRICTION_THAT_COUNTS = 1e-3


def random_line(seed: int) -> tuple[str, RandomCase]:
    """Return kind of rubber, and a line of rms slope 0.05 to 1 down to `SHORTEST`, H 0.5 to 1.

    Any load; every second line is eight times as long.
    """
    random = np.random.default_rng(seed)
    kind = RUBBERS[seed // 3 % 3]
    z = _heights(random, SURFACES[seed % 3], 8 if seed % 2 else 1)
    grid = Grid(z.shape, (z.size * STEP,))
    passed = scipy.fft.rfft(z) * transmission(grid.wavenumber, SHORTEST)
    slope = 10 ** random.uniform(-1.3, 0.0)
    z *= slope / np.sqrt(np.mean(grid.slope(scipy.fft.irfft(passed, z.size)) ** 2))
    rubber = {
        "elastic": gs.Rubber(10 ** random.uniform(5.5, 7.0)),
        "tread": tread(),
        "lossy": lossy(random.uniform(0.3, 1.0) * 2.0 / np.pi),
    }[kind]
    speed = 10 ** random.uniform(-2.0, 1.0)
    modulus = abs(complex(rubber.plane_strain_modulus(2.0 * np.pi * speed / 1e-3)))
    pressure = modulus * slope * 10 ** random.uniform(-2.2, 0.0)
    line = Profile(STEP * np.arange(z.size), z)
    return kind, RandomCase(seed, rubber, line, float(pressure), speed)


def _heights(random: np.random.Generator, surface: str, longer: int):
    """Return heights of unit size: self-affine, with round stones on them, or cut flat."""
    points = longer * round(LENGTH / STEP)
    length = points * STEP
    q = Grid((points,), (length,)).wavenumber
    hurst, corner = random.uniform(0.5, 1.0), 2 * np.pi / LENGTH * 10 ** random.uniform(0.3, 1.0)
    amplitude = np.where(q > 0.0, np.maximum(q, corner) ** -(hurst + 0.5), 0.0)
    z = scipy.fft.irfft(amplitude * scipy.fft.rfft(random.standard_normal(points)), points)
    z /= z.std()
    if surface == "plateaus":
        return np.minimum(z, random.uniform(-0.5, 0.8))
    if surface == "stones":
        number = longer * int(random.integers(5, 15))
        middle = random.uniform(0.0, length, number)
        radius = length / number * random.uniform(0.5, 1.2, number)
        x = STEP * np.arange(points)
        apart = np.abs((x[:, None] - middle + length / 2) % length - length / 2)
        tops = np.sqrt(np.maximum(radius**2 - apart**2, 0.0)).max(axis=1)
        return 0.3 * z + random.uniform(1.0, 4.0) * tops / radius.mean()
    return z


def ratios(line: RandomCase, tolerance: float | None) -> tuple[float, ...] | None:
    """Return contact fraction, and off over stated: area, both frictions; None for full contact."""
    coarse = line.solve(smallest_wavelength=SHORTEST, tolerance=tolerance)
    if coarse.full_contact or coarse.status != "converged":
        return None
    points = 4 * coarse.grid.points
    fine = line.solve(
        smallest_wavelength=SHORTEST, tolerance=1e-5, start=coarse, most_points=points
    )
    area = (coarse.contact_fraction - fine.contact_fraction) / coarse.contact_fraction_error
    allowed = max(coarse.friction_error, 0.02 * FRICTION_THAT_COUNTS)
    truth = fine.friction_from_dissipation
    frictions = np.array([coarse.friction, coarse.friction_from_dissipation])
    return coarse.contact_fraction, area, *((frictions - truth) / allowed)


@pytest.mark.parametrize("tolerance", [None, 0.05])
def test_stated_errors_hold_on_lines(tolerance):
    """Loss angles to 1.0, 2 to 100 % of contact; two minutes of one core.

    Within the error, tolerance 0.05: area 95 of 100 (elastic 32 of 34, tread 33 of 33, lossy 30 of
    33), at most 2.4 times it; both frictions 100. Without a tolerance, where the frictions agree:
    79, 79 and 84 of 84. Above 0.9 of contact 10 of 11. The estimates were chosen on other seeds.
    With n = 3/2 at both ends of a contact, and without the terms of new borders and dissipation:
    area 87 of 100 (lossy 25 of 33) and 74 of 84, friction from traction 96 and 71.
    """
    lines = [random_line(seed) for seed in range(LINES)]
    rows = [(kind, ratios(line, tolerance)) for kind, line in lines]
    for kind in RUBBERS:
        off = np.array([row for name, row in rows if name == kind and row is not None])
        inside, worst = (np.abs(off[:, 1:]) <= 1.0).sum(axis=0), np.abs(off[:, 1:]).max(axis=0)
        print(tolerance, kind, len(off), "inside", inside, "worst", worst.round(2))
    off = np.array([row for _, row in rows if row is not None])
    print("area", np.quantile(off[:, 0], [0.0, 0.5, 1.0]).round(3), "above 0.9")
    print((off[:, 0] > 0.9).sum(), (np.abs(off[off[:, 0] > 0.9, 1]) <= 1.0).sum())
    assert len(off) > 0.8 * LINES
    assert np.all(np.mean(np.abs(off[:, 1:]) <= 1.0, axis=0) >= 0.9)
    assert np.abs(off[:, 1:]).max() <= 2.5


MAPS, SHORTEST_OF_MAPS = 24, 3.2e-3


def test_stated_errors_hold_on_maps_of_lossy_rubber():
    """Loss angles 0.43 to 0.87, 6 to 70 % of contact; 20 s of one core.

    Area and friction are within their errors on all 24 maps, nearest 0.77 and 0.47 of them.
    """
    area, friction = [], []
    for seed in range(MAPS):
        random = np.random.default_rng(seed)
        rubber = lossy(random.uniform(0.25, 0.62))
        surface = isotropic_map(64, seed=seed, shortest=SHORTEST_OF_MAPS)
        speed = 10 ** random.uniform(-2.0, 1.0)
        modulus = abs(complex(rubber.plane_strain_modulus(2.0 * np.pi * speed / 5e-3)))
        pressure = 0.15 * modulus * 10 ** random.uniform(-1.5, -0.3)
        coarse, fine = (
            gs.solve_rough_contact(
                rubber,
                surface,
                pressure=pressure,
                speed=speed,
                periodic=True,
                smallest_wavelength=SHORTEST_OF_MAPS,
                tolerance=tolerance,
            )
            for tolerance in (0.05, 0.008)
        )
        apart = coarse.contact_fraction - fine.contact_fraction
        area.append(abs(apart) / coarse.contact_fraction_error)
        apart = coarse.friction_from_dissipation - fine.friction_from_dissipation
        friction.append(abs(apart) / coarse.friction_error)
    print("area", np.round(area, 2), "friction", np.round(friction, 2))
    for ratios in (area, friction):
        assert np.mean(np.array(ratios) > 1.0) <= 0.1
        assert max(ratios) <= 1.4
