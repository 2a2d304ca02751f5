"""Steady sliding of the finite-element block against independent small-strain models."""

import csv
from pathlib import Path

import numpy as np
import pytest

import gripscale as gs
from gripscale import theory

REFERENCE = Path(__file__).parents[1] / "reference" / "zener_sliding_half_plane.csv"
WAVELENGTH = 1e-3
AMPLITUDE = 1e-6
SPEED = 1.0
RELAXED = 3e6


def zener_rows():
    """Rows of the table with friction large enough for a relative statement, over its range."""
    with REFERENCE.open() as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    return [row for row in rows if row["mu_over_kDelta_n1024"] > 0.04]


def identify(row):
    return (
        f"E0/E={row['E_glassy_over_E_relaxed']:g} "
        f"p/p*={row['pbar_over_pstar_relaxed']:g} kvt={row['k_v_tau']:g}"
    )


def zener(row):
    wave_number = 2 * np.pi / WAVELENGTH
    material = gs.Rubber(
        equilibrium_modulus=RELAXED,
        moduli=[(row["E_glassy_over_E_relaxed"] - 1.0) * RELAXED],
        relaxation_times=[row["k_v_tau"] / (wave_number * SPEED)],
        bulk_modulus=1e4 * RELAXED,
    )
    # p*_relaxed = k A E_inf / (2 (1 - nu^2)) with nu = 1/2
    full = wave_number * AMPLITUDE * RELAXED / 1.5
    return gs.solve_scale(
        material,
        wavelength=WAVELENGTH,
        amplitude=AMPLITUDE,
        pressure=row["pbar_over_pstar_relaxed"] * full,
        speed=SPEED,
    )


def test_the_zener_rows_cover_the_table():
    rows = zener_rows()
    assert len(rows) >= 40
    assert {row["E_glassy_over_E_relaxed"] for row in rows} == {2.0, 10.0}
    assert len({row["pbar_over_pstar_relaxed"] for row in rows}) == 3
    assert max(row["k_v_tau"] for row in rows) >= 2.0 > 0.02 >= min(row["k_v_tau"] for row in rows)


@pytest.mark.parametrize("row", zener_rows(), ids=identify)
def test_zener_solid_slides_as_the_half_plane_table_says(row):
    result = zener(row)
    friction = result.friction / (2 * np.pi * AMPLITUDE / WAVELENGTH)
    assert result.status == "converged"
    assert friction == pytest.approx(row["mu_over_kDelta_n1024"], rel=0.02)
    assert result.contact_fraction == pytest.approx(row["contact_ratio_n1024"], abs=0.006)


@pytest.mark.parametrize("fraction_of_modulus", [0.002, 0.01, 0.05])
def test_real_rubber_at_small_slope_agrees_with_the_half_plane_model(fraction_of_modulus):
    """Many relaxation times at once: unfilled rubber, A/lambda = 0.01."""
    material = gs.rubber.styrene_butadiene(bulk_modulus=5e9)
    load = {"wavelength": 1e-4, "amplitude": 1e-6, "speed": 0.1}
    modulus = abs(material.complex_modulus(2 * np.pi * load["speed"] / load["wavelength"]))
    load["pressure"] = fraction_of_modulus * modulus
    block = gs.solve_scale(material, **load)
    plane = theory.solve_half_plane(material, **load)
    assert block.status == plane.status == "converged"
    # Finite slope (k A = 0.06) and the mesh are each worth about half a per cent.
    assert block.friction == pytest.approx(plane.friction, rel=0.02)
    assert block.contact_fraction == pytest.approx(plane.contact_fraction, abs=0.005)


def large_strain(load_time=1e-3, **options):
    return gs.solve_scale(
        gs.Rubber(RELAXED, [2 * RELAXED, 4 * RELAXED], [2e-5, 2e-4], bulk_modulus=1e9),
        wavelength=WAVELENGTH,
        amplitude=0.2 * WAVELENGTH,
        pressure=4e6,
        speed=SPEED,
        load_time=load_time,
        **options,
    )


def test_friction_is_the_energy_lost_at_large_strain():
    coarse = large_strain(columns=32, rows=8)
    fine = large_strain()
    assert fine.max_stretch > 1.4
    assert fine.friction_mismatch < 0.002
    assert fine.friction_mismatch < coarse.friction_mismatch


def test_a_short_load_time_keeps_the_mean_state_stiff():
    long, short = large_strain(), large_strain(load_time=1e-5)
    lean = [np.mean(r.deformed_mesh[0][0] - r.deformed_mesh[0][-1]) for r in (long, short)]
    # Friction drags the surface back against the lid, further if the mean state has relaxed.
    assert lean[0] < 1.5 * lean[1] < 0.0


def test_the_contact_moves_to_the_side_that_the_rubber_meets_first():
    """Rubber slides in +x, so it is pressed on the rising flank, x < 0."""
    result = large_strain()
    x = (result.x / WAVELENGTH + 0.5) % 1.0 - 0.5
    assert np.average(x, weights=result.pressure) < -0.01
    assert result.friction > 0.0


def test_units_do_not_matter():
    one = large_strain()
    scaled = gs.solve_scale(
        gs.Rubber(10 * RELAXED, [20 * RELAXED, 40 * RELAXED], [2e-3, 2e-2], bulk_modulus=1e10),
        wavelength=100 * WAVELENGTH,
        amplitude=20 * WAVELENGTH,
        pressure=4e7,
        speed=SPEED,
        load_time=0.1,
    )
    assert scaled.friction == pytest.approx(one.friction, rel=1e-9)
    assert scaled.contact_fraction == pytest.approx(one.contact_fraction, rel=1e-9)
