"""The springpot rubber and its Prony series."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.rubber import springpot_modulus, styrene_butadiene


def test_springpots_at_the_reference_frequency():
    """At w_r each springpot is its modulus at a phase of 90 degrees times its exponent."""

    def turned(modulus, degrees):
        return complex(modulus * np.exp(1j * np.deg2rad(degrees)))

    expected = turned(1.76e6, 2.3) + 1 / (1 / turned(1.12e9, 55.0) + 1 / turned(1.12e9, 2.0))
    assert springpot_modulus(2 * np.pi * 6.94e7) == pytest.approx(expected, rel=1e-13)


def test_low_frequencies_have_the_rubbery_loss_angle():
    """The transition spring pot is down by (1e-12)^(55/90-2.3/90), a few 1e-5 of the whole."""
    modulus = complex(springpot_modulus(2 * np.pi * 6.94e7 * 1e-12))
    assert np.degrees(np.angle(modulus)) == pytest.approx(2.3, abs=0.01)


def test_the_series_follows_the_springpots():
    """Two elements per decade ripple by 2 sech(2 pi^2/ln 10) = 0.04 %; the rest is smoothing and
    the ends, where half of the neighbours are missing."""
    omega = np.geomspace(1e-2, 1e10, 1000)
    ratio_parts = styrene_butadiene().complex_modulus(omega), springpot_modulus(omega)
    storage = ratio_parts[0].real / ratio_parts[1].real - 1
    loss = ratio_parts[0].imag / ratio_parts[1].imag - 1
    assert np.abs(storage).max() < 0.005
    assert np.abs(loss).max() < 0.02
    inside = (omega > 1e-1) & (omega < 1e9)
    assert np.abs(storage[inside]).max() < 0.002
    assert np.abs(loss[inside]).max() < 0.005


def test_it_says_what_it_is():
    rubber = styrene_butadiene()
    assert "styrene-butadiene" in rubber.name
    assert "not stated" in rubber.source
    assert rubber.valid_band == pytest.approx((1e-2, 1e10))
    assert styrene_butadiene() is rubber


@pytest.mark.parametrize("omega", [0.0, -1.0, np.inf])
def test_bad_frequencies(omega):
    with pytest.raises(InputError, match="omega must be"):
        springpot_modulus(omega)
