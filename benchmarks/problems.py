"""The waves that are solved: elastic, Zener solid, real tread rubber at large strain."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import numpy as np
from measure import Mesh

import gripscale as gs
from gripscale import theory

ROOT = Path(__file__).parents[1]
WAVELENGTH = 1e-3
RELAXED = 3e6
SPEED = 1.0

WESTERGAARD_RATIOS = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]

FINITE_STRAIN = {0.1: 0.20589, 0.3: 0.37276, 0.5: 0.50448, 0.7: 0.63081, 0.9: 0.77240}
"""p/(4 pi G A/lambda): contact fraction at A/lambda = 0.1, K/G = 1000, depth one wavelength,
converged with three other finite-element codes to 0.0002."""

DEFAULT: Mesh = (128, 20, 1)


def options(mesh: Mesh) -> dict[str, int]:
    """Return the mesh as keyword arguments of `solve_scale`."""
    return dict(zip(("columns", "rows", "element_order"), mesh, strict=True))


def westergaard(ratio: float, mesh: Mesh) -> gs.ScaleResult:
    """Press an elastic block on a wave of small slope with `ratio` of the full-contact pressure."""
    material = gs.Rubber(RELAXED, bulk_modulus=1e3 * RELAXED)
    amplitude = 1e-3 * WAVELENGTH
    full = theory.full_contact_pressure(
        material.plane_strain_modulus(1.0).real, wavelength=WAVELENGTH, amplitude=amplitude
    )
    return gs.solve_scale(
        material,
        wavelength=WAVELENGTH,
        amplitude=amplitude,
        pressure=ratio * full,
        speed=0.0,
        **options(mesh),
    )


def finite_strain(ratio: float, mesh: Mesh) -> gs.ScaleResult:
    """Press an elastic block on a wave of A/lambda = 0.1."""
    shear = RELAXED / 3.0
    return gs.solve_scale(
        gs.Rubber(RELAXED, bulk_modulus=1e3 * shear),
        wavelength=WAVELENGTH,
        amplitude=0.1 * WAVELENGTH,
        pressure=ratio * 4.0 * np.pi * shear * 0.1,
        speed=0.0,
        depth=1.0,
        **options(mesh),
    )


Row = dict[str, float]


@cache
def zener_table() -> list[Row]:
    """Return the rows of the reference table."""
    path = ROOT / "tests" / "reference" / "zener_sliding_half_plane.csv"
    with path.open() as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def zener_rows() -> list[Row]:
    """Return the rows with friction enough for a relative statement, mu/(kA) > 0.04."""
    return [row for row in zener_table() if row["mu_over_kDelta_n1024"] > 0.04]


ZENER_AMPLITUDE = 1e-3 * WAVELENGTH
ZENER_SLOPE = 2.0 * np.pi * ZENER_AMPLITUDE / WAVELENGTH


def zener_load(row: Row) -> dict[str, object]:
    """Return rubber and load of one row, for `solve_scale` or `solve_half_plane`."""
    wave_number = 2.0 * np.pi / WAVELENGTH
    return {
        "rubber": gs.Rubber(
            RELAXED,
            [(row["E_glassy_over_E_relaxed"] - 1.0) * RELAXED],
            [row["k_v_tau"] / (wave_number * SPEED)],
            bulk_modulus=1e4 * RELAXED,
        ),
        "wavelength": WAVELENGTH,
        "amplitude": ZENER_AMPLITUDE,
        "pressure": row["pbar_over_pstar_relaxed"] * ZENER_SLOPE * RELAXED / 1.5,
        "speed": SPEED,
    }


def zener(row: Row, mesh: Mesh) -> gs.ScaleResult:
    """Slide a Zener solid over a wave of small slope."""
    return gs.solve_scale(**zener_load(row), **options(mesh))


@cache
def tread() -> gs.Rubber:
    """Return the measured tread rubber of the shipped case."""
    master = gs.read_master_curve(
        ROOT / "examples" / "data" / "rubber" / "measured_dma.txt", reference_temperature=293.15
    )
    return gs.fit_prony(master)


LARGE_STRAIN_PRESSURES = [2e6, 3.5e6, 5e6, 7e6, 9e6]


def large_strain(pressure: float, mesh: Mesh) -> gs.ScaleResult:
    """Slide tread rubber over a steep wave, A/lambda = 0.16: stretches 0.6 to 1.6 at 9 MPa."""
    return gs.solve_scale(
        tread(),
        wavelength=WAVELENGTH,
        amplitude=0.16 * WAVELENGTH,
        pressure=pressure,
        speed=0.3,
        load_time=5e-3,
        **options(mesh),
    )
