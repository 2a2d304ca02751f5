"""Tiles with grooves: a cut-off must not ring beside a step.

Plateaus 4 mm wide with faces of a roughness of 2 to 0.4 mm, vertical grooves 1 mm wide and 0.5 mm
deep. The truth has its edges rounded by 50 um and the roughness of its faces behind the same
Gaussian, and is solved with all its waves. A sharp cut of the spectrum gave an area of 0.14 for
0.75 and 15 times the friction at a cut-off of 0.4 mm, and less area with a finer one.
"""

import numpy as np
import pytest

import gripscale as gs
from gripscale.surface.low_pass import transmission
from tests.verification.families import tread

STEP, TILE, GROOVE, DEPTH, TILES = 1e-5, 4e-3, 1e-3, 0.5e-3, 12
POSITION = STEP * np.arange(round(TILES * (TILE + GROOVE) / STEP))
WAVENUMBER = 2.0 * np.pi * np.fft.rfftfreq(POSITION.size, STEP)
LOAD = {"pressure": 3e5, "speed": 0.3, "periodic": True}


def filtered(heights, factor):
    return np.fft.irfft(np.fft.rfft(heights) * factor, heights.size)


def faces(slope):
    """Heights of a roughness of 2 to 0.4 mm with an rms slope."""
    band = (np.pi / 1e-3 <= WAVENUMBER) & (np.pi / 0.2e-3 >= WAVENUMBER)
    power = np.where(band, np.maximum(WAVENUMBER, 1.0) ** -1.3, 0.0)
    heights = filtered(np.random.default_rng(1).standard_normal(POSITION.size), power)
    return heights * (slope / filtered(heights, 1j * WAVENUMBER).std())


def grooves(position):
    return np.where(position % (TILE + GROOVE) >= TILE, -DEPTH, 0.0)


@pytest.mark.parametrize("slope", [0.0, 0.1, 0.2, 0.4])
@pytest.mark.parametrize("cut_off", [0.4e-3, 0.2e-3, 0.1e-3, 0.05e-3])
def test_area_and_friction_are_those_of_rounded_edges(slope, cut_off):
    """Area within 10 %; friction within 10 % or 0.002, of which flat tiles have 0.004 at edges."""
    rough = faces(slope)
    rounded = filtered(grooves(POSITION), np.exp(-0.5 * (WAVENUMBER * 50e-6) ** 2))
    whole = filtered(rough, transmission(WAVENUMBER, cut_off)) + rounded
    truth = gs.solve_rough_contact(tread(), gs.Profile(POSITION, whole), **LOAD)
    tiles = gs.Profile(POSITION, rough + grooves(POSITION))
    found = gs.solve_rough_contact(tread(), tiles, smallest_wavelength=cut_off, **LOAD)
    assert truth.converged
    assert found.converged
    assert found.contact_fraction == pytest.approx(truth.contact_fraction, rel=0.1)
    assert found.friction_from_dissipation == pytest.approx(
        truth.friction_from_dissipation, rel=0.1, abs=0.002
    )


@pytest.mark.verification
@pytest.mark.parametrize("turn", [0.0, 45.0])
def test_a_map_of_tiles_has_no_false_crests(turn):
    """Flat tiles with grooves across the way of sliding and slanted, a cut-off of 0.4 mm."""
    step, points = 0.05e-3, 400
    x = step * np.arange(points)
    along, across = np.meshgrid(x, x, indexing="ij")
    way = along if turn == 0.0 else along + across  # both repeat after 20 mm: four tiles
    z = grooves(way)
    surface = gs.HeightMap(x, x, z)
    number = (
        2.0 * np.pi * np.hypot(np.fft.fftfreq(points, step)[:, None], np.fft.rfftfreq(points, step))
    )
    rounded = np.fft.irfft2(np.fft.rfft2(z) * np.exp(-0.5 * (number * 50e-6) ** 2), s=z.shape)
    truth = gs.solve_rough_contact(
        tread(), gs.HeightMap(x, x, rounded), **LOAD, tolerance=0.05, workers=1
    )
    found = gs.solve_rough_contact(
        tread(), surface, smallest_wavelength=0.4e-3, **LOAD, tolerance=0.05, workers=1
    )
    assert found.contact_fraction == pytest.approx(truth.contact_fraction, rel=0.1)
    assert found.friction_from_dissipation == pytest.approx(
        truth.friction_from_dissipation, rel=0.1, abs=0.002
    )
