"""Persson against exact limits, closed forms of his integrals, and himself."""

import importlib
from functools import partial

import numpy as np
import pytest
from scipy import special

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.core.errors import InputError
from gripscale.model import Load, Model
from gripscale.rubber import Rubber, styrene_butadiene
from gripscale.surface import (
    ArealSpectrum,
    ProfileSpectrum,
    SineStack,
    Surface,
    areal_spectrum,
    profile_spectrum,
    self_affine_profile,
)
from gripscale.surface.surface import Measured
from gripscale.theory import Persson, full_contact_friction, persson

module = importlib.import_module("gripscale.theory.persson")

RELAXED, STIFF, TIME = 3e6, 27e6, 1e-3
ELASTIC = Rubber(RELAXED, bulk_modulus=1e13)
ZENER = Rubber(RELAXED, [STIFF], [TIME], bulk_modulus=1e13)
Q0, Q1 = 1e2, 1e5
LEVEL = 1e-6
HALF = ArealSpectrum([Q0, Q1], [LEVEL * Q0**-3, LEVEL * Q1**-3])
"""H = 1/2: q^3 C is the same everywhere, and so is its interpolation."""

QUADRATURE = 1e-4 / 3
"""The last doubling changed less than 1e-4; a rule of second order is then off by a third of it."""


def road(points: int = 8192) -> Surface:
    step = 5e-5
    line = self_affine_profile(0.8, 5e-3, 1e-3, (points - 1) * step, step, seed=4)
    return Surface(
        SineStack([10e-3, 1e-3], [1e-3, 1e-4]), "", measured=Measured([(line, line)], [], None, "")
    )


@pytest.mark.parametrize("rubber", [ELASTIC, ZENER])
def test_light_static_contact(rubber):
    """A/A_0 = sqrt(8/pi) p/(M h'), the relaxed rubber at rest; erf is linear to x^2/3 = 3e-5."""
    stiffness = RELAXED * 4 / 3 * HALF.rms_gradient()
    for load in (1e-4, 1e-3, 7e-3):
        found = persson(rubber, HALF, pressure=load * stiffness, speed=0.0)
        assert found.converged
        linear = np.sqrt(8 / np.pi) * load
        assert found.contact_fraction == pytest.approx(linear, rel=5e-5 + QUADRATURE)
        assert found.friction == found.friction_error == 0.0


POINTS = ArealSpectrum(np.geomspace(Q0, Q1, 31), LEVEL * np.geomspace(Q0, Q1, 31) ** -3)


def test_static_contact_at_any_load_is_the_error_function():
    """P = erf(sqrt(2) p/(M h')), and down to each wavelength with the gradient so far."""
    pressure = 0.4 * RELAXED * 4 / 3 * HALF.rms_gradient()
    found = persson(ELASTIC, POINTS, pressure=pressure, speed=3.0)
    for wavelength, area in zip(found.wavelength, found.running_contact_fraction, strict=True):
        if wavelength < found.wavelength[0]:
            gradient = POINTS.rms_gradient(wavelength)
            expected = special.erf(np.sqrt(2) * pressure / (RELAXED * 4 / 3 * gradient))
            assert area == pytest.approx(expected, rel=1e-4)
    assert found.running_contact_fraction[0] == 1.0
    assert found.friction == 0.0, "at any speed: nothing is lost"


@pytest.mark.parametrize("speed", [1e-4, 0.03, 30.0])
def test_full_contact_friction_in_closed_form(speed):
    """With M'' = 4/3 E a c/(1 + a^2 c^2), a = q v tau, c = cos(phi):

    int c M'' dphi = 4/3 E (2 pi/a) (1 - 1/sqrt(1 + a^2)),
    mu = 1/2 int q^3 C dq int c M'' dphi / p = 4/3 pi E C_0/(p v tau) [ln a + asinh(1/a)].
    """
    pressure = 1e9
    found = persson(ZENER, HALF, pressure=pressure, speed=speed)
    assert found.contact_fraction > 1 - 1e-9
    first, last = (q * speed * TIME for q in (Q0, Q1))
    steps = np.log(last / first) + np.arcsinh(1 / last) - np.arcsinh(1 / first)
    expected = 4 / 3 * np.pi * STIFF * LEVEL / (pressure * speed * TIME) * steps
    assert found.converged
    assert found.friction == pytest.approx(expected, rel=QUADRATURE, abs=0)


