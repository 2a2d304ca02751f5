"""Where a contact makes its friction: shares by slope, strongest stretches, and traces of lines."""

import numpy as np
import pytest
import xarray as xr

from gripscale.half_space import DirectContact, contact_trace, shares_by_slope
from gripscale.half_space.location import strongest_stretches, traces_of
from gripscale.half_space.result import SHARES_BY_SLOPE, SLOPES
from gripscale.io import netcdf
from gripscale.surface import Profile

from .rough_cases import LOAD, SURFACE, isotropic_map, solve

MAP = solve(isotropic_map(64, shortest=1.6e-3), tolerance=None)
STEP, LENGTH = 2.5e-5, 0.1


def stones(steep_at):
    """Ten gentle stones of one height, and one as high with ten times the slope."""
    x = np.arange(round(LENGTH / STEP)) * STEP
    gentle = 2e-4 * np.cos(2.0 * np.pi * 10.0 * x / LENGTH)
    steep = 6e-4 * np.exp(-(((x - steep_at) / 4e-4) ** 2))
    return Profile(x, gentle + steep)


# between two gentle stones, whose summits are 10 mm apart
STEEP_AT = 0.065
STONES = solve(stones(STEEP_AT), smallest_wavelength=2e-4, tolerance=None)


def test_shares_of_full_contact_on_a_sine_are_those_of_the_closed_form():
    """p = p_0 + P cos(qx + phi) on h' = -S sin(qx): friction goes with sin^2, load with the length.

    Up to |sin| = sin u they are (2/pi) (u - sin u cos u) and 2 u/pi.
    """
    steepest, points = 0.8, 2048
    x = np.arange(points) * 1e-3 / points
    wave = Profile(x, steepest * 1e-3 / (2.0 * np.pi) * np.cos(2.0 * np.pi * x / 1e-3))
    contact = solve(wave, pressure=1e8, smallest_wavelength=1e-5, tolerance=None)
    assert contact.full_contact
    u = np.arcsin(np.minimum([*SLOPES, np.inf], steepest) / steepest)
    friction, length = (2.0 / np.pi * np.diff(part) for part in (u - np.sin(u) * np.cos(u), u))
    shares = shares_by_slope(contact)
    # four ends of a class fall between points
    within = 4.0 / contact.grid.points
    np.testing.assert_allclose(shares.friction_by_slope, friction, atol=2.0 * within)
    np.testing.assert_allclose(shares.load_by_slope, length, atol=within)
    np.testing.assert_allclose(shares.contact_by_slope, length, atol=within)


@pytest.mark.parametrize("contact", [MAP, STONES], ids=["map", "line"])
def test_shares_add_up(contact):
    shares = contact.shares_by_slope
    for name in SHARES_BY_SLOPE:
        assert float(shares[name].sum()) == pytest.approx(1.0, rel=1e-12)
    steep = shares.friction_by_slope.sel(slope=[1.0, 2.0]).sum()
    assert contact.steep_share == pytest.approx(float(steep), rel=1e-12)
    data = contact.to_dataset()
    np.testing.assert_array_equal(data.friction_by_slope, shares.friction_by_slope)


def test_at_rest_no_slope_makes_friction():
    rest = solve(isotropic_map(32, shortest=3.2e-3), tolerance=None, speed=0.0)
    assert rest.shares_by_slope.friction_by_slope.isnull().all()
    assert np.isnan(rest.steep_share)
    assert float(rest.shares_by_slope.load_by_slope.sum()) == pytest.approx(1.0, rel=1e-12)
    trace = contact_trace(rest)
    assert trace.running_friction.isnull().all()
    assert float(trace.stretch_load) > 0.0


def test_strongest_stretches_are_the_largest_sums_and_do_not_overlap():
    rng = np.random.default_rng(0)
    amount = rng.normal(size=60)
    none = np.zeros(60, dtype=bool)
    sums = [amount[i : i + 7].sum() for i in range(54)]
    firsts = strongest_stretches(amount, none, 7, 20)
    assert firsts[0] == int(np.argmax(sums))
    values = [sums[first] for first in firsts]
    assert values == sorted(values, reverse=True)
    ordered = np.sort(firsts)
    assert (np.diff(ordered) >= 7).all()
    assert len(firsts) > 4
    active = rng.random(60) < 0.4
    for first in strongest_stretches(amount, active, 7, 20):
        assert not active[first]
        assert not active[first + 6]
    assert strongest_stretches(amount, ~none, 7, 1) == firsts[:1]  # in contact everywhere


