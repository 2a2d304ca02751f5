"""Heat of the interface, and the counterface it is shared with, against closed forms.

`contact_source_temperature` has a unit of friction, lost evenly over the contact at the surface.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.fft
from scipy.sparse.linalg import LinearOperator, gmres

import gripscale as gs
from gripscale.conditions import Conditions, ConstantStress, GaussianStress, LossDepth
from gripscale.conditions import flash_temperature as rise
from gripscale.conditions.flash_temperature import STEEL, STONE, Partition
from gripscale.half_space.conditions import (
    OctaveHeat,
    contact_source_temperature,
    grid_temperature,
    octave_heats,
    temperature,
    warming_of,
)
from gripscale.half_space.grid import Grid
from tests.half_space.heat_patterns import pattern_of
from tests.half_space.rough_cases import two_waves
from tests.samples import SHIFTED_RUBBER, THERMAL

FLUX = 1e5
LINE = two_waves(2e-5)
LOAD = {"pressure": 3e5, "speed": 1.0, "periodic": True, "tolerance": None, "footprint": 0.1}


def _band(share, *, speed, time, length=0.1, points=2**15, counterface=None):
    """Return grid, contact, rises by a unit of friction on a band, and that of the counterface."""
    grid = Grid((points,), (length,))
    contact = np.arange(points) < share * points
    options = {"flux": FLUX, "speed": speed, "time": time, "thermal": THERMAL}
    unit, road = contact_source_temperature(grid, [], contact, counterface=counterface, **options)
    return grid, contact, unit, road


@pytest.mark.parametrize("counterface", [STONE, STEEL])
def test_uniform_heat_is_shared_as_the_effusivities(counterface):
    time = 0.2
    _, _, unit, road = _band(1.0, speed=0.5, time=time, points=64, counterface=counterface)
    part = Partition(0.0, unit.surface.mean(), road)
    both = THERMAL.effusivity + counterface.effusivity
    assert part.net(1.0) == pytest.approx(THERMAL.effusivity / both, rel=1e-12)
    # of two half-spaces pressed together, Carslaw & Jaeger, sec. 2.9
    exact = 2.0 * FLUX * math.sqrt(time / math.pi) / both
    assert part.net(1.0) * unit.surface == pytest.approx(exact, rel=1e-12)


def test_a_tread_on_a_road_takes_a_quarter_of_uniform_heat():
    part = THERMAL.effusivity / (THERMAL.effusivity + STONE.effusivity)
    assert part == pytest.approx(0.25, abs=0.01)


@pytest.mark.parametrize("passages", [1, 30])
def test_the_end_of_a_fast_band_is_as_hot_as_the_time_under_it(passages):
    """v l/D = 2e6: heat goes down only, 2 q/e sqrt(t/pi) for each time t begun and ended under it.

    Jaeger (1942); rubber at the end of the band has been under it `passages` times.
    """
    length, share, speed = 0.1, 0.3, 10.0
    _, contact, unit, _ = _band(share, speed=speed, time=passages * length / speed)
    q = FLUX / share / THERMAL.effusivity
    passed = np.arange(passages) * length / speed
    exact = 2.0 * q * (np.sqrt(passed + share * length / speed) - np.sqrt(passed)).sum()
    # 2 % in between, where the model lets waves that pass many times begin at any phase
    assert unit.surface[contact].max() == pytest.approx(exact / math.sqrt(math.pi), rel=0.01)


def test_a_moving_band_shares_its_heat_with_a_cold_road():
    """Blok: means over the band, of rubber that meets all of it once and stone that stays under it.

    Rubber at x of a band of length l began there one period L ago: heat since x/v, and from L/v to
    (L - l + x)/v ago. The stone has 2 q sqrt(t/pi)/e, less what leaves at the edges.
    """
    length, share, speed = 0.1, 0.3, 10.0
    time = length / speed
    _, contact, unit, road = _band(share, speed=speed, time=time, counterface=STONE)
    q = FLUX / share
    mean = 2.0 / 3.0 * (share**1.5 - 1.0 + (1.0 - share) ** 1.5) / share + 1.0
    exact = 2.0 * q * mean * math.sqrt(time / math.pi) / THERMAL.effusivity
    assert unit.surface[contact].mean() == pytest.approx(exact, rel=0.01)
    exact_road = 2.0 * q * math.sqrt(time / math.pi) / STONE.effusivity
    assert road == pytest.approx(exact_road, rel=0.01)
    part = Partition(0.0, unit.surface[contact].mean(), road)
    ratio = mean * STONE.effusivity / THERMAL.effusivity
    assert part.net(1.0) == pytest.approx(1.0 / (1.0 + ratio), rel=0.01)


def test_a_square_at_rest_on_a_map_is_as_hot_as_carslaw_and_jaegers():
    """Steady mean 0.946 q a/kappa over a square of side 2 a (sec. 10.5), short of a late point.

    After t a small source lacks Q/(2 pi kappa sqrt(pi D t)) of its steady temperature (sec. 10.4).
    """
    side, wide, length = 24, 384, 16e-2
    grid = Grid((wide, wide), (length, length))
    contact = np.zeros((wide, wide), dtype=bool)
    contact[:side, :side] = True
    a = 0.5 * side * length / wide
    time = (length / 8.0) ** 2 / STONE.diffusivity
    options = {"flux": FLUX, "speed": 1.0, "time": time, "thermal": THERMAL}
    _, road = contact_source_temperature(grid, [], contact, counterface=STONE, **options)
    q = FLUX / contact.mean()
    lacking = 4.0 * a**2 / (2.0 * math.pi * math.sqrt(math.pi * STONE.diffusivity * time))
    exact = q / STONE.conductivity * (0.946 * a - lacking)
    assert road == pytest.approx(exact, rel=0.01)


def test_heat_of_the_hysteresis_leaves_through_the_contact():
    """Lost evenly at one depth under full contact: both surfaces take 1/(1 + b/c) of the rise."""
    grid, time = Grid((64,), (1e-2,)), 0.05
    heat = OctaveHeat(1e3, 0.2, pattern_of(np.ones(64)), LossDepth(1e-4))
    options = {"flux": FLUX, "speed": 0.5, "time": time, "thermal": THERMAL}
    cold = grid_temperature(grid, [heat], **options)
    alone = FLUX * 0.2 * rise.uniform_at_surface(time, heat.depth, THERMAL)
    assert cold.surface == pytest.approx(alone, rel=1e-12)
    unit, road = contact_source_temperature(
        grid, [heat], np.ones(64, dtype=bool), counterface=STONE, **options
    )
    part = Partition(alone, unit.surface.mean(), road)
    remains = alone * THERMAL.effusivity / (THERMAL.effusivity + STONE.effusivity)
    assert alone + part.net(0.0) * unit.surface == pytest.approx(remains, rel=1e-12)
    assert part.net(0.0) < 0.0


def test_what_enters_rubber_and_road_is_what_the_interface_loses():
    part = Partition(3.0, 20.0, 50.0)
    for lost in (0.0, 0.4, 1.3):
        into_rubber = part.net(lost)
        assert part.hysteresis + part.rubber * into_rubber == pytest.approx(
            part.counterface * (lost - into_rubber)
        )
    assert Partition(3.0, 20.0, math.inf).net(0.4) == 0.4


def _contact(conditions):
    return gs.solve_rough_contact(SHIFTED_RUBBER, LINE, conditions=conditions, **LOAD)


@pytest.mark.parametrize("counterface", [None, STONE], ids=["insulating", "stone"])
def test_the_settled_contact_has_the_stress_of_its_temperature(counterface):
    law = GaussianStress(4e6, 0.1, 6e-3, 0.97, 293.15)
    conditions = Conditions(heat=THERMAL, counterface=counterface, shear_stress=law)
    contact = _contact(conditions)
    assert contact.converged
    _, again = temperature(contact, conditions, 0.1)
    kelvin = 293.15 + np.average(contact.surface_warming, weights=contact.pressure)
    exact = float(law.stress(1.0, kelvin)) * contact.contact_fraction / 3e5
    assert contact.adhesive_friction == pytest.approx(exact, rel=1e-12)
    assert again.surface == pytest.approx(contact.surface_warming, rel=1e-6)


def test_one_flux_into_the_road_against_equal_temperatures_everywhere():
    """GMRES for the flux that makes both surfaces equally hot at every point of the contact.

    The even flux has its mean temperature to 3 %.
    """
    shear = 2e6
    contact = _contact(Conditions(heat=THERMAL))
    active, grid, time = contact.active, contact.grid, 0.1
    conditions = Conditions(heat=THERMAL, counterface=STONE, shear_stress=ConstantStress(shear))
    _, blok = temperature(contact, conditions, time)
    heats = octave_heats(grid, contact.pressure, contact.lost_by_harmonic())
    options = {"flux": 3e5, "speed": 1.0, "time": time, "thermal": THERMAL}
    cold = grid_temperature(grid, heats, **options)
    surface = LossDepth(0.0)

    def responses(solid, speed):
        m = rise.harmonic_decay(grid.wavenumber, grid.along, speed, solid)
        m[0] = 1.0
        out = rise.PassingHarmonics(m, time, solid).at_surface(surface)
        out[0] = rise.uniform_at_surface(time, surface, solid)
        return out

    rubber, stone = responses(THERMAL, 1.0), responses(STONE, 0.0)
    where = np.flatnonzero(active)

    def applied(response):
        def product(flux):
            everywhere = np.zeros(grid.points)
            everywhere[where] = flux
            return scipy.fft.irfft(scipy.fft.rfft(everywhere) * response, grid.points)

        return product

    shape = (where.size, where.size)
    both = LinearOperator(shape, matvec=lambda q: applied(rubber + stone)(q)[where])
    inverse = LinearOperator(shape, matvec=lambda q: applied(1.0 / (rubber + stone))(q)[where])
    lost = np.full(where.size, shear * contact.contact_fraction / active.mean())
    into_road, status = gmres(
        both, (cold.surface + applied(rubber)(lost))[where], M=inverse, rtol=1e-8, restart=100
    )
    assert status == 0
    exact = cold.surface + applied(rubber)(lost - into_road)
    assert exact[where] == pytest.approx(applied(stone)(into_road)[where], rel=1e-4)
    means = [np.average(field, weights=contact.pressure) for field in (blok.surface, exact)]
    assert means[0] == pytest.approx(means[1], rel=0.03)


def test_the_warming_that_a_contact_would_have():
    """Of a rubber without a shift: its cold contact with the heat that would warm it."""
    conditions = Conditions(heat=THERMAL, counterface=STONE)
    cold = gs.solve_rough_contact(replace(SHIFTED_RUBBER, shift=None), LINE, **LOAD)
    would = warming_of(cold, conditions, footprint=0.1)
    hot = _contact(conditions)
    mean = np.average(hot.surface_warming, weights=hot.pressure)
    assert would.contact == pytest.approx(mean, rel=0.3)
    assert 0.0 < would.where_lost < 2.0 * would.contact
