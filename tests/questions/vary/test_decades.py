"""The split of friction by relaxation time against harmonics written out by hand."""

import numpy as np
import pytest
import xarray as xr

from gripscale.questions.vary.friction_parts import friction_by_decade, in_decades
from gripscale.rubber import Rubber

RUBBER = Rubber(2e6, [3e6, 4e6], [2e-2, 5e-4])
WAVELENGTH, SPEED, FRICTION = 10e-3, 0.3, 0.2
OMEGA = 2.0 * np.pi * SPEED / WAVELENGTH


def one_wave(first, second, status="converged"):
    """Return a wave whose pressure has two harmonics, at uneven abscissas, padded with NaN."""
    x = WAVELENGTH * (np.linspace(0.0, 1.0, 400, endpoint=False) - 0.5)
    x = x + 0.01 * WAVELENGTH * np.sin(2.0 * np.pi * x / WAVELENGTH)
    phase = 2.0 * np.pi * x / WAVELENGTH
    pressure = 1e6 * (1.0 + first * np.cos(phase) + second * np.sin(2.0 * phase))
    padded = [np.append(values, np.nan)[None, :] for values in (x, pressure)]
    return xr.Dataset(
        {
            "wavelength": ("scale", [WAVELENGTH]),
            "angular_frequency": ("scale", [OMEGA]),
            "friction": ("scale", [FRICTION]),
            "surface_x": (("scale", "surface_node"), padded[0]),
            "surface_pressure": (("scale", "surface_node"), padded[1]),
        }
    ).assign(prediction_status=status, nominal_speed=SPEED)


def by_hand(first, second):
    """Return the friction of the slower element: D_k = |p_k|^2 E''/|E*|^2, k = 1 and 2."""
    slow, both = 0.0, 0.0
    for order, height in ((1, first), (2, second)):
        modulus = RUBBER.complex_modulus(order * OMEGA)
        phase = order * OMEGA * RUBBER.relaxation_times[0]
        part = height**2 / abs(modulus) ** 2
        slow += part * RUBBER.moduli[0] * phase / (1.0 + phase**2)
        both += part * float(modulus.imag)
    return FRICTION * slow / both


@pytest.mark.parametrize(("first", "second"), [(0.8, 0.0), (0.0, 0.8), (0.5, 0.3)])
def test_split_is_that_of_the_harmonics(first, second):
    parts = friction_by_decade(one_wave(first, second), RUBBER)
    assert set(parts) == {-2, -4}
    # The trapezoidal rule on smooth uneven nodes is exact to second order: (1/400)^2.
    assert parts[-2] == pytest.approx(by_hand(first, second), rel=1e-3)
    assert sum(parts.values()) == pytest.approx(FRICTION, rel=1e-12)


def test_no_split_without_a_solution_or_sliding():
    assert friction_by_decade(one_wave(0.8, 0.1, "iteration limit"), RUBBER) == {}
    rest = one_wave(0.8, 0.1).assign(nominal_speed=0.0)
    assert friction_by_decade(rest, RUBBER) == {}


@pytest.mark.parametrize("shift", [0.0, 0.3, 0.5, 0.99])
def test_elements_as_dense_as_a_spectrum_do_not_jump_between_decades(shift):
    """Elements 2/3 of a decade apart with equal shares: 3/2 of one in each decade, wherever."""
    place = np.arange(-6.0, 2.0, 2.0 / 3.0) + shift
    parts = {}
    for n, part in in_decades(place, np.ones_like(place)):
        parts[n] = parts.get(n, 0.0) + part
    inner = [parts[n] for n in range(-5, 1)]
    np.testing.assert_allclose(inner, 1.5, rtol=1e-12)
    assert sum(parts.values()) == pytest.approx(place.size, rel=1e-12)
