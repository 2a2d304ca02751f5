"""A tolerance keeps its word on the reference cases, and the error estimate covers the error."""

import pytest

import gripscale as gs
from gripscale.wave import FiniteStrainBlock, Mesh, Sine, WaveLoad, WaveProblem
from tests.verification.families import RELAXED, finite_strain, westergaard, worst, zener

ELASTIC = gs.Rubber(RELAXED, bulk_modulus=1e3 * RELAXED)


@pytest.mark.parametrize("tolerance", [0.02, 0.01, 0.005])
def test_elastic_contact_keeps_its_word(tolerance):
    family = westergaard()
    results = family.solve(Mesh(), tolerance)
    assert max(result.contact_fraction_error for result in results) <= tolerance
    assert worst(family.area_errors(results)) <= tolerance


def test_finite_strain_contact_keeps_its_word():
    family = finite_strain()
    assert worst(family.area_errors(family.solve(Mesh(), 0.01))) <= 0.01


@pytest.mark.parametrize("every", [7, pytest.param(1, marks=pytest.mark.verification)])
def test_sliding_keeps_its_word(every):
    family = zener().every(every)
    results = family.solve(Mesh(), 0.01)
    assert worst(family.friction_errors(results)) <= 0.01
    # The table's own contact fractions are known to 0.001.
    assert worst(family.area_errors(results)) <= 0.011


def test_a_tolerance_out_of_reach_is_a_status():
    block = FiniteStrainBlock(Mesh(64, 12), 1e-6, settings={"finest_columns": 128})
    result = block.solve(WaveProblem(ELASTIC, Sine(1e-3, 1e-6), WaveLoad(1e3, 0.0)))
    assert result.status.startswith("tolerance not met")
    assert result.details["columns"] == 128


def test_the_mesh_is_no_finer_than_the_tolerance_asks():
    meshes = [
        gs.solve_scale(
            ELASTIC, wavelength=1e-3, amplitude=1e-6, pressure=1e4, speed=0.0, tolerance=tolerance
        ).details["columns"]
        for tolerance in (0.05, 0.003)
    ]
    assert meshes[0] <= 64 < meshes[1]
