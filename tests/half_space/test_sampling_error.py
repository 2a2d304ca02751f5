"""Standard errors from pieces of one contact against the scatter from road to road."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.half_space.sampling_error import FEWEST_PIECES, sampling_error

RUBBER = gs.Rubber(3e6, [2e7], [1e-3], bulk_modulus=2e9)
WAVE, WAVES, POINTS = 8e-3, 32, 2048


def road(seed):
    """Return a periodic Gaussian line of 32 largest waves, self-affine down to 0.5 mm."""
    length = WAVES * WAVE
    k = np.fft.rfftfreq(POINTS, length / POINTS)
    inside = (k >= 0.999 / WAVE) & (k <= 1.0 / 5e-4)
    size = np.where(inside, np.maximum(k, 1.0) ** -1.3, 0.0)
    noise = np.fft.rfft(np.random.default_rng(seed).standard_normal(POINTS))
    z = np.fft.irfft(noise * size, POINTS)
    return gs.Profile(length / POINTS * np.arange(POINTS), 3e-4 * z / z.std())


def solved(surface, shortest=5e-4, **options):
    load = {"pressure": 2e5, "speed": 0.3, "periodic": True, "tolerance": None} | options
    return gs.solve_rough_contact(RUBBER, surface, smallest_wavelength=shortest, **load)


def contact(seed, speed=0.3):
    found = solved(road(seed), speed=speed, tolerance=0.05)
    assert found.converged
    return found


def test_it_is_the_scatter_from_road_to_road():
    roads = [contact(seed) for seed in range(40)]
    stated = [sampling_error(each, 2.0 * WAVE) for each in roads]
    for name, measure in (
        ("contact_fraction", "contact_fraction"),
        ("friction", "friction_from_dissipation"),
    ):
        values = np.array([getattr(each, measure) for each in roads])
        scatter = values.std(ddof=1) / values.mean()
        error = math.sqrt(np.mean([getattr(one, name) ** 2 for one in stated]))
        # The scatter of forty is known to 11 %. By sixty roads of 32 and of 128 waves the stated
        # error of the area is 0.77 and 0.85 of the scatter, that of friction 1.10 and 1.15.
        assert error == pytest.approx(scatter, rel=0.45)


def test_the_pieces_share_the_friction_that_is_lost():
    """A road of equal pieces has no error, however the pieces are placed."""
    line = road(0)
    x = line.step * np.arange(4 * POINTS)
    repeated = gs.Profile(x, np.tile(line.z, 4))
    error = sampling_error(solved(repeated), WAVES * WAVE)
    assert error.pieces == pytest.approx(4.0, abs=1e-3)
    assert error.contact_fraction < 1e-3
    assert error.friction < 1e-3


def test_few_pieces_tell_nothing():
    found = contact(0)
    few = sampling_error(found, WAVES * WAVE / (FEWEST_PIECES - 1))
    assert few.pieces <= FEWEST_PIECES - 1
    assert math.isnan(few.contact_fraction)
    assert math.isnan(few.friction)
    assert math.isnan(sampling_error(contact(0, speed=0.0), WAVE).friction)
    with pytest.raises(InputError, match="piece must be greater than zero"):
        sampling_error(found, 0.0)


def white_map(seed):
    """Return the contact of a map with independent summits and a quarter of contact."""
    x = 5e-4 * np.arange(64)
    z = np.random.default_rng(seed).standard_normal((64, 64))
    return solved(gs.HeightMap(x, x, 1e-4 * z), 2e-3)


def test_the_error_of_a_map_is_the_scatter_from_map_to_map():
    """Twenty maps tell their scatter to 16 %; the errors are 0.97 and 1.07 of it."""
    maps = [white_map(seed) for seed in range(20)]
    stated = [sampling_error(each, 16e-3) for each in maps]
    for name in ("contact_fraction", "friction_from_dissipation"):
        values = np.log([getattr(each, name) for each in maps])
        errors = [getattr(one, name.removesuffix("_from_dissipation")) for one in stated]
        assert math.sqrt(np.mean(np.square(errors))) == pytest.approx(values.std(ddof=1), rel=0.35)


def test_degrees_of_freedom_of_a_map_are_its_cosines():
    """Quarter of a circle of radius 4 in orders of both sides, for an even load: 16 of them.

    Load on a sixteenth of the map moves them together; a map as short as its wave has two.
    """
    assert 8.0 < sampling_error(white_map(3), 16e-3).pieces - 1.0 <= 16.0
    assert 1.0 <= sampling_error(white_map(3), 64e-3).pieces - 1.0 <= 3.0
    x = 5e-4 * np.arange(64)
    z = 1e-5 * np.random.default_rng(3).standard_normal((64, 64))
    z[16:, :] -= 5e-3
    z[:, 16:] -= 5e-3
    found = solved(gs.HeightMap(x, x, z), 2e-3, pressure=2e4)
    assert sampling_error(found, 16e-3).pieces - 1.0 < 8.0


def test_pieces_without_load_do_not_count():
    """Half of a road lies too deep to be touched: its pieces tell nothing of the scatter."""
    line = road(0)
    deep = np.where(np.arange(POINTS) < POINTS // 2, line.z, line.z - 5e-3)
    whole, half = (solved(gs.Profile(line.x, z)) for z in (line.z, deep))
    carrying = sampling_error(half, 2.0 * WAVE).pieces
    assert carrying < 0.6 * sampling_error(whole, 2.0 * WAVE).pieces
    assert carrying <= WAVES // 4 + 1  # the deep half begins within a piece