def test_the_steep_stone_is_the_strongest_stretch():
    trace = contact_trace(STONES, stretch=4e-3)
    start, end = float(trace.stretch_start), float(trace.stretch_end)
    assert end - start == pytest.approx(4e-3, abs=1.01 * STONES.grid.spacing[0])
    assert start < STEEP_AT < end
    slope = np.gradient(STONES.height, STONES.grid.spacing[0])
    force = STONES.pressure * slope
    inside = (STONES.x >= start) & (STONES.x <= end)
    share = float(force[inside].sum() / force.sum())
    # differences in place of the spectral slope: some per cent with eight points in a wave
    assert float(trace.stretch_friction) == pytest.approx(share, rel=0.05)
    assert share > 3.0 * 4e-3 / LENGTH
    load = float(STONES.pressure[inside].sum() / STONES.pressure.sum())
    assert float(trace.stretch_load) == pytest.approx(load, rel=1e-9)
    assert load < share


def test_a_trace_keeps_every_extreme():
    pieces = 400
    trace = contact_trace(STONES, stretch=2e-3, pieces=pieces)
    assert trace.sizes["piece"] <= pieces + 2
    assert STONES.x.size > 2 * pieces
    rubber = STONES.height + STONES.gap
    for name, values in (("height", STONES.height), ("rubber", rubber)):
        low, high = trace[f"{name}_low"].values, trace[f"{name}_high"].values
        np.testing.assert_allclose([low.min(), high.max()], [values.min(), values.max()], rtol=1e-6)
        assert (low <= high).all()
    assert float(trace.pressure_high.max()) == pytest.approx(STONES.pressure.max(), rel=1e-6)
    single = (trace.x >= trace.stretch_start) & (trace.x <= trace.stretch_end)
    x = trace.x.values[single.values]
    np.testing.assert_allclose(np.diff(x), STONES.grid.spacing[0], rtol=1e-6)
    np.testing.assert_allclose(
        trace.height_low.values[single.values], np.interp(x, STONES.x, STONES.height), atol=1e-9
    )
    # single precision of sums
    assert float(trace.running_friction[-1]) == pytest.approx(1.0, abs=1e-5)
    assert float(trace.running_load[-1]) == pytest.approx(1.0, abs=1e-5)


def test_a_map_has_its_section_and_field():
    trace = contact_trace(MAP)
    column = int(np.argmin(np.abs(MAP.y - float(trace.section))))
    np.testing.assert_allclose(trace.height_low, MAP.height[:, column], rtol=1e-6)
    force = MAP.pressure * MAP.grid.slope(MAP.height)
    expected = force[:, column].sum() / force.sum() * MAP.y.size
    assert float(trace.running_friction[-1]) == pytest.approx(expected, rel=1e-5)
    assert float(trace.field_pressure.max()) == pytest.approx(MAP.pressure.max(), rel=1e-6)
    touching = np.isfinite(trace.field_pressure.values)
    np.testing.assert_array_equal(touching, MAP.active)


def test_results_hold_traces_of_unlike_profiles(tmp_path):
    contacts = []
    model = DirectContact(tolerance=None, traces=True)
    answer = model.predict(STONES.rubber, SURFACE, LOAD, on_progress=contacts.append)
    kept = netcdf.load_dataset(netcdf.save(answer, tmp_path / "answer.nc"))
    for contact, trace in zip(contacts, traces_of(kept), strict=True):
        xr.testing.assert_equal(trace, contact_trace(contact))
    plain = DirectContact(tolerance=None).predict(STONES.rubber, SURFACE, LOAD)
    assert traces_of(plain) == []
    for name in SHARES_BY_SLOPE:
        assert float(plain[f"total_{name}"].sum()) == pytest.approx(1.0, rel=1e-12)
