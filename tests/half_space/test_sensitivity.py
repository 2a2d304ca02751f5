"""Derivatives of the direct contact's friction against differences and closed forms."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.fft

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.half_space.active_set import Accuracy, solve_grid
from gripscale.half_space.grid_sequence import lost_by_harmonic
from gripscale.half_space.response import Response
from gripscale.half_space.sensitivity import (
    Bands,
    FrictionAdjoint,
    half_space_of,
    modulus_changes,
    scalar_changes,
)
from tests.half_space.rough_cases import AMPLITUDE, WAVELENGTH, isotropic_map, sine, solve
from tests.samples import SHIFTED_RUBBER, THERMAL, ZENER

STEP = 2.5e-3
"""Change of the logarithm of an input in a central difference. Its own error is of second order,
1e-4 of a derivative near one. Points that come into contact add what it measures beyond that."""


def line(points=16384, length=0.128, shortest=5e-4, seed=1):
    """A Gaussian line with largest waves of 8 mm, one period; by default of 16 of them."""
    x = np.arange(points) * length / points
    q = 2.0 * np.pi * np.fft.rfftfreq(points, length / points)
    size = np.where((q > 0.0) & (q <= 2.0 * np.pi / shortest), np.maximum(q, 785.0) ** -1.3, 0.0)
    z = np.fft.irfft(size * np.exp(2j * np.pi * np.random.default_rng(seed).random(q.size)), points)
    return gs.Profile(x, z * (3e-4 / z.std()))


SURFACES = {"line": line(), "map": isotropic_map(64, shortest=1.6e-3)}


@pytest.fixture(scope="module", params=SURFACES)
def contact(request):
    """A line of 16 largest waves, and a map, with 3 % and 8 % of contact."""
    shortest = {"line": 5e-4, "map": 1.6e-3}[request.param]
    arguments = {"smallest_wavelength": shortest, "tolerance": 0.005}
    return solve(SURFACES[request.param], rubber=SHIFTED_RUBBER, **arguments)


def again(contact, *, change=0.0, pressure=None, height=None):
    """Friction from dissipation on the same grid, ln M of each wave changed by `change`."""
    grid = contact.grid
    pressure = contact.nominal_pressure if pressure is None else pressure
    height = contact.height if height is None else height
    change = np.where(grid.own_opposite, np.real(change), change)
    compliance = half_space_of(contact).compliance(grid) * np.exp(-change)
    response = Response.with_compliance(compliance, grid, 1)
    start = contact.pressure * (pressure / contact.pressure.mean())
    solved = solve_grid(response, height, start, Accuracy(1e-9))
    return float(lost_by_harmonic(compliance, grid, solved.pressure).sum())


def difference(contact, change):
    """The derivative of ln mu along a change of ln M of each wave, from two more contacts."""
    high, low = (again(contact, change=sign * STEP * change) for sign in (1.0, -1.0))
    return float(np.log(high / low) / (2.0 * STEP))


@pytest.mark.parametrize("which", [0, 1], ids=["storage", "loss"])
def test_moduli_of_each_decade_as_differences(contact, which):
    data = gs.sensitivity(contact, bands_per_decade=1)
    bands, change = Bands.of(contact, 1), modulus_changes(contact)[which]
    name = ("d_ln_friction_d_ln_storage", "d_ln_friction_d_ln_loss")[which]
    measured = [
        difference(contact, np.where(bands.of_wave == band, change, 0.0))
        for band in range(bands.centre.size)
    ]
    # one per cent of the largest: of 40 random contacts the median is 0.3 % (tests/verification)
    assert data[name].values == pytest.approx(measured, abs=0.01 * np.abs(measured).max())
    assert np.abs(measured).max() > 0.1


def test_prony_terms_as_contacts_of_another_series(contact):
    """All terms together are all moduli together; one term is what another series does."""
    data = gs.sensitivity(contact)
    by_term = data.d_ln_friction_d_ln_modulus.values
    bands = data.d_ln_friction_d_ln_storage.sum() + data.d_ln_friction_d_ln_loss.sum()
    assert by_term.sum() == pytest.approx(float(bands), abs=1e-9)
    assert data.relaxation_time.values[1:].tolist() == contact.rubber.relaxation_times.tolist()
    strongest = int(np.abs(by_term[1:]).argmax())
    moduli = contact.rubber.moduli.copy()
    moduli[strongest] *= np.exp(2.0 * STEP)
    other = replace(contact, rubber=replace(contact.rubber, moduli=moduli))
    change = np.log(
        half_space_of(other).modulus(contact.grid) / half_space_of(contact).modulus(contact.grid)
    )
    expected = difference(contact, change / (2.0 * STEP))
    # the forward step of the series adds half its size
    assert by_term[1 + strongest] == pytest.approx(expected, abs=0.015)
    assert abs(expected) > 0.1


@pytest.mark.parametrize("name", ["ln_speed", "ln_bulk_modulus", "temperature"])
def test_numbers_as_differences(contact, name):
    data = gs.sensitivity(contact)
    change = scalar_changes(contact)[name]
    unit = float(np.abs(change).max())  # of a change in ln M as large as that of the moduli
    expected = unit * difference(contact, change / unit)
    assert float(data[f"d_ln_friction_d_{name}"]) == pytest.approx(expected, abs=0.01 * unit)


def test_speed_and_temperature_as_contacts_of_the_other_rubber(contact):
    """The changes of the moduli are those of the rubber itself at another speed, and warmer."""
    data = gs.sensitivity(contact)
    for name, step, other in (
        ("ln_speed", 0.01, half_space_of(contact, speed=contact.speed * np.exp(0.01))),
        ("temperature", 0.1, half_space_of(contact, warmer=0.1)),
    ):
        change = np.log(other.modulus(contact.grid) / half_space_of(contact).modulus(contact.grid))
        expected = np.log(again(contact, change=change) / again(contact)) / step
        derivative = float(data[f"d_ln_friction_d_{name}"])
        assert derivative == pytest.approx(expected, abs=0.01, rel=0.02)  # forward difference


def test_pressure_as_differences_and_as_all_moduli_together(contact):
    data = gs.sensitivity(contact)
    high, low = (
        again(contact, pressure=contact.nominal_pressure * np.exp(sign * STEP))
        for sign in (1.0, -1.0)
    )
    derivative = float(data.d_ln_friction_d_ln_pressure)
    assert derivative == pytest.approx(np.log(high / low) / (2.0 * STEP), abs=0.01)
    # without a modulus of its own the contact only knows p_0 / M
    moduli = data.d_ln_friction_d_ln_storage.sum() + data.d_ln_friction_d_ln_loss.sum()
    together = float(moduli + data.d_ln_friction_d_ln_bulk_modulus)
    assert together == pytest.approx(-derivative, abs=1e-6)


def test_heights_as_differences(contact):
    """A change of 0.1 um by waves like those of the surface, and a bump under the most pressure."""
    by_height, grid = FrictionAdjoint.of(contact).by_height, contact.grid
    waves = (grid.wavenumber > 0.0) & (grid.wavenumber <= 2.0 * np.pi / contact.smallest_wavelength)
    noise = np.random.default_rng(2).standard_normal(grid.shape)
    random = scipy.fft.irfftn(scipy.fft.rfftn(noise) * waves, s=grid.shape)
    highest = np.unravel_index(np.argmax(contact.pressure), grid.shape)
    away = [
        (np.arange(n) - at + n // 2) % n - n // 2 for n, at in zip(grid.shape, highest, strict=True)
    ]
    distance = sum(np.square(axis) for axis in np.meshgrid(*away, indexing="ij"))
    for change in (random / random.std(), np.exp(-distance / 8.0)):
        high, low = (
            again(contact, height=contact.height + sign * 1e-7 * change) for sign in (1.0, -1.0)
        )
        expected = (high - low) / 2e-7
        assert float((by_height * change).sum()) == pytest.approx(expected, rel=0.01)
    assert gs.sensitivity(contact).d_friction_d_height.values == pytest.approx(by_height)


def test_full_contact_of_a_sine_in_closed_form():
    """With p = M q h / 2 the friction is Im M (q A)^2 / (4 p_0): LW, and Johnson sec. 13.2."""
    contact = solve(sine(), pressure=5e6, speed=0.05)
    assert contact.full_contact
    data = gs.sensitivity(contact)
    assert float(data.d_ln_friction_d_ln_pressure) == pytest.approx(-1.0, abs=1e-6)
    rubber = ZENER
    omega = 2.0 * np.pi * contact.speed / WAVELENGTH
    modulus = rubber.plane_strain_modulus(omega)
    expected = modulus.imag * (2.0 * np.pi / WAVELENGTH * AMPLITUDE) ** 2 / (4.0 * 5e6)
    assert contact.friction_from_dissipation == pytest.approx(expected, rel=1e-9)
    storage, loss = (change[1] for change in modulus_changes(contact))
    for name, change in (("storage", storage), ("loss", loss)):
        derivative = float(data[f"d_ln_friction_d_ln_{name}"].sum())
        assert derivative == pytest.approx((modulus * change).imag / modulus.imag, abs=1e-6)


def test_contact_fraction_of_a_sine_in_closed_form():
    """A/A_0 = (2/pi) arcsin(sqrt(p_0/p*)): H. M. Westergaard, J. Appl. Mech. 6 (1939) A49."""
    elastic = gs.Rubber(3e6, [1e3], [1e-3])  # loses just enough to have a friction
    full = np.pi * elastic.plane_strain_modulus(0.0).real * AMPLITUDE / WAVELENGTH
    contact = solve(sine(512), rubber=elastic, pressure=0.3 * full, tolerance=0.005)
    data = gs.sensitivity(contact, contact_fraction=True)
    angle = np.arcsin(np.sqrt(0.3))
    expected = 0.5 * np.tan(angle) / angle
    # a central difference over 2 x 0.2 in ln p_0 is 2 % larger than the derivative
    assert float(data.d_ln_contact_fraction_d_ln_pressure) == pytest.approx(expected, rel=0.03)
    moduli = data.d_ln_contact_fraction_d_ln_storage.sum()
    assert float(moduli) == pytest.approx(-expected, rel=0.06)


def test_settled_rubber_under_heat():
    """Under heat the derivatives are those with the temperature of each scale kept."""
    conditions = Conditions(heat=THERMAL)
    arguments = {"conditions": conditions, "footprint": 0.05, "speed": 3.0, "tolerance": 0.005}
    contact = solve(line(4096, 0.032), rubber=SHIFTED_RUBBER, **arguments)
    data = gs.sensitivity(contact)
    assert data.settled == 1
    for name in ("ln_speed", "temperature"):
        change = scalar_changes(contact)[name]
        unit = float(np.abs(change).max())
        expected = unit * difference(contact, change / unit)
        assert float(data[f"d_ln_friction_d_{name}"]) == pytest.approx(expected, abs=0.02 * unit)


def test_bands_add_up_whatever_their_width(contact):
    coarse, fine = (gs.sensitivity(contact, bands_per_decade=number) for number in (1, 7))
    for name in ("d_ln_friction_d_ln_storage", "d_ln_friction_d_ln_loss"):
        assert float(fine[name].sum()) == pytest.approx(float(coarse[name].sum()), rel=1e-12)
    assert fine.frequency.size > 3 * coarse.frequency.size


@pytest.mark.parametrize(
    ("arguments", "message"),
    [({"speed": 0.0}, "got speed 0 m/s"), ({"rubber": gs.Rubber(3e6)}, "friction above zero")],
)
def test_refuses_contact_without_friction(arguments, message):
    with pytest.raises(gs.InputError, match=message):
        gs.sensitivity(solve(sine(64), tolerance=None, **arguments))


def test_refuses_anything_else():
    with pytest.raises(gs.InputError, match="RoughContact"):
        gs.sensitivity("contact")
    with pytest.raises(gs.InputError, match="bands_per_decade"):
        gs.sensitivity(solve(sine(64), tolerance=None), bands_per_decade=0)
