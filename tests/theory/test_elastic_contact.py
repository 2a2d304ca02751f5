"""Closed forms of elastic contact: each against quadrature, a limit or another closed form."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.theory import full_contact_friction, full_contact_pressure, plane_strain_modulus
from tests.closed_forms import (
    contact_fraction,
    contact_half_width,
    contact_pressure,
    crest_radius,
    largest_pressure,
)


def test_contact_fractions_of_the_table():
    """Table of the method: fraction at p/p* = 0.1, 0.3, 0.5, 0.8, to its four digits."""
    expected = [0.2048, 0.3690, 0.5, 0.7048]
    assert contact_fraction([0.1, 0.3, 0.5, 0.8]) == pytest.approx(expected, abs=5e-5)
    assert contact_fraction([0.0, 1.0, 2.0]).tolist() == [0.0, 1.0, 1.0]


@pytest.mark.parametrize("ratio", [0.05, 0.5, 0.95, 1.0, 3.0])
def test_pressure_carries_the_load_and_ends_at_the_edge(ratio):
    """Midpoint rule with 20000 points on a function with square-root ends: 1e-5."""
    x = (np.arange(20000) + 0.5) / 20000 * 2e-3 - 1e-3
    pressure = contact_pressure(x, wavelength=2e-3, pressure=ratio * 1e6, full_contact_pressure=1e6)
    assert pressure.mean() == pytest.approx(ratio * 1e6, rel=1e-5)
    assert np.mean(pressure > 0.0) == pytest.approx(float(contact_fraction(ratio)), abs=1e-4)
    largest = 2 / np.sqrt(ratio) if ratio < 1.0 else 1.0 + 1.0 / ratio
    assert pressure.max() == pytest.approx(largest * ratio * 1e6, rel=1e-6)


def test_westergaard_flattens_the_crest_inside_the_contact():
    """The surface under the pressure, by Fourier series, follows the wave where they touch.

    4096 points; the series of a pressure with square-root ends converges as m^-3/2 and the
    displacement as m^-5/2: 1e-4 of the amplitude.
    """
    points, ratio, modulus, length, amplitude = 4096, 0.3, 4e6, 1e-3, 1e-5
    x = (np.arange(points) / points - 0.5) * length
    full = full_contact_pressure(modulus, wavelength=length, amplitude=amplitude)
    assert full == pytest.approx(np.pi * modulus * amplitude / length)
    pressure = contact_pressure(
        x, wavelength=length, pressure=ratio * full, full_contact_pressure=full
    )
    number = np.fft.rfftfreq(points, 1 / points) * 2 * np.pi / length
    coefficient = np.fft.rfft(pressure)
    coefficient[1:] *= 2 / (modulus * number[1:])
    coefficient[0] = 0.0
    gap = np.fft.irfft(coefficient) - amplitude * np.cos(2 * np.pi * x / length)
    touching = pressure > 0.0
    assert np.ptp(gap[touching]) < 1e-4 * amplitude
    assert gap[~touching].min() > gap[touching].mean() - 1e-4 * amplitude


def test_hertz_carries_the_load_and_matches_its_curvature():
    """Quadrature of the load, and a^2 = 4 P R/(pi M) with p_max = M a/(2 R) (Johnson 4.44)."""
    given = {"load_per_length": 50.0, "radius": 2e-3, "plane_strain_modulus": 4e6}
    half_width, top = contact_half_width(**given), largest_pressure(**given)
    assert 0.5 * np.pi * half_width * top == pytest.approx(50.0, rel=1e-12)
    assert top == pytest.approx(4e6 * half_width / (2 * 2e-3), rel=1e-12)


def test_westergaard_tends_to_hertz_at_small_load():
    """At p/p* = 1e-4 the next term of arcsin and sin is 1e-4/6 of the first."""
    wavelength, amplitude, modulus = 1e-3, 5e-5, 4e6
    full = full_contact_pressure(modulus, wavelength=wavelength, amplitude=amplitude)
    load = 1e-4 * full
    hertz = {
        "load_per_length": load * wavelength,
        "radius": crest_radius(wavelength=wavelength, amplitude=amplitude),
        "plane_strain_modulus": modulus,
    }
    fraction = 2 * contact_half_width(**hertz) / wavelength
    assert float(contact_fraction(1e-4)) == pytest.approx(fraction, rel=2e-5)
    top = contact_pressure(0.0, wavelength=wavelength, pressure=load, full_contact_pressure=full)
    assert float(top) == pytest.approx(largest_pressure(**hertz), rel=1e-12)


def test_friction_in_full_contact_is_the_work_of_the_pressure():
    """mean(p w')/mean(p) with p = p_mean + k A |M|/2 cos(k x + delta), by the exact rule."""
    modulus, wavelength, amplitude, load = 5e6 + 2e6j, 1e-3, 2e-5, 1e6
    wave = {"wavelength": wavelength, "amplitude": amplitude}
    number = 2 * np.pi / wavelength
    x = np.arange(64) / 64 * wavelength
    swing = full_contact_pressure(modulus, **wave)
    assert swing < load
    pressure = load + swing * np.cos(number * x + np.angle(modulus))
    work = np.mean(pressure * -amplitude * number * np.sin(number * x)) / load
    assert full_contact_friction(modulus, pressure=load, **wave) == pytest.approx(work, rel=1e-12)
    assert full_contact_friction(5e6, pressure=load, **wave) == 0.0


def test_plane_strain_modulus():
    assert plane_strain_modulus(3e6 + 1e6j, 0.5) == pytest.approx(4e6 + 4e6j / 3)


WAVE = {"wavelength": 1e-3, "amplitude": 1e-5}


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: plane_strain_modulus(1e6, 0.6), "poisson_ratio must be above -1"),
        (lambda: full_contact_pressure(-1e6, **WAVE), "plane_strain_modulus must have"),
        (lambda: full_contact_pressure(1e6 - 1j, **WAVE), "plane_strain_modulus must have"),
        (lambda: full_contact_pressure(1e6, wavelength=0, amplitude=1), "wavelength must be"),
        (
            lambda: full_contact_friction(1e6, pressure=1e4, **WAVE),
            "pressure must be at least 31415.9 for full contact",
        ),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(InputError, match=message):
        call()
