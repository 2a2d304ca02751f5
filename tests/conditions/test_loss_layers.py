"""Loss in layers against the closed forms of what it samples, and as the block tells it."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain.heat import WaveHeat
from gripscale.conditions import (
    LossDepth,
    harmonic_at_surface,
    harmonic_decay,
    harmonic_where_lost,
    uniform_at_surface,
    uniform_where_lost,
)
from gripscale.conditions.flash_temperature import LossLayers
from tests.samples import THERMAL

WAVELENGTH = 1e-3
K = 2.0 * np.pi / WAVELENGTH
PLANE = LossDepth.under(K)


def sampled(layers):
    """(k z)^2 exp(-2 k z) in layers that grow with depth."""
    edges = 1.5 * WAVELENGTH * np.linspace(0.0, 1.0, layers + 1) ** 2
    s = 2.0 * K * edges
    below = (1.0 + s + 0.5 * s**2) * np.exp(-s)
    return LossLayers.of(edges, -np.diff(below))


def errors(layers):
    """Errors of the temperatures it decides, relative to those where energy is lost."""
    one = sampled(layers)
    out = []
    for speed in (0.0, 1e-2, 1.0):
        m = harmonic_decay(K * np.arange(1.0, 6.0), K * np.arange(1.0, 6.0), speed, THERMAL)
        size = np.abs(harmonic_where_lost(m, PLANE, THERMAL)).max()
        for of in (harmonic_at_surface, harmonic_where_lost):
            out.append(float(np.abs(of(m, one, THERMAL) - of(m, PLANE, THERMAL)).max() / size))
    for time in (1e-4, 1e-2, 1.0, 1e3):
        size = uniform_where_lost(time, PLANE, THERMAL)
        for of in (uniform_at_surface, uniform_where_lost):
            out.append(abs(of(time, one, THERMAL) - of(time, PLANE, THERMAL)) / size)
    return out


def test_many_layers_are_the_distribution():
    """Even loss within a layer errs by the second order of its height."""
    coarse, fine = max(errors(20)), max(errors(80))
    assert coarse < 0.03
    assert fine < 2e-3
    assert fine < coarse / 10.0


def test_the_mean_depth_is_the_mean():
    assert sampled(200).mean == pytest.approx(PLANE.mean, rel=1e-3)
    assert sampled(200).share.sum() == pytest.approx(1.0, rel=1e-12)


RUBBER = gs.Rubber(1e6, [2e6, 4e6], [1e-4, 1e-5], bulk_modulus=1e11)


def solved(amplitude, **mesh):
    return gs.solve_scale(
        RUBBER, wavelength=WAVELENGTH, amplitude=amplitude, pressure=3e5, speed=3.0, **mesh
    )


def test_rows_lose_what_the_block_loses():
    wave = solved(1e-4)
    edges, lost = wave.loss_by_depth
    assert lost.sum() == pytest.approx(wave.friction_from_dissipation, rel=1e-12)
    assert edges.shape == (lost.size + 1,)
    assert edges[-1] == pytest.approx(1.5 * WAVELENGTH)


def test_full_contact_at_small_slope_loses_as_deep_as_a_half_plane():
    """Rows of finite height put the loss deeper, by half with twice the columns: 1.3 %, 0.7 %."""
    off = []
    for columns, rows in ((64, 14), (128, 20)):
        heat = WaveHeat.of(solved(1e-6, columns=columns, rows=rows), RUBBER)
        assert isinstance(heat.depth, LossLayers)
        off.append(heat.depth.mean / PLANE.mean - 1.0)
    assert 0.0 < off[1] < 0.01
    assert off[1] < 0.7 * off[0]


def test_a_wave_without_rows_is_taken_for_a_half_plane():
    wave = gs.theory.solve_half_plane(
        RUBBER, wavelength=WAVELENGTH, amplitude=1e-6, pressure=3e5, speed=3.0
    )
    assert wave.loss_by_depth is None
    assert WaveHeat.of(wave, RUBBER).depth.mean == pytest.approx(PLANE.mean, rel=1e-3)
