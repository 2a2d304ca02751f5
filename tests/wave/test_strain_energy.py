"""Each coefficient of a strain energy acts as its energy says, all through `solve_scale`.

Under dead load the potential energy per wavelength is Pi = U - P lambda d, stationary in the
displacements, with the mean pressure P and the indentation d. For W = W_0 + c w therefore

    dd/dc = -(1/lambda) d/dP int w dA        (from d2 Pi / dc dP, at the solution for W_0)

Left: two solutions with the coefficient changed. Right: w at the Gauss points of neo-Hookean
solutions, from the deformed meshes, for two pressures. Nothing but the mesh is common to both.
"""

from dataclasses import fields

import numpy as np
import pytest

import gripscale as gs
from gripscale import _kernel
from gripscale.rubber import Isihara, MooneyRivlin, Yeoh
from gripscale.rubber.strain_energy import STRAIN_ENERGIES

MODULUS, WAVELENGTH = 3e6, 1e-2
SHEAR = MODULUS / 3.0
WAVE = {"wavelength": WAVELENGTH, "amplitude": 2e-3, "speed": 0.0, "columns": 64, "rows": 12}
PRESSURE = 0.5e6


def solved(energy, pressure=PRESSURE):
    rubber = gs.Rubber(MODULUS, bulk_modulus=2e8, strain_energy=energy)
    result = gs.solve_scale(rubber, pressure=pressure, residual_tolerance=1e-11, **WAVE)
    assert result.converged
    return result


def invariants(result, rest):
    """Return both invariants of Cbar less 3, and the areas, at the 2 x 2 Gauss points."""
    assert result.deformed_mesh is not None
    width = WAVELENGTH / WAVE["columns"]
    height = np.diff(rest.deformed_mesh[1][:, 0])[:, None]
    first, second, area = [], [], []
    for eta in (0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5):
        for xi in (0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5):
            gradient = []
            for part in result.deformed_mesh:
                low, high = part[:-1], part[1:]
                along = (1 - eta) * np.diff(low, axis=1) + eta * np.diff(high, axis=1)
                rise = high - low
                across = (1 - xi) * rise[:, :-1] + xi * rise[:, 1:]
                gradient.append((along / width, across / height))
            (a, b), (c, d) = gradient
            volume = a * d - b * c
            trace = a**2 + b**2 + c**2 + d**2 + 1.0
            first.append(trace * volume ** (-2 / 3) - 3.0)
            # I2 = tr(C^-1) det C, with C33 = 1.
            second.append((a**2 + b**2 + c**2 + d**2 + volume**2) * volume ** (-4 / 3) - 3.0)
            area.append(np.broadcast_to(0.25 * width * height, a.shape))
    return np.array([first, second]), np.array(area)


@pytest.mark.parametrize(
    ("energy", "density"),
    [
        (lambda c: Yeoh(c, 0.0), lambda i1, i2: i1**2),
        (lambda c: Yeoh(0.0, c), lambda i1, i2: i1**3),
        (lambda c: MooneyRivlin(0.02 + c), lambda i1, i2: i2 - i1),
        (lambda c: Isihara(0.02 + c, 0.0), lambda i1, i2: i2 - i1),
        (lambda c: Isihara(0.0, c), lambda i1, i2: i1**2),
    ],
    ids=["yeoh second", "yeoh third", "mooney_rivlin share", "isihara share", "isihara second"],
)
def test_coefficient_changes_the_indentation_as_its_energy_says(energy, density):
    step, change = 0.02 * PRESSURE, 0.005
    rest = gs.solve_scale(
        gs.Rubber(MODULUS, bulk_modulus=2e8),
        pressure=100.0,  # full contact
        **{**WAVE, "amplitude": 1e-6 * WAVELENGTH},
    )
    depth = [solved(energy(sign * change)).details["indentation"] for sign in (-1.0, 1.0)]
    felt = (depth[1] - depth[0]) / (2.0 * change)
    stored = []
    for sign in (-1.0, 1.0):
        (i1, i2), area = invariants(solved(energy(0.0), PRESSURE + sign * step), rest)
        stored.append(float((0.5 * SHEAR * density(i1, i2) * area).sum()))
    said = -(stored[1] - stored[0]) / (2.0 * step) / WAVELENGTH
    # Both differences are of second order, a few 1e-4; the active set's jumps add a few 1e-3.
    assert felt == pytest.approx(said, rel=0.01)


def test_kernel_and_package_list_the_same_energies():
    ours = {kind: [f.name for f in fields(law)] for kind, law in STRAIN_ENERGIES.items()}
    assert _kernel.strain_energies() == ours
