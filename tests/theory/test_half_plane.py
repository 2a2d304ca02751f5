"""Small-strain sliding against Westergaard, full contact, a reference table, and itself."""

from dataclasses import replace

import numpy as np
import pytest

from gripscale import ScaleResult
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber, styrene_butadiene
from gripscale.theory import (
    full_contact_friction,
    full_contact_pressure,
    plane_strain_modulus,
    solve_half_plane,
)
from tests.closed_forms import contact_fraction, contact_pressure
from tests.verification.families import zener_table

WAVELENGTH, AMPLITUDE, RELAXED, TIME = 1e-3, 1e-5, 3e6, 1e-2
SLOPE = 2 * np.pi * AMPLITUDE / WAVELENGTH
WAVE = {"wavelength": WAVELENGTH, "amplitude": AMPLITUDE}


def zener(stiffening: float) -> Rubber:
    return Rubber(RELAXED, [RELAXED * (stiffening - 1)], [TIME], bulk_modulus=1e12)


def slide(stiffening: float, load: float, phase: float, **more) -> ScaleResult:
    """Slide a Zener half-plane at p/p*_relaxed = `load` and k v tau = `phase`."""
    full = full_contact_pressure(plane_strain_modulus(RELAXED, 0.5), **WAVE)
    speed = phase * WAVELENGTH / (2 * np.pi * TIME)
    return solve_half_plane(zener(stiffening), pressure=load * full, speed=speed, **WAVE, **more)


@pytest.mark.parametrize("every", [pytest.param(1, marks=pytest.mark.verification), 4])
def test_reference_table_of_the_zener_half_plane(every):
    """Friction to 0.2 % plus the table's own error, the difference of its two grids (at
    mu/(kA) = 3e-4 that is 5 %); fraction to 0.002, two points of its 1024; edges to one point
    and the rounding of one."""
    rows = zener_table()
    assert len(rows) == 78
    for row in rows[::every]:
        found = slide(
            row["E_glassy_over_E_relaxed"], row["pbar_over_pstar_relaxed"], row["k_v_tau"]
        )
        expected = row["mu_over_kDelta_n1024"]
        own_error = abs(expected - row["mu_over_kDelta_n512"])
        assert found.status == "converged"
        assert found.friction / SLOPE == pytest.approx(expected, abs=0.002 * expected + own_error)
        assert found.contact_fraction == pytest.approx(row["contact_ratio_n1024"], abs=0.002)
        [(start, end)] = found.details["contact_edges"]
        assert -start / WAVELENGTH == pytest.approx(row["x_leading_over_lambda"], abs=0.0015)
        assert -end / WAVELENGTH == pytest.approx(row["x_trailing_over_lambda"], abs=0.0015)


@pytest.mark.parametrize("load", [0.02, 0.1, 0.3, 0.5, 0.8, 0.97])
def test_standing_still_is_westergaard(load):
    """Edges are located inside the elements: 0.4 of 1024. Pressures away from the edges by one
    element: error of piecewise linear pressure at a square root, a few 1e-3 of the mean."""
    found = slide(10.0, load, 0.0)
    assert found.contact_fraction == pytest.approx(float(contact_fraction(load)), abs=4e-4)
    assert abs(found.friction) < 1e-12
    assert found.friction_from_dissipation == 0.0
    full = found.pressure_received / load
    expected = contact_pressure(
        found.x, wavelength=WAVELENGTH, pressure=found.pressure_received, full_contact_pressure=full
    )
    edge = 0.5 * WAVELENGTH * float(contact_fraction(load))
    inside = np.abs(np.abs(found.x) - edge) > 4 * WAVELENGTH / 1024
    worst = np.abs(found.pressure - expected)[inside].max() / found.pressure_received
    assert worst < 0.01 / np.sqrt(load)
    assert found.pressure.max() == pytest.approx(expected.max(), rel=1e-3)


def test_full_contact_is_the_closed_form():
    omega = 3.0 / TIME
    modulus = complex(zener(10.0).plane_strain_modulus(omega))
    relaxed = full_contact_pressure(RELAXED * 4 / 3, **WAVE)
    load = 1.2 * full_contact_pressure(modulus, **WAVE)
    found = slide(10.0, load / relaxed, 3.0)
    expected = full_contact_friction(modulus, pressure=load, **WAVE)
    assert found.friction == pytest.approx(expected, rel=1e-12)
    assert found.friction_from_dissipation == pytest.approx(expected, rel=1e-12)
    assert found.contact_fraction == 1.0
    # the pressure it reports does the same work: exact rule on 1024 points
    slope = -SLOPE * np.sin(2 * np.pi * found.x / WAVELENGTH)
    work = np.mean(found.pressure * slope) / found.pressure.mean()
    assert work == pytest.approx(expected, rel=1e-12)
    assert found.pressure.min() >= 0.0


