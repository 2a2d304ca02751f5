"""The direct contact against closed forms, a reference table, the half-plane model and Tamaas."""

import csv

import numpy as np
import pytest
import scipy.fft

import gripscale as gs
from gripscale.surface import HeightMap, Profile
from gripscale.theory import full_contact_pressure, plane_strain_modulus, solve_half_plane
from tests.closed_forms import contact_fraction
from tests.samples import ROOT

from .rough_cases import (
    AMPLITUDE,
    RELAXED,
    SLOPE,
    TIME,
    WAVELENGTH,
    ZENER,
    grooves,
    isotropic_heights,
    isotropic_map,
    on_grid,
    sine,
    solve,
)

REFERENCE = ROOT / "tests" / "reference"
FULL = full_contact_pressure(
    plane_strain_modulus(RELAXED, 0.5), wavelength=WAVELENGTH, amplitude=AMPLITUDE
)


def table(name):
    with (REFERENCE / name).open() as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


@pytest.mark.parametrize("load", [0.02, 0.1, 0.3, 0.5, 0.8, 0.97])
@pytest.mark.parametrize("kind", ["line", "map along x", "map along y"])
def test_standing_still_is_westergaard(kind, load):
    """The estimated error is asked to be 0.003, and so is the true one; friction: rounding."""
    fraction = float(contact_fraction(load))
    surface = sine() if kind == "line" else grooves(kind[-1])
    rubber = gs.Rubber(RELAXED, bulk_modulus=1e12)
    found = solve(
        surface,
        rubber=rubber,
        pressure=load * FULL,
        speed=0.0,
        smallest_wavelength=WAVELENGTH / 64,
        tolerance=0.003 / fraction,
    )
    assert found.converged
    assert found.contact_fraction == pytest.approx(fraction, abs=0.003)
    assert abs(found.friction) < 1e-6 * SLOPE
    assert found.friction_from_dissipation == 0.0


@pytest.mark.parametrize("row", table("zener_sliding_half_plane.csv")[::9])
def test_reference_table_of_the_zener_half_plane(row):
    """Friction to 0.5 % and the table's own error, the difference of its two grids; fraction to
    0.003."""
    stiffening, load, phase = list(row.values())[:3]
    found = solve(
        sine(),
        rubber=gs.Rubber(RELAXED, [RELAXED * (stiffening - 1)], [TIME], bulk_modulus=1e12),
        pressure=load * FULL,
        speed=phase * WAVELENGTH / (2 * np.pi * TIME),
        smallest_wavelength=WAVELENGTH / 64,
        tolerance=0.003,
    )
    expected = row["mu_over_kDelta_n1024"]
    allowed = 0.005 * expected + abs(expected - row["mu_over_kDelta_n512"])
    assert found.converged
    assert found.friction / SLOPE == pytest.approx(expected, abs=allowed)
    assert found.contact_fraction == pytest.approx(row["contact_ratio_n1024"], abs=0.003)


@pytest.mark.parametrize("along", ["x", "y"])
def test_a_map_of_one_sine_slides_like_the_line_or_not_at_all(along):
    """The same grid along x, so the same equations: equal to what the linear solver leaves."""
    line = on_grid(ZENER, sine(), pressure=1e4, speed=0.3, shape=(128,), shortest=WAVELENGTH / 4)
    surface = grooves(along)
    found = on_grid(
        ZENER, surface, pressure=1e4, speed=0.3, shape=(128, 128), shortest=WAVELENGTH / 4
    )
    friction = line.record.friction if along == "x" else 0.0
    assert line.record.friction > 0.04 * SLOPE
    assert found.record.friction == pytest.approx(friction, abs=1e-5 * SLOPE)


def test_a_line_of_one_sine_is_the_half_plane_model():
    """Twelve Maxwell terms over twelve decades; the half-plane model has its own discretisation
    (1024 hats, Fourier-exact), good to some 1e-4."""
    rubber = gs.Rubber(3e6, np.geomspace(1e6, 4e8, 12), np.geomspace(1e1, 1e-11, 12))
    wave = {"pressure": 2e4, "speed": 0.3}
    expected = solve_half_plane(rubber, wavelength=WAVELENGTH, amplitude=AMPLITUDE, **wave)
    found = solve(sine(), rubber=rubber, tolerance=2e-3, **wave)
    assert 0.05 < expected.contact_fraction < 0.5
    assert found.friction == pytest.approx(expected.friction, rel=0.005)
    assert found.contact_fraction == pytest.approx(expected.contact_fraction, abs=0.003)


@pytest.mark.parametrize("kind", ["line", "map"])
def test_full_contact_is_the_closed_form(kind):
    """p_q = h_q/K_q, mu = sum of q_x |q| Im M |h_q|^2 / 2 p_0: exact on any grid."""
    surface = isotropic_map(64, shortest=1.6e-3)
    z = surface.z if kind == "map" else surface.z[:, 0]
    x = surface.x
    surface = surface if kind == "map" else Profile(x, z)
    load, speed = 5e8, 0.3
    found = solve(surface, pressure=load, speed=speed)
    assert found.full_contact
    assert found.contact_fraction == 1.0
    assert found.converged
    spectrum = scipy.fft.fftn(z) / z.size
    numbers = 2 * np.pi * scipy.fft.fftfreq(64, x[1] - x[0])
    along = numbers if kind == "line" else numbers[:, None]
    across = 0.0 if kind == "line" else numbers[None, :]
    loss = ZENER.plane_strain_modulus(along * speed).imag
    expected = np.sum(along * np.hypot(along, across) * loss * np.abs(spectrum) ** 2) / (2 * load)
    assert found.friction == pytest.approx(expected, rel=1e-6)
    assert found.friction_from_dissipation == pytest.approx(expected, rel=1e-6)
    assert found.friction_error == found.contact_fraction_error == 0.0


@pytest.mark.parametrize("row", table("tamaas_elastic_map.csv"), ids=lambda r: f"{r['pressure']:g}")
def test_elastic_map_is_that_of_tamaas(row):
    """The same discrete problem: the same points touch, pressures to the tolerances of the two
    (1e-6 here) as the stiffest wave magnifies them, measured 6e-5 of the nominal pressure."""
    found = on_grid(
        gs.Rubber(6e6),
        isotropic_map(),
        pressure=row["pressure"],
        speed=0.0,
        shape=(128, 128),
        shortest=None,
    ).contact
    assert found.settled
    assert found.active.sum() == row["points_in_contact"]
    assert found.pressure.max() == pytest.approx(row["largest"], abs=2e-4 * row["pressure"])
    pressures = found.pressure[::32, ::32].ravel()
    expected = [row[f"at_{i}"] for i in range(16)]
    np.testing.assert_allclose(pressures, expected, atol=2e-4 * row["pressure"])


def test_the_map_of_the_reference_is_the_one_it_was_computed_for():
    z = isotropic_heights()
    assert z[0, 0] == pytest.approx(table("tamaas_elastic_map.csv")[0]["first_height"], rel=1e-9)
    assert HeightMap(np.arange(128.0), np.arange(128.0), z).missing == 0
