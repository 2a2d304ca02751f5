"""Both elements on the same waves: bilinear with one pressure, biquadratic with three."""

import numpy as np
import pytest

from gripscale.wave import Mesh
from tests.verification.families import finite_strain, large_strain, root_mean_square, worst, zener

ALIKE = Mesh(128, 20), Mesh(64, 10, element_order=2)
"""Meshes of equal unknowns."""


@pytest.mark.parametrize("mesh", ALIKE, ids=lambda mesh: f"order {mesh.element_order}")
def test_both_elements_are_right_in_elastic_contact(mesh):
    """Finite strain, within what 128 columns of nodes leave of an edge: a seventh of a spacing."""
    family = finite_strain()
    assert worst(family.area_errors(family.solve(mesh))) < 0.003


def test_biquadratic_elements_slide_as_the_half_plane_table_says():
    """Contact fraction as of bilinear ones; friction less well where few elements touch."""
    family = zener().every(6)
    results = family.solve(ALIKE[1])
    assert root_mean_square(family.area_errors(results)) < 0.002
    assert root_mean_square(family.friction_errors(results)) < 0.02


@pytest.mark.verification
def test_both_elements_meet_at_large_strain():
    """Fine meshes of both are within 0.15 % in friction, and the working ones near them.

    0.15 % is (k h)^2/6 on 128 columns of either and the graded rows, together.
    """
    fine = Mesh(256, 32), Mesh(128, 16, element_order=2)
    families = [large_strain(mesh) for mesh in fine]
    friction = [family.friction for family in families]
    area = [family.contact_fraction for family in families]
    assert np.abs(friction[0] / friction[1] - 1.0).max() < 0.0015
    assert np.abs(area[0] - area[1]).max() < 0.001
    for mesh in ALIKE:
        results = families[0].solve(mesh)
        assert root_mean_square(families[0].friction_errors(results)) < 0.003
        assert root_mean_square(families[0].area_errors(results)) < 0.002