def test_contact_fills_continuously():
    """Just below the full-contact load the boundary elements give the closed form's friction.

    At 1 - 1e-5 the open gap is (2/pi) sqrt(1e-5) = 0.2 % of the wave."""
    modulus = complex(zener(10.0).plane_strain_modulus(1.0 / TIME))
    ratio = full_contact_pressure(modulus, **WAVE) / full_contact_pressure(RELAXED * 4 / 3, **WAVE)
    below, above = (slide(10.0, ratio * (1 + sign * 1e-5), 1.0) for sign in (-1, 1))
    assert not below.details["full_contact"]
    assert above.details["full_contact"]
    assert below.friction == pytest.approx(above.friction, rel=5e-5)
    assert 0.99 < below.contact_fraction < 1.0
    assert np.abs(below.pressure - above.pressure).max() < 1e-3 * above.pressure_received


def test_sliding_shifts_the_contact_to_the_side_the_rubber_comes_from():
    """Rubber moving towards +x meets the slope at x < 0 first; friction opposes it: positive."""
    found = slide(10.0, 0.2, 0.1)
    assert np.average(found.x, weights=found.pressure) < -0.02 * WAVELENGTH
    assert found.friction > 0.0


@pytest.mark.parametrize("load", [0.03, 0.3, 0.9])
@pytest.mark.parametrize("speed", [1e-3, 1.0])
def test_work_of_friction_is_the_energy_lost(speed, load):
    """A broad spectrum; the two differ only by the elements' own error at the edges."""
    rubber = styrene_butadiene()
    modulus = complex(rubber.plane_strain_modulus(2 * np.pi * speed / WAVELENGTH))
    pressure = load * full_contact_pressure(modulus, **WAVE)
    found = solve_half_plane(rubber, pressure=pressure, speed=speed, **WAVE)
    assert found.converged
    assert found.friction_mismatch < 1e-3
    assert not found.outside_band


def test_refining_the_grid_changes_nothing():
    """Error falls as the element length squared: from 512 to 2048 points 15/16 of it is gone."""
    coarse, middle, fine = (slide(10.0, 0.2, 0.1, points=n) for n in (256, 512, 2048))
    assert middle.friction == pytest.approx(fine.friction, rel=1e-4)
    assert abs(middle.friction - fine.friction) < abs(coarse.friction - fine.friction)
    assert middle.contact_fraction == pytest.approx(fine.contact_fraction, abs=0.5 / 512)


def test_any_number_of_points_will_do():
    odd = slide(10.0, 0.2, 0.1, points=301)
    assert odd.converged
    assert odd.friction == pytest.approx(slide(10.0, 0.2, 0.1).friction, rel=2e-3)


def test_load_time_is_recorded_and_without_effect():
    short, long = (slide(10.0, 0.2, 0.1, load_time=t) for t in (1e-3, np.inf))
    assert short.friction == long.friction
    assert (short.load_time, long.load_time) == (1e-3, np.inf)


def test_result_says_which_model_it_is():
    found = slide(10.0, 0.2, 0.1)
    assert found.model == "half_plane"
    assert np.isnan(found.min_stretch)
    assert np.isnan(found.max_stretch)
    assert found.x.shape == found.pressure.shape == (1024,)
    assert found.x[0] == pytest.approx(-0.5 * WAVELENGTH)
    assert found.pressure.mean() == pytest.approx(found.pressure_received, rel=1e-12)
    assert (found.pressure >= 0.0).all()
    assert found.residual < 1e-12


def test_not_converging_is_a_status():
    found = slide(10.0, 0.2, 0.1, most_iterations=1)
    assert not found.converged
    assert "not settled" in found.status


def test_a_contact_of_few_points_is_not_trusted():
    found = slide(10.0, 1e-4, 0.1)
    assert "too narrow" in found.status
    assert slide(10.0, 1e-4, 0.1, points=8192).converged


def test_frequencies_beyond_the_rubber_are_flagged():
    rubber = replace(styrene_butadiene(), valid_band=(1.0, 1e3))
    found = solve_half_plane(rubber, pressure=1e4, speed=1.0, **WAVE)
    assert found.outside_band


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wavelength": 0.0}, "wavelength must be greater than zero"),
        ({"wavelength": "1"}, "wavelength = '1': the unit is missing"),
        ({"amplitude": -1e-5}, "amplitude must be greater than zero"),
        ({"pressure": np.nan}, "pressure must be a finite number"),
        ({"speed": -1.0}, "speed must not be negative"),
        ({"load_time": -1.0}, "load_time must not be negative"),
        ({"points": 8}, "points must be a whole number from 16 to 8192"),
        ({"most_iterations": 0}, "most_iterations must be a whole number"),
    ],
)
def test_bad_input(change, message):
    good = {"pressure": 1e4, "speed": 0.1, **WAVE}
    with pytest.raises(InputError, match=message):
        solve_half_plane(zener(10.0), **{**good, **change})
