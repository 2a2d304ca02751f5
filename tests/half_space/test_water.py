"""Trapped water: what pools hold, what they carry, and where there are none."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.half_space.regions import periodic_regions
from gripscale.surface import HeightMap
from tests.half_space.rough_cases import grooves, isotropic_map, sine, solve

MAP = isotropic_map(64, shortest=1.6e-3)
PRESSURES = (2e5, 5e5, 9e5)
"""Dry contact areas of 0.3 to 0.9."""


@pytest.fixture(scope="module")
def contacts():
    """Contacts in water under each pressure."""
    return {load: solve(MAP, pressure=load, tolerance=None, water=True) for load in PRESSURES}


def volumes(contact):
    """Return the gap over each pool [m^3]."""
    cell = np.prod(contact.grid.spacing)
    return np.bincount(contact.water.pool.ravel(), contact.gap.ravel())[1:] * cell


def test_every_pool_keeps_its_volume(contacts):
    """The smallest pools hold a few points, to which the solver closes a gap."""
    for contact in contacts.values():
        full = contact.water.pool_pressure > 0.0
        assert full.any()
        kept = volumes(contact)[full] / contact.water.pool_volume[full]
        np.testing.assert_allclose(kept, 1.0, rtol=1e-3)


def test_contact_and_pools_carry_the_load(contacts):
    for load, contact in contacts.items():
        assert contact.pressure.mean() == pytest.approx(load, rel=1e-6)
        parts = np.where(contact.active, contact.pressure, contact.water.pressure)
        assert parts.mean() == pytest.approx(load, rel=1e-6)


def test_a_pool_lifts_what_it_can(contacts):
    """Contact is nowhere inside a pool under less pressure than its water; pools do not drain."""
    for contact in contacts.values():
        regions = periodic_regions(~contact.active)
        draining = regions.where(regions.percolates.any(axis=1))
        assert not (draining & (contact.water.pressure > 0.0)).any()


def test_water_acts_above_the_percolation_of_contact(contacts):
    """Little below an area of 0.42; above it the area stays near that, and friction falls."""
    low, middle, high = contacts.values()
    ratios = [
        contact.friction_from_dissipation / contact.water.dry_friction
        for contact in (low, middle, high)
    ]
    assert low.water.dry_contact_fraction < 0.42 < middle.water.dry_contact_fraction
    assert 0.95 < ratios[0] <= 1.0
    assert ratios[2] < ratios[1] < 0.95
    assert high.water_load_share > middle.water_load_share > low.water_load_share
    assert high.contact_fraction < 0.6 < high.water.dry_contact_fraction


def test_the_two_frictions_agree_in_water(contacts):
    for contact in contacts.values():
        assert contact.friction_mismatch < 0.05


def test_a_thin_film_is_a_dry_contact(contacts):
    """A nanometre on waves of 0.3 mm fills no pool; a film above all heights is a flood."""
    wet = solve(MAP, pressure=5e5, tolerance=None, water="1 nm")
    assert wet.water_load_share == pytest.approx(0.0, abs=1e-4)
    assert wet.contact_fraction == pytest.approx(wet.water.dry_contact_fraction, rel=1e-6)
    assert wet.friction_from_dissipation == pytest.approx(wet.water.dry_friction, rel=1e-4)
    deep = solve(MAP, pressure=5e5, tolerance=None, water=5e-3)
    assert deep.friction == pytest.approx(contacts[5e5].friction, rel=1e-6)


def test_grooves_drain():
    """Open grooves lead to the next period: a sine traps nothing."""
    wet = solve(grooves("x", 64), pressure=3e4, tolerance=None, water=True)
    dry = solve(grooves("x", 64), pressure=3e4, tolerance=None)
    assert wet.water.pool_volume.size == 0
    assert wet.contact_fraction == pytest.approx(dry.contact_fraction, abs=1e-9)
    assert wet.friction_from_dissipation == pytest.approx(dry.friction_from_dissipation, rel=1e-5)


def test_a_bowl_holds_the_water_of_its_rim():
    """A square rim around a bowl: water in full contact takes the load that dry rubber had."""
    x = np.arange(64) * 1e-5
    bump = 0.5 - 0.5 * np.cos(2.0 * np.pi * x / 6.4e-4)
    heights = -1e-5 * bump[:, None] * bump  # one hollow in a plane
    surface = HeightMap(x, x, heights)
    wet = solve(surface, pressure=1e6, tolerance=None, water=True)
    assert wet.water.pool_pressure.size == 1
    assert 0.0 < wet.water.pool_pressure[0] < 2e6
    assert wet.contact_fraction < wet.water.dry_contact_fraction


def test_the_result_shows_the_water(contacts):
    contact = contacts[PRESSURES[-1]]
    data = contact.to_dataset()
    assert float(data.water_load_share) == contact.water_load_share
    assert data.pool_pressure.attrs["units"] == "Pa"
    assert "Trapped water carries" in " ".join(contact.notes)
    assert len(contact.plot().axes) == 2


@pytest.mark.parametrize(
    ("surface", "water", "words"),
    [
        (sine(), True, "needs a map"),
        (MAP, -1e-3, "water must be greater than zero"),
        (MAP, "rain", "thickness of a film"),
        (MAP, 0.0, "greater than zero"),
    ],
)
def test_water_that_cannot_be(surface, water, words):
    with pytest.raises(gs.InputError, match=words):
        solve(surface, water=water)


def test_a_start_in_water_is_refused(contacts):
    with pytest.raises(gs.InputError, match="water"):
        solve(MAP, tolerance=None, start=contacts[PRESSURES[0]])
    with pytest.raises(gs.InputError, match="water"):
        gs.sensitivity(contacts[PRESSURES[0]])


def test_an_isolated_dimple_closes_with_its_water_under_the_whole_load():
    """At the first touch: exact are the nominal pressure and the volume of the pit."""
    x = np.arange(64) * 1e-5
    radius = np.hypot(x[:, None] - 3.2e-4, x - 3.2e-4) / 2e-4
    heights = -1e-5 * np.where(radius < 1.0, 0.5 + 0.5 * np.cos(np.pi * radius), 0.0)
    wet = solve(HeightMap(x, x, heights), pressure=3e5, tolerance=None, water=True)
    assert wet.water.pool_pressure == pytest.approx([3e5], rel=5e-3)
    assert wet.water.pool_volume == pytest.approx([-heights.sum() * 1e-10], rel=0.01)
