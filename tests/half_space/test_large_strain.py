"""The law of large strain: its limits, its modulus, and what the direct contact says of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions.conditions import RubberByScale
from gripscale.half_space import DirectContact
from gripscale.half_space.line_to_map import finite_over_small, pressure_over_modulus
from gripscale.half_space.response import HalfSpace
from gripscale.model import Load
from gripscale.surface import SineStack, Surface
from gripscale.surface.surface import with_single_measurement

RUBBER = gs.Rubber(3e6, [2e7], [1e-3], bulk_modulus=2e9)
QUANTITIES = ("contact_fraction", "friction")
LONGEST = 28e-3


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_small_strain_has_no_factor_and_no_error(quantity: str) -> None:
    ratio, error = finite_over_small(quantity, 1e-9, 0.1)
    assert ratio == pytest.approx(1.0, abs=1e-7)
    assert error == pytest.approx(0.0, abs=1e-7)


def test_full_contact_keeps_its_area_and_loses_friction() -> None:
    areas = np.array([0.5, 0.99, 0.9999, 1.0])
    ratio, error = finite_over_small("contact_fraction", 2.0, areas)
    assert (areas * ratio <= 1.0).all()
    assert error[-1] == 0.0
    assert finite_over_small("friction", 1.0, 1.0)[0] < 0.9


def test_harder_pressed_rubber_has_more_area_less_friction_and_a_wider_error() -> None:
    pressed = np.array([0.01, 0.1, 0.5])
    for quantity, sign in zip(QUANTITIES, (1.0, -1.0), strict=True):
        ratio, error = finite_over_small(quantity, pressed, 0.2)
        assert (sign * np.diff(ratio) > 0.0).all()
        assert (np.diff(error) > 0.0).all()


def test_modulus_is_of_a_seventh_of_the_largest_wave_and_softened() -> None:
    speed, pressure = 0.3, 3e5
    omega = 2.0 * math.pi * speed / 4e-3
    as_measured = pressure_over_modulus(HalfSpace(RUBBER, speed), pressure, LONGEST)
    assert as_measured == pytest.approx(pressure / abs(complex(RUBBER.complex_modulus(omega))))
    number, even = 2.0 * math.pi / np.array([LONGEST, 1e-4]), np.ones(2)
    third = RubberByScale(RUBBER, number, even, even, even / 3.0, even / 3.0)
    softened = HalfSpace(RUBBER, speed, by_scale=third)
    assert pressure_over_modulus(softened, pressure, LONGEST) == pytest.approx(3.0 * as_measured)
    at_rest = pressure_over_modulus(HalfSpace(RUBBER, 0.0), pressure, LONGEST)
    assert at_rest == pytest.approx(pressure / 3e6)


def test_direct_contact_says_how_hard_its_rubber_is_pressed() -> None:
    x = 2e-4 * np.arange(1024)
    line = gs.Profile(x, 1e-3 * np.cos(2.0 * np.pi * x / 16e-3))
    sines = SineStack([LONGEST, 4e-3], [1e-3, 1e-4], cut_off=2e-3)
    surface = with_single_measurement(Surface(sines, "waves"), line)
    answer = DirectContact(tolerance=None).predict(RUBBER, surface, Load(3e5, 0.3, 0.1))
    expected = pressure_over_modulus(HalfSpace(RUBBER, 0.3), 3e5, LONGEST)
    assert float(answer.total_pressure_over_modulus) == pytest.approx(expected)
