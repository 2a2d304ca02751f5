"""Harmonics of heat switched on when a contact begins: against time integrals and both limits."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma

from gripscale.conditions import (
    LossDepth,
    harmonic_at_surface,
    harmonic_decay,
    harmonic_where_lost,
    uniform_at_surface,
    uniform_where_lost,
)
from gripscale.conditions.flash_temperature import PassingHarmonics
from tests.samples import THERMAL


def integrated(m, time, depth, of):
    """Return D/kappa times the integral of E exp(-d^2/(4 D s) - D m^2 s) / sqrt(pi D s) over s."""
    diffusivity, rate = THERMAL.diffusivity, depth.rate

    def met(s):
        length = 2.0 * np.sqrt(diffusivity * s)
        if of == "between":
            own = lambda d: rate * (3 + 3 * rate * d + (rate * d) ** 2) / 8 * np.exp(-rate * d)  # noqa: E731
        else:
            n = 3 if of == "one" else 6
            own = lambda d: rate**n * d ** (n - 1) * np.exp(-rate * d) / gamma(n)  # noqa: E731
        end = min(60.0 / rate, 7.0 * length)
        return float(quad(lambda d: own(d) * np.exp(-((d / length) ** 2)), 0.0, end, limit=200)[0])

    def part(unit):
        def at(root):
            wave = np.exp(-diffusivity * m**2 * root**2)
            return float(2.0 * (unit * wave).real / np.sqrt(np.pi * diffusivity) * met(root**2))

        return float(quad(at, 1e-9, np.sqrt(time), limit=300)[0])

    return diffusivity / THERMAL.conductivity * (part(1.0) + 1j * part(-1j))


@pytest.mark.parametrize(
    ("speed", "along", "number", "time", "mean"),
    [(1.0, 0.0, 1e3, 0.1, 1e-3), (1.0, 50.0, 300.0, 0.1, 1e-4), (0.3, 60.0, 60.0, 0.3, 1e-3)],
)
def test_slow_harmonics_are_the_integral_over_the_time_of_contact(speed, along, number, time, mean):
    m, depth = harmonic_decay([number], [along], speed, THERMAL), LossDepth(mean)
    [surface] = PassingHarmonics(m, time, THERMAL).at_surface(depth)
    assert surface == pytest.approx(integrated(m[0], time, depth, "one"), rel=1e-8)
    [lost] = PassingHarmonics(m, time, THERMAL).where_lost(depth)
    both = (integrated(m[0], time, depth, of) for of in ("between", "sum"))
    assert lost == pytest.approx(0.5 * sum(both), rel=1e-8)


def test_no_wavenumber_is_uniform_heat_and_a_long_time_is_steady():
    depth, time = LossDepth(2e-4), 0.1
    still = np.array([0.1 + 0j])
    [surface] = PassingHarmonics(still, time, THERMAL).at_surface(depth)
    [lost] = PassingHarmonics(still, time, THERMAL).where_lost(depth)
    assert surface.real == pytest.approx(uniform_at_surface(time, depth, THERMAL), rel=1e-6)
    assert lost.real == pytest.approx(uniform_where_lost(time, depth, THERMAL), rel=1e-6)
    m = harmonic_decay(np.geomspace(50.0, 1e5, 30), np.linspace(0.0, 40.0, 30), 1.0, THERMAL)
    long = 1e6
    steady = harmonic_at_surface(m, depth, THERMAL)
    np.testing.assert_allclose(
        PassingHarmonics(m, long, THERMAL).at_surface(depth), steady, rtol=1e-7
    )
    where = harmonic_where_lost(m, depth, THERMAL)
    np.testing.assert_allclose(
        PassingHarmonics(m, long, THERMAL).where_lost(depth), where, rtol=1e-7
    )
