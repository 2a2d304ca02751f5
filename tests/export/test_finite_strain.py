"""What the programs' form of viscoelasticity is worth at finite strain: one cycle of stretch.

An incompressible neo-Hookean bar, stretch s = 1 + a sin(w t), after three cycles from rest. With
sigma_e of the relaxed rubber and g_i = G_i/G_inf the programs have, axes not turning,

    Abaqus   dev tau = tau_e + sum g_i int exp(-(t - u)/tau_i) d(dev tau_e)/du du
             (Theory Guide 4.8.2: F^-1 tau F, which here is tau)
    FEBio    S = S_e + sum g_i int exp(-(t - u)/tau_i) dS_e/du du,  S_e = F^-1 dev sigma_e F^-T
             (FEUncoupledViscoElasticMaterial::DevStress)

and both the pressure that leaves the sides free. The integrals are exact for stresses linear
between samples, as FEBio takes them.
"""

import numpy as np
import pytest

from gripscale.rubber import fit_prony, read_master_curve, uniaxial_stress
from tests.samples import MEASURED_DMA as DMA

OMEGA, SAMPLES, CYCLES = 10.0, 400, 4


def relaxed(rubber, time, stress):
    """Return stress + sum g_i int exp(-(t - u)/tau_i) dstress/du du."""
    step = (time[1] - time[0]) / rubber.relaxation_times
    decay, arriving = np.exp(-step), -np.expm1(-step) / step
    memory, out = np.zeros_like(decay), stress.copy()
    for k in range(1, len(stress)):
        memory = memory * decay + (stress[k] - stress[k - 1]) * arriving
        out[k] += memory @ rubber.shear_moduli / rubber.equilibrium_shear_modulus
    return out


def abaqus(rubber, time, s):
    return relaxed(rubber, time, rubber.equilibrium_shear_modulus * (s**2 - 1.0 / s)) / s


def febio(rubber, time, s):
    third = rubber.equilibrium_shear_modulus * (s**2 - 1.0 / s) / 3.0
    along = relaxed(rubber, time, 2.0 * third / s**2)
    across = relaxed(rubber, time, -third * s)
    return (s**2 * along - across / s) / s


@pytest.fixture(scope="module")
def tread():
    return fit_prony(read_master_curve(DMA))


@pytest.mark.parametrize(
    ("form", "amplitude", "lost"),
    [
        (abaqus, 0.01, 1.000),
        (abaqus, 0.1, 0.995),
        (abaqus, 0.3, 0.957),
        (febio, 0.01, 1.000),
        (febio, 0.1, 1.005),
        (febio, 0.3, 1.049),
    ],
)
def test_work_lost_in_a_cycle_over_that_of_temporary_networks(tread, form, amplitude, lost):
    """The numbers of docs/export.md, to their last digit."""
    time = np.linspace(0.0, CYCLES * 2.0 * np.pi / OMEGA, CYCLES * SAMPLES + 1)
    s = 1.0 + amplitude * np.sin(OMEGA * time)
    last = slice(-SAMPLES - 1, None)
    own = np.trapezoid(uniaxial_stress(tread, time, s)[last], s[last])
    theirs = np.trapezoid(form(tread, time, s)[last], s[last])
    assert own > 0.0
    assert theirs / own == pytest.approx(lost, abs=6e-4)
