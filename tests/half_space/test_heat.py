"""Heat of a direct contact: its sum is the friction work, and its patterns lie where it is lost."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import LossDepth, harmonic_at_surface, harmonic_decay
from gripscale.half_space.conditions import (
    OctaveHeat,
    grid_temperature,
    octave_heats,
    strain_by_scale,
)
from gripscale.half_space.grid import Grid
from tests.half_space.heat_patterns import density_of, pattern_of
from tests.samples import THERMAL

SINGLE = 1e-6  # what rounding in single precision leaves of a field
RUBBER = gs.Rubber(5e6, np.geomspace(3e6, 3e8, 8), np.geomspace(1e-1, 1e-8, 8))


def _line():
    rng = np.random.default_rng(3)
    x = np.arange(512) * 1e-4
    number = np.arange(1, 40)
    phase = rng.uniform(0.0, 2.0 * np.pi, number.size)
    turns = 2.0 * np.pi * np.outer(x / (512 * 1e-4), number)
    return gs.Profile(x, 3e-4 * (np.cos(turns + phase) @ number**-1.3))


def _map():
    rng = np.random.default_rng(4)
    spectrum = np.fft.rfft2(rng.standard_normal((48, 64)))
    q = np.hypot(np.fft.fftfreq(48)[:, None] * 48, np.fft.rfftfreq(64) * 64)
    spectrum *= np.where((q > 0) & (q < 12), np.maximum(q, 1.0) ** -2.0, 0.0)
    z = np.fft.irfft2(spectrum, (48, 64))
    steps = np.arange(48) * 2e-4, np.arange(64) * 2e-4
    return gs.HeightMap(*steps, 2e-4 * z / z.std())


@pytest.mark.parametrize("surface", [_line(), _map()], ids=["line", "map"])
def test_the_heat_of_all_octaves_is_the_friction_work(surface):
    contact = gs.solve_rough_contact(
        RUBBER, surface, pressure=2e5, speed=0.3, periodic=True, tolerance=None
    )
    lost = contact.lost_by_harmonic()
    heats = octave_heats(contact.grid, contact.pressure, lost)
    total = sum(heat.friction for heat in heats)
    assert total == pytest.approx(contact.friction_from_dissipation, rel=1e-10)
    for heat in heats:
        density = density_of(contact.grid, heat)
        assert density.min() >= -1e-12 * density.max()
        assert density.mean() == pytest.approx(1.0, rel=1e-12)


def test_the_pattern_of_one_sine_in_full_contact_is_uniform():
    """(the shear under a moving sine has the same amplitude everywhere along it)"""
    x = np.arange(128) * 1e-5
    wave = gs.Profile(x, 1e-6 * np.cos(2.0 * np.pi * x / 128e-5))
    contact = gs.solve_rough_contact(RUBBER, wave, pressure=1e7, speed=0.3, periodic=True)
    assert contact.full_contact
    (heat,) = octave_heats(contact.grid, contact.pressure, contact.lost_by_harmonic())
    assert density_of(contact.grid, heat) == pytest.approx(1.0, rel=1e-6)
    assert heat.depth.mean == pytest.approx(1.5 / (2.0 * np.pi / 128e-5), rel=1e-6)


@pytest.mark.parametrize("shape", [(64,), (24, 32)], ids=["line", "map"])
def test_the_pattern_follows_the_pressure_on_lines_and_maps(shape):
    """A pressure in one place along x loses its energy there."""
    grid = Grid(shape, tuple(1e-5 * n for n in shape))
    x = np.arange(shape[0]) / shape[0]
    bump = np.exp(-(((x - 0.3) / 0.06) ** 2))
    pressure = bump if len(shape) == 1 else np.repeat(bump[:, None], shape[1], axis=1)
    spectrum = np.fft.rfftn(pressure)
    lost = np.abs(spectrum) ** 2 * (np.abs(grid.along) > 0.0) * np.ones(grid.spectrum_shape)
    heats = octave_heats(grid, pressure, lost / lost.sum())
    assert np.ptp(density_of(grid, heats[0])) < 1e-9  # of one harmonic
    densities = [density_of(grid, heat) for heat in heats[1:]]
    for density in [each for each in densities if np.ptp(each) > 1e-9][:2]:  # of several harmonics
        along = density if len(shape) == 1 else density.mean(axis=1)
        assert x[along.argmax()] == pytest.approx(0.3, abs=1.5 / shape[0] + 0.02)
        if len(shape) == 2:
            assert np.ptp(density, axis=1).max() < 1e-9 * density.max()


def test_the_temperature_of_one_harmonic_of_heat_is_the_closed_form():
    grid = Grid((256,), (256e-5,))
    k = 2.0 * np.pi * 8 / 256e-5
    x = np.arange(256) * 1e-5
    heats = octave_heats(grid, np.cos(k * x), np.eye(129)[8] * 0.2)
    density = 1.0 + 0.5 * np.cos(2.0 * np.pi * 4 / 256e-5 * x)
    heats[0] = OctaveHeat(k, 0.2, pattern_of(density), LossDepth.under(k))
    found = grid_temperature(grid, heats, flux=1e5, speed=0.05, time=10.0, thermal=THERMAL)
    own = 2.0 * np.pi * 4 / 256e-5
    m = harmonic_decay(own, own, 0.05, THERMAL)
    wave = 1e5 * 0.2 * 0.5 * harmonic_at_surface(m, LossDepth.under(k), THERMAL)
    exact = (wave * np.exp(1j * own * x)).real
    pattern = found.surface - found.surface.mean()
    assert pattern == pytest.approx(exact, abs=SINGLE * np.abs(exact).max())


def test_the_strain_of_a_scale_is_that_of_the_wave_at_its_depth():
    """u cos(k x) strains an incompressible half-space by k^2 y exp(-k y) u along and in shear."""
    number, u = 2.0 * np.pi * 4 / 512e-5, 1e-5
    depth = 1.0 / np.array([0.5 * number, number, 4.0 * number])
    amplitude = number**2 * depth * np.exp(-number * depth) * u
    expected = 0.85 * np.sqrt(4.0 / 3.0) * amplitude
    x = np.arange(512) * 1e-5
    line, waves = Grid((512,), (512e-5,)), u * np.cos(number * x)
    for active in (np.ones(512, dtype=bool), waves > 0.5 * u):
        found = strain_by_scale(line, waves, active, 1.0 / depth)
        assert found == pytest.approx(expected, rel=SINGLE)
    # the same wavenumber across a map: 5 waves, of which 3 along x and 4 along y
    five = 2.0 * np.pi / 512e-5 * np.arange(64) * 8e-5
    grid, oblique = Grid((64, 64), (512e-5,) * 2), u * np.cos(3.0 * five[:, None] + 4.0 * five)
    scale = 5.0 / 4.0 / depth
    found = strain_by_scale(grid, oblique, oblique > 0.5 * u, scale)
    assert found == pytest.approx(5.0 / 4.0 * expected, rel=SINGLE)


def test_grooves_along_the_way_of_sliding_warm_only_as_long_as_the_contact_lasts():
    """Heat in stripes that nothing passes is conducted for the time of the contact, no longer."""
    grid = Grid((8, 256), (8e-4, 256e-4))
    stripes = np.cos(2.0 * np.pi * np.arange(256) / 256.0)
    density = np.tile(1.0 + stripes, (8, 1))
    heat = [OctaveHeat(1e3, 0.2, pattern_of(density), LossDepth(0.0))]
    options = {"flux": 1e5, "speed": 1.0, "thermal": THERMAL}
    found = grid_temperature(grid, heat, time=0.1, **options).surface
    middle = found.mean()
    assert found.min() > -1e-9 * middle  # the coldest stripe has no heat at all
    assert found.max() == pytest.approx(2.0 * middle, rel=1e-3)  # nothing spreads over 26 mm
    twice = grid_temperature(grid, heat, time=0.2, **options).surface
    assert twice.max() == pytest.approx(np.sqrt(2.0) * found.max(), rel=1e-3)
