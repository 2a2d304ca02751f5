"""One wave of the finite-element block against closed forms, on the default mesh."""

import numpy as np
import pytest

import gripscale as gs
from gripscale import theory

AMPLITUDE = 1e-6
WAVELENGTH = 1e-3


def rubber(moduli=(), times=(), bulk_modulus=3e9):
    return gs.Rubber(
        equilibrium_modulus=3e6, moduli=moduli, relaxation_times=times, bulk_modulus=bulk_modulus
    )


def solve(material, *, pressure, speed=0.0, amplitude=AMPLITUDE, **options):
    result = gs.solve_scale(
        material,
        wavelength=WAVELENGTH,
        amplitude=amplitude,
        pressure=pressure,
        speed=speed,
        **options,
    )
    assert result.status == "converged"
    return result


@pytest.mark.parametrize("ratio", [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9])
def test_westergaard_contact_fraction(ratio):
    material = rubber()
    full = theory.full_contact_pressure(
        material.plane_strain_modulus(1.0).real, wavelength=WAVELENGTH, amplitude=AMPLITUDE
    )
    result = solve(material, pressure=ratio * full)
    # Each edge is found to about a seventh of the node spacing: 0.0022 of 128 columns together.
    assert result.contact_fraction == pytest.approx(theory.contact_fraction(ratio), abs=0.0025)
    assert abs(result.friction) < 1e-9
    # p_max/p = 2/sqrt(p/p*); the nodal pressures at the crest are right to about 0.5 %.
    assert result.pressure.max() == pytest.approx(2 * ratio**0.5 * full, rel=0.01)


@pytest.mark.parametrize(
    ("moduli", "times"),
    [([9e6], [2e-4]), ([9e6, 4e6, 3e7, 2e6], [1e-6, 1e-4, 1e-3, 0.5])],
    ids=["one term", "four terms"],
)
def test_full_contact_friction(moduli, times):
    material = rubber(moduli, times, bulk_modulus=1e11)
    speed = 0.5
    stiffness = material.plane_strain_modulus(2 * np.pi * speed / WAVELENGTH)
    pressure = 1.2 * abs(
        theory.full_contact_pressure(stiffness, wavelength=WAVELENGTH, amplitude=AMPLITUDE)
    )
    expected = theory.full_contact_friction(
        stiffness, wavelength=WAVELENGTH, amplitude=AMPLITUDE, pressure=pressure
    )
    result = solve(material, pressure=pressure, speed=speed)
    assert result.contact_fraction == 1.0
    # 128 columns resolve the wave to (k h)^2 / 6 = 0.04 %, the graded rows to about 0.3 %.
    assert result.friction == pytest.approx(expected, rel=0.005)
    assert result.friction_from_dissipation == pytest.approx(expected, rel=0.005)


@pytest.mark.parametrize(
    ("ratio", "fraction"),
    [(0.1, 0.20589), (0.3, 0.37276), (0.5, 0.50448), (0.7, 0.63081), (0.9, 0.77240)],
)
def test_finite_strain_contact_fraction_of_other_codes(ratio, fraction):
    """Elastic, A/lambda = 0.1, K/G = 1000, depth one wavelength; reference known to 0.0002."""
    amplitude = 0.1 * WAVELENGTH
    pressure = ratio * 4 * np.pi * 1e6 * 0.1
    result = solve(rubber(bulk_modulus=1e9), pressure=pressure, amplitude=amplitude, depth=1.0)
    assert result.contact_fraction == pytest.approx(fraction, abs=0.003)


def test_hertz_line_contact_at_light_load():
    """A narrow contact does not feel the neighbouring crests."""
    material = rubber()
    stiffness = material.plane_strain_modulus(1.0).real
    full = theory.full_contact_pressure(stiffness, wavelength=WAVELENGTH, amplitude=AMPLITUDE)
    pressure = 0.01 * full
    half_width = theory.contact_half_width(
        load_per_length=pressure * WAVELENGTH,
        radius=theory.crest_radius(wavelength=WAVELENGTH, amplitude=AMPLITUDE),
        plane_strain_modulus=stiffness,
    )
    result = solve(material, pressure=pressure, columns=256, rows=20)
    # Hertz is Westergaard's limit to (k a)^2 / 24 = 0.2 %; edges within a seventh of 1/256.
    assert result.contact_length == pytest.approx(2 * half_width, abs=0.002 * WAVELENGTH)
