"""One wave of the finite-strain block against closed forms and other codes, on the default mesh."""

import numpy as np
import pytest

import gripscale as gs
from gripscale import theory
from gripscale.wave import Mesh
from tests import closed_forms
from tests.verification.families import (
    AMPLITUDE,
    RELAXED,
    WAVELENGTH,
    Family,
    finite_strain,
    root_mean_square,
    westergaard,
    worst,
)

WAVE = {"wavelength": WAVELENGTH, "amplitude": AMPLITUDE}


def rubber(moduli=(), times=(), bulk_modulus=3e9):
    return gs.Rubber(RELAXED, moduli, times, bulk_modulus=bulk_modulus)


def test_westergaard():
    family = westergaard()
    results = family.solve(Mesh())
    # Each edge is found to about a seventh of the node spacing: 0.0022 of 128 columns together.
    assert worst(family.area_errors(results)) < 0.0025
    assert max(abs(result.friction) for result in results) < 1e-9
    for result in results:
        # p_max/p = 2/sqrt(p/p*); the nodal pressures at the crest are right to about 0.5 %.
        full = theory.full_contact_pressure(result.rubber.plane_strain_modulus(1.0).real, **WAVE)
        expected = 2.0 * np.sqrt(result.pressure_received * full)
        assert result.pressure.max() == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("family", [westergaard(), finite_strain()], ids=lambda f: f.name)
def test_elastic_contact_on_every_mesh(family: Family):
    """Edges within a seventh of a spacing each on fine meshes; few rows cost the coarsest more."""
    for columns, rows in ((32, 8), (64, 12), (96, 16), (192, 26)):
        errors = family.area_errors(family.solve(Mesh(columns, rows)))
        assert worst(errors) < 2.0 / 7.0 * 1.4 / columns
        assert root_mean_square(errors) < 0.2 / columns


@pytest.mark.parametrize(
    ("moduli", "times"),
    [([9e6], [2e-4]), ([9e6, 4e6, 3e7, 2e6], [1e-6, 1e-4, 1e-3, 0.5])],
    ids=["one term", "four terms"],
)
def test_full_contact_friction(moduli, times):
    material = rubber(moduli, times, bulk_modulus=1e11)
    speed = 0.5
    stiffness = material.plane_strain_modulus(2 * np.pi * speed / WAVELENGTH)
    pressure = 1.2 * abs(theory.full_contact_pressure(stiffness, **WAVE))
    expected = theory.full_contact_friction(stiffness, **WAVE, pressure=pressure)
    result = gs.solve_scale(material, **WAVE, pressure=pressure, speed=speed)
    assert result.status == "converged"
    assert result.contact_fraction == 1.0
    # 128 columns resolve the wave to (k h)^2 / 6 = 0.04 %, the graded rows to about 0.3 %.
    assert result.friction == pytest.approx(expected, rel=0.005)
    assert result.friction_from_dissipation == pytest.approx(expected, rel=0.005)


def test_hertz_line_contact_at_light_load():
    """A narrow contact does not feel the neighbouring crests."""
    material = rubber()
    stiffness = material.plane_strain_modulus(1.0).real
    pressure = 0.01 * theory.full_contact_pressure(stiffness, **WAVE)
    half_width = closed_forms.contact_half_width(
        load_per_length=pressure * WAVELENGTH,
        radius=closed_forms.crest_radius(**WAVE),
        plane_strain_modulus=stiffness,
    )
    result = gs.solve_scale(material, **WAVE, pressure=pressure, speed=0.0, columns=256, rows=20)
    assert result.status == "converged"
    # Hertz is Westergaard's limit to (k a)^2 / 24 = 0.2 %; edges within a seventh of 1/256.
    assert result.contact_length == pytest.approx(2 * half_width, abs=0.002 * WAVELENGTH)