def test_full_contact_is_the_sum_over_single_waves():
    """A narrow ring of waves, each with the closed form of full contact along its own direction.

    A wave at phi is met at the speed v cos(phi) and opposes the sliding by cos(phi) of its force.
    The ring is 1e-4 wide: as much as friction changes across it."""
    q, pressure, speed, rubber = 3e3, 1e10, 0.5, styrene_butadiene()
    ring = ArealSpectrum([q, q * (1 + 1e-4)], [1e-16, 1e-16])
    found = persson(rubber, ring, pressure=pressure, speed=speed)
    angles = (np.arange(20_000) + 0.5) * np.pi / 40_000
    amplitude = np.sqrt(2) * ring.rms_height
    each = [
        np.cos(angle)
        * full_contact_friction(
            complex(rubber.plane_strain_modulus(q * speed * np.cos(angle))),
            wavelength=2 * np.pi / q,
            amplitude=amplitude,
            pressure=pressure,
        )
        for angle in angles[::10]
    ]
    assert found.friction == pytest.approx(np.mean(each), rel=3e-4, abs=0)


def test_each_wavelength_so_far_is_a_result_of_its_own():
    """Down to a cut-off in full, and with a Gaussian at it: each a surface of its own."""
    load = {"pressure": 1e5, "speed": 0.1}
    found = persson(ZENER, POINTS, **load)
    for at in (10, 20):
        ended = POINTS.wavenumber <= 2.0 * np.pi / found.wavelength[at] * (1.0 + 1e-9)
        end = ArealSpectrum(POINTS.wavenumber[ended], POINTS.density[ended])
        shorter = persson(ZENER, end, **load)
        assert shorter.friction == pytest.approx(found.running_friction[at], rel=2 * QUADRATURE)
    found = persson(ZENER, POINTS, smallest_wavelength=2 * np.pi / Q1, **load)
    for at in (10, 20):
        shorter = persson(ZENER, POINTS, smallest_wavelength=found.wavelength[at], **load)
        assert shorter.friction == pytest.approx(found.running_friction[at], rel=2 * QUADRATURE)
        assert shorter.contact_fraction == pytest.approx(
            found.running_contact_fraction[at], rel=2 * QUADRATURE
        )
        assert shorter.wavelength[-1] == pytest.approx(found.wavelength[at])


def test_the_factor_of_small_contacts_is_linear_in_gamma():
    """S = gamma + (1 - gamma) P^2: at light load nothing but gamma is left."""
    none, half, all_ = (
        persson(ZENER, HALF, pressure=1e4, speed=0.1, gamma=g).friction for g in (0.0, 0.5, 1.0)
    )
    assert half == pytest.approx(0.5 * (none + all_), rel=2 * QUADRATURE)
    assert none < 0.01 * all_


def test_light_contact_of_a_slightly_lossy_rubber():
    """Slow sliding, gamma = 1, P = sqrt(8/pi) p/(M h'(q)), h'(q)^2 = 2 pi C_0 (q - q_0):

    mu = 1/2 int C_0 P pi M_1 tau v q/p dq
       = 2 M_1 tau v/M sqrt(C_0) [(q - q_0)^(3/2)/3 + q_0 (q - q_0)^(1/2)]_(q_1)

    at any load. Left out: (q v tau)^2 = 1e-6, full contact near q_0, (q_0/q_1)^(3/2) = 3e-5."""
    speed = 1e-3 / (Q1 * TIME)
    load = 1e-3 * RELAXED * 4 / 3 * HALF.rms_gradient()
    over = Q1 - Q0
    steps = 2 * (over**1.5 / 3 + Q0 * over**0.5)
    expected = STIFF / RELAXED * TIME * speed * np.sqrt(LEVEL) * steps
    for pressure in (load, 0.1 * load):
        found = persson(ZENER, HALF, pressure=pressure, speed=speed, gamma=1.0)
        assert found.friction == pytest.approx(expected, rel=2 * QUADRATURE, abs=0)


def test_the_quadrature_converges_at_second_order():
    """A rubber of many decades on a spectrum with a bend: doubling cuts the error by four."""
    q = np.geomspace(Q0, Q1, 16)
    bent = ArealSpectrum(q, 1e-13 / (1 + (q / 1e3) ** 2) ** 1.8)
    load = Load(1e5, 0.3, 0.1)
    rubber = styrene_butadiene()
    integrals = partial(module.integrals, rubber, Conditions(), bent, load, 0.5, q, None)
    fine = integrals(256)
    for which in (0, 1):
        errors = [abs(integrals(n)[which][-1] / fine[which][-1] - 1) for n in (4, 8, 16, 32)]
        rates = np.log2(np.array(errors[:-1]) / errors[1:])
        assert (np.abs(rates - 2.0) < 0.15).all(), (errors, rates)
    found = persson(styrene_butadiene(), bent, pressure=1e5, speed=0.3)
    assert found.converged
    assert abs(found.friction - fine[1][-1]) < found.friction_error
    assert abs(found.contact_fraction - fine[0][-1]) < found.contact_fraction_error


