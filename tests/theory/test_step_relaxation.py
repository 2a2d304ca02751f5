"""Stress relaxation after a finite step: against the network's own integral, and small strain."""

import numpy as np
import pytest
from scipy.integrate import quad

from gripscale.rubber import Rubber
from tests.closed_forms import step_relaxation_stress

RUBBER = Rubber(2e6, [3e6, 5e6], [0.1, 2.0])


def test_temporary_network_gives_the_closed_form():
    """Strands born before the step (t' < 0) carry the whole stretch, those born after it none.

    Cauchy stress of the network: sum_i G_i int (dead rate) exp(-(t-t')/tau_i)/tau_i [B(t,t') - I],
    here its strands from t' = -infinity to 0, by quadrature (tail beyond 60 tau is exp(-60)).
    """
    stretch, time = 1.8, 0.3
    total = RUBBER.equilibrium_shear_modulus
    for modulus, tau in zip(RUBBER.shear_moduli, RUBBER.relaxation_times, strict=True):
        alive = quad(lambda s, tau=tau: np.exp(-(time + s) / tau) / tau, 0, 60 * tau)[0]
        total += modulus * alive
    cauchy = total * (stretch**2 - 1 / stretch)
    found = step_relaxation_stress(RUBBER, stretch=stretch, time=time)
    assert float(found) == pytest.approx(cauchy / stretch, rel=1e-7)


def test_limits():
    """Equilibrium, the glassy start, and Hooke's law E(t) e to second order in the strain."""
    start, end = step_relaxation_stress(RUBBER, stretch=2.0, time=[0.0, np.inf])
    assert start == pytest.approx(10e6 / 3 * 1.75)
    assert end == pytest.approx(2e6 / 3 * 1.75)
    small = step_relaxation_stress(RUBBER, stretch=1 + 1e-6, time=1.0)
    assert float(small) == pytest.approx(float(RUBBER.relaxation_modulus(1.0)) * 1e-6, rel=1e-5)
    assert step_relaxation_stress(RUBBER, stretch=0.5, time=1.0) < 0.0
