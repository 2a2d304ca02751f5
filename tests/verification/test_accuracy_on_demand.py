"""A tolerance keeps its word on the reference cases, and the error estimate covers the error."""

import csv
from pathlib import Path

import numpy as np
import pytest

import gripscale as gs
from gripscale import theory

REFERENCE = Path(__file__).parents[1] / "reference" / "zener_sliding_half_plane.csv"
WAVELENGTH = 1e-3
ELASTIC = gs.Rubber(3e6, bulk_modulus=3e9)


@pytest.mark.parametrize("tolerance", [0.02, 0.01, 0.005])
@pytest.mark.parametrize("ratio", [0.1, 0.4, 0.8])
def test_elastic_contact_keeps_its_word(ratio, tolerance):
    amplitude = 1e-6
    full = theory.full_contact_pressure(
        ELASTIC.plane_strain_modulus(1.0).real, wavelength=WAVELENGTH, amplitude=amplitude
    )
    result = gs.solve_scale(
        ELASTIC,
        wavelength=WAVELENGTH,
        amplitude=amplitude,
        pressure=ratio * full,
        speed=0.0,
        tolerance=tolerance,
    )
    assert result.converged
    assert result.contact_fraction_error <= tolerance
    assert abs(result.contact_fraction - theory.contact_fraction(ratio)) <= tolerance


@pytest.mark.parametrize(("ratio", "fraction"), [(0.1, 0.20589), (0.5, 0.50448), (0.9, 0.77240)])
def test_finite_strain_contact_keeps_its_word(ratio, fraction):
    result = gs.solve_scale(
        gs.Rubber(3e6, bulk_modulus=1e9),
        wavelength=WAVELENGTH,
        amplitude=0.1 * WAVELENGTH,
        pressure=ratio * 4 * np.pi * 1e6 * 0.1,
        speed=0.0,
        depth=1.0,
        tolerance=0.01,
    )
    assert result.converged
    assert abs(result.contact_fraction - fraction) <= 0.01


def zener_rows():
    with REFERENCE.open() as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return [row for row in rows if row["mu_over_kDelta_n1024"] > 0.04][::3]


@pytest.mark.parametrize("row", zener_rows())
def test_sliding_keeps_its_word(row):
    relaxed, speed, amplitude = 3e6, 1.0, 1e-6
    wave_number = 2 * np.pi / WAVELENGTH
    result = gs.solve_scale(
        gs.Rubber(
            relaxed,
            [(row["E_glassy_over_E_relaxed"] - 1.0) * relaxed],
            [row["k_v_tau"] / (wave_number * speed)],
            bulk_modulus=1e4 * relaxed,
        ),
        wavelength=WAVELENGTH,
        amplitude=amplitude,
        pressure=row["pbar_over_pstar_relaxed"] * wave_number * amplitude * relaxed / 1.5,
        speed=speed,
        tolerance=0.01,
    )
    friction = result.friction / (wave_number * amplitude)
    assert result.converged
    assert friction == pytest.approx(row["mu_over_kDelta_n1024"], rel=0.01)
    # The table's own contact fractions are known to 0.001.
    assert abs(result.contact_fraction - row["contact_ratio_n1024"]) <= 0.011


def test_a_tolerance_out_of_reach_is_a_status():
    result = gs.solve_scale(
        ELASTIC, wavelength=1e-3, amplitude=1e-6, pressure=1e3, speed=0.0, tolerance=1e-6
    )
    assert result.status.startswith("tolerance not met")
    assert result.details["columns"] == 512


def test_the_mesh_is_no_finer_than_the_tolerance_asks():
    meshes = [
        gs.solve_scale(
            ELASTIC, wavelength=1e-3, amplitude=1e-6, pressure=1e4, speed=0.0, tolerance=tolerance
        ).details["columns"]
        for tolerance in (0.05, 0.003)
    ]
    assert meshes[0] <= 64 < meshes[1]