@pytest.mark.parametrize("frequency", [1e-3, 1.0, 1e6])
def test_integrals_over_the_angle(frequency):
    """Closed forms of a Zener solid; 16 Gauss points a quarter turn hold nine decades."""
    load = Load(1.0, 1.0, 1.0)
    real, imaginary, lossy = module.over_angles(ZENER, load, np.array([frequency / TIME]), 4)
    root = np.sqrt(1 + frequency**2)
    low, high = RELAXED * 4 / 3, STIFF * 4 / 3
    gain = 1 - 1 / root  # mean of a^2 c^2/(1 + a^2 c^2), the stiffening part
    assert lossy[0] == pytest.approx(high * 2 * np.pi / frequency * gain, rel=1e-5)
    # |M|^2 = low^2 + (2 low high + high^2) a^2 c^2/(1 + a^2 c^2)
    expected = 2 * np.pi * (low**2 + (2 * low + high) * high * gain)
    assert real[0] + imaginary[0] == pytest.approx(expected, rel=1e-5)


def test_not_converging_is_a_status_and_no_number(monkeypatch):
    monkeypatch.setattr(module, "_FINEST", 8)
    found = persson(ZENER, HALF, pressure=1e5, speed=0.1)
    assert found.status == "tolerance not met"
    assert not found.converged
    data = found.to_dataset()
    assert np.isnan(data.total_friction)
    assert np.isnan(data.total_contact_fraction)
    assert data.prediction_status.item() == "tolerance not met"


def test_a_line_stands_for_an_isotropic_surface():
    q = np.geomspace(Q0, Q1, 31)
    lines = ProfileSpectrum(q, 1e-7 * q**-2.6)
    found = persson(ZENER, lines, pressure=1e5, speed=0.1)
    surface = areal_spectrum(lines)
    assert found.friction == persson(ZENER, surface, pressure=1e5, speed=0.1).friction
    assert found.rms_gradient == surface.rms_gradient()
    assert found.rms_gradient == pytest.approx(np.sqrt(2) * found.profile_rms_slope)


def test_as_a_model_of_a_measured_surface():
    surface, load = road(), Load(2e5, 0.2, 0.1)
    model = Persson(gamma=0.6)
    assert isinstance(model, Model)
    seen = []
    data = model.predict(ZENER, surface, load, on_progress=seen.append)
    lines = [cleaned for _, cleaned in surface.measured.profiles]
    found = persson(
        ZENER, profile_spectrum(lines), pressure=2e5, speed=0.2, smallest_wavelength=1e-3, gamma=0.6
    )
    assert seen[0].friction == found.friction
    assert float(data.total_friction) == float(data.total_friction_from_dissipation)
    assert float(data.total_friction) == data.running_friction.values[-1] == found.friction
    assert float(data.total_contact_fraction) == found.contact_fraction
    assert float(data.wavelength[-1]) == pytest.approx(1e-3)
    assert float(data.footprint) == 0.1
    assert data.attrs["model"] == "persson"
    assert all({"units", "long_name", "source"} <= set(data[name].attrs) for name in data.data_vars)
    reduced = surface.only(model.needs)
    assert model.predict(ZENER, reduced, load).identical(data)
    assert reduced.measured.self_affine is None
    smaller = Persson(smallest_wavelength=5e-4).predict(ZENER, surface, load)
    assert float(smaller.wavelength[-1]) == pytest.approx(5e-4)


def test_waves_by_hand_are_refused():
    surface = Surface(SineStack([1e-3], [1e-4]), "sine waves stated in the case")
    with pytest.raises(
        InputError, match=r"persson needs measured profiles; got .* sine waves only"
    ):
        Persson().predict(ZENER, surface, Load(1e5, 0.1, 0.1))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pressure": 0.0}, "pressure must be greater than zero"),
        ({"speed": -1.0}, "speed must not be negative"),
        ({"gamma": 1.5}, "gamma must be at most 1; got 1.5"),
        ({"gamma": -0.5}, "gamma must not be negative"),
        (
            {"smallest_wavelength": 1e-6},
            "must be among those of the spectrum, 6.283e-05 to 0.06283",
        ),
        ({"smallest_wavelength": 1.0}, "must be among those of the spectrum"),
        ({"spectrum": [1.0]}, "spectrum must be an ArealSpectrum or a ProfileSpectrum"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises(InputError, match=message):
        gs.theory.persson(
            **{"rubber": ZENER, "spectrum": HALF, "pressure": 1e5, "speed": 1} | change
        )
