"""Closed forms of elastic contact."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.theory import full_contact_friction, full_contact_pressure, plane_strain_modulus
from tests.closed_forms import contact_fraction


def test_contact_fractions_of_the_table():
    """Table of the method: fraction at p/p* = 0.1, 0.3, 0.5, 0.8, to its four digits."""
    expected = [0.2048, 0.3690, 0.5, 0.7048]
    assert contact_fraction([0.1, 0.3, 0.5, 0.8]) == pytest.approx(expected, abs=5e-5)
    assert contact_fraction([0.0, 1.0, 2.0]).tolist() == [0.0, 1.0, 1.0]


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
