"""Diffusion against exact limits, Persson's theory and direct contacts of Gaussian maps."""

import importlib

import numpy as np
import pytest
from scipy import stats
from scipy.special import erf, erfinv

from gripscale.core.errors import InputError
from gripscale.rubber import Rubber, styrene_butadiene
from gripscale.surface import ArealSpectrum
from gripscale.surface.cut_off import PowerLaw
from gripscale.theory import ContactPressures, diffusion, persson
from tests.verification.gaussian_maps import GaussianCase, judged

persson_module = importlib.import_module("gripscale.theory.persson")

RELAXED, STIFF, TIME = 3e6, 27e6, 1e-3
ELASTIC = Rubber(RELAXED, bulk_modulus=1e13)
ZENER = Rubber(RELAXED, [STIFF], [TIME], bulk_modulus=1e13)
Q0, Q1, LEVEL = 1e3, 3.2e4, 1e-6
HALF = ArealSpectrum([Q0, Q1], [LEVEL * Q0**-3, LEVEL * Q1**-3])
LAW = PowerLaw(0.5, 2.0 * np.pi * Q0 * LEVEL)
"""The same surface: H = 1/2, and d<|grad z|^2>/d ln q = 2 pi q^4 C."""
FIRST, LAST = 2.0 * np.pi / Q0, 2.0 * np.pi / Q1

QUADRATURE = 1e-4
"""The last doubling changed less; a rule of second order is then off by a third of it."""


def uniform(pressure: float) -> ContactPressures:
    return ContactPressures([pressure], 1.0, 0.0, FIRST)


@pytest.mark.parametrize("rubber", [ELASTIC, ZENER, styrene_butadiene()])
@pytest.mark.parametrize("pressure", [5e4, 2e5, 1e6])
def test_a_uniform_pressure_without_corrections_is_the_theory(rubber, pressure):
    load = {"pressure": pressure, "speed": 0.3}
    theory = persson(rubber, HALF, **load)
    own = diffusion(
        rubber, uniform(pressure), LAW, smallest_wavelength=LAST, corrected=False, **load
    )
    assert own.converged
    # W = 1 makes V the running integral of the theory, by the same rule
    assert own.contact_fraction == pytest.approx(theory.contact_fraction, rel=2 * QUADRATURE)
    assert own.friction == pytest.approx(theory.friction, rel=2 * QUADRATURE)
    assert own.rms_gradient == pytest.approx(theory.rms_gradient, rel=1e-6)
    assert own.profile_rms_slope == pytest.approx(theory.profile_rms_slope, rel=1e-6)


@pytest.mark.parametrize("speed", [0.0, 0.03, 30.0])
def test_full_contact_is_in_closed_form(speed):
    """As in tests/theory/test_persson.py, on top of the friction of the start."""
    pressure = 1e9
    start = ContactPressures([pressure], 1.0, 0.01, FIRST)
    found = diffusion(ZENER, start, LAW, pressure=pressure, speed=speed, smallest_wavelength=LAST)
    assert found.contact_fraction > 1 - 1e-9
    added = 0.0
    if speed > 0.0:
        first, last = (q * speed * TIME for q in (Q0, Q1))
        steps = np.log(last / first) + np.arcsinh(1 / last) - np.arcsinh(1 / first)
        added = 4 / 3 * np.pi * STIFF * LEVEL / (pressure * speed * TIME) * steps
    assert found.friction - 0.01 == pytest.approx(added, rel=QUADRATURE, abs=1e-15)


def test_without_roughness_nothing_changes():
    start = ContactPressures([1e5, 3e5, 2e5], 0.3, 0.12, FIRST)
    smooth = PowerLaw(0.8, 1e-14)
    found = diffusion(ZENER, start, smooth, pressure=6e4, speed=1.0, smallest_wavelength=LAST)
    assert found.contact_fraction == pytest.approx(0.3, rel=1e-9)
    assert found.friction == pytest.approx(0.12, rel=1e-9)


@pytest.mark.parametrize("corrected", [False, True])
def test_diffusion_goes_on_where_it_stopped(corrected):
    """A second diffusion, started from the pressures that the first ends with, is no other.

    The first, from a uniform pressure p, ends with the density n(s - p) - n(s + p), n a Gaussian
    of the variance V; and P = erf(p/sqrt(2 V)) says which.
    """
    load = {"pressure": 2e5, "speed": 0.3}
    options = {**load, "corrected": corrected}
    whole = diffusion(ZENER, uniform(2e5), LAW, smallest_wavelength=LAST, **options)
    half = diffusion(ZENER, uniform(2e5), LAW, smallest_wavelength=FIRST / 4, **options)
    area = half.contact_fraction
    assert 0.1 < area < 0.9
    deviation = 2e5 / (np.sqrt(2.0) * erfinv(area))
    s = np.linspace(0.0, 2e5 + 8.0 * deviation, 20_001)
    normal = stats.norm(scale=deviation)
    density = normal.pdf(s - 2e5) - normal.pdf(s + 2e5)
    share = np.cumsum(density) / density.sum()
    pressures = np.interp((np.arange(50_000) + 0.5) / 50_000, share, s)
    start = ContactPressures(pressures, area, half.friction, FIRST / 4)
    # the mean square gradient of H = 1/2 grows with q
    rest = PowerLaw(0.5, 4.0 * LAW.growth)
    then = diffusion(ZENER, start, rest, smallest_wavelength=LAST, **options)
    # 256 classes stand for all pressures: 1e-3 in the first octave, less later
    assert then.contact_fraction == pytest.approx(whole.contact_fraction, rel=1e-3)
    assert then.friction == pytest.approx(whole.friction, rel=1e-3)


def test_light_contact_of_an_elastic_solid():
    """A/A_0 = kappa p/(M h') over tens of octaves, kappa = sqrt(8/(pi w)) = 2.17.

    Boundary elements have 2.0 to 2.3 (S. Hyun, L. Pei, J.-F. Molinari & M. O. Robbins, Phys. Rev. E
    70 (2004) 026117; V. A. Yastrebov, G. Anciaux & J.-F. Molinari, Int. J. Solids Struct. 52
    (2015) 83), Persson sqrt(8/pi) = 1.60.
    """
    end = FIRST / 2**24
    found = diffusion(ELASTIC, uniform(1e5), LAW, pressure=1e5, speed=0.0, smallest_wavelength=end)
    assert found.converged
    kappa = found.contact_fraction * RELAXED * 4 / 3 * found.rms_gradient / 1e5
    assert found.contact_fraction < 0.01
    # V = w G + (1 - w) int P^2 dG: the second term fades as ln(G)/G
    assert kappa == pytest.approx(np.sqrt(8.0 / (np.pi * 0.54)), rel=2e-3)


def test_pressures_of_a_coarse_grid_carry_the_load():
    """More points are in contact than belong to the area: their pressures are scaled."""
    pressures = np.random.default_rng(0).uniform(1e5, 4e5, 300)
    start = ContactPressures(pressures, 0.2, 0.1, FIRST)
    classes = start.classes(6e4)
    assert classes.size == 256
    assert np.all(np.diff(classes) > 0.0)
    assert 0.2 * classes.mean() == pytest.approx(6e4)


def test_a_gaussian_map_two_octaves_further():
    """The tolerances over four octaves, of tests/verification/test_diffusion.py."""
    case = GaussianCase(0.8, styrene_butadiene(), speed=1.0, share=0.05, seed=7)
    area, friction = judged(case, points=256, octaves=2)
    assert abs(area - 1.0) < 0.10
    assert abs(friction - 1.0) < 0.05


def test_not_converging_is_a_status(monkeypatch):
    module = importlib.import_module("gripscale.theory.diffusion")
    monkeypatch.setattr(module, "FINEST", 8)
    monkeypatch.setattr(module, "TOLERANCE", 1e-9)
    found = diffusion(ZENER, uniform(1e5), LAW, pressure=1e5, speed=0.3, smallest_wavelength=LAST)
    monkeypatch.setattr(persson_module, "TOLERANCE", 1e-9)
    assert found.status == "tolerance not met"


def test_dataset_has_the_names_of_the_theories():
    load = {"pressure": 1e5, "speed": 0.3}
    found = diffusion(ZENER, uniform(1e5), LAW, smallest_wavelength=LAST, **load)
    data = found.to_dataset()
    assert set(persson(ZENER, HALF, **load).to_dataset()) == set(data)
    assert data.total_friction == found.friction
    assert data.model == "diffusion"
    assert np.allclose(data.wavelength, FIRST / 2.0 ** np.arange(6))


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (([1e5, -1.0], 0.5, 0.1, 1e-3), "pressure must"),
        (([1e5], 1.5, 0.1, 1e-3), "contact_fraction must"),
        (([1e5], 0.5, np.nan, 1e-3), "friction must"),
        (([1e5], 0.5, 0.1, 0.0), "wavelength must"),
    ],
)
def test_pressures_out_of_range_are_refused(values, message):
    with pytest.raises(InputError, match=message):
        ContactPressures(*values)


@pytest.mark.parametrize("last", [FIRST, 2 * FIRST, -1.0])
def test_the_end_must_be_below_the_start(last):
    with pytest.raises(InputError, match="smallest_wavelength must"):
        diffusion(ZENER, uniform(1e5), LAW, pressure=1e5, speed=0.3, smallest_wavelength=last)


def test_erf_of_one_class():
    """P = erf(p/sqrt(2 V)) with V of the gradient alone: at rest, without corrections."""
    pressure = 0.3 * RELAXED * 4 / 3 * np.sqrt(LAW.added(Q1 / Q0))
    found = diffusion(
        ELASTIC,
        uniform(pressure),
        LAW,
        pressure=pressure,
        speed=0.0,
        smallest_wavelength=LAST,
        corrected=False,
    )
    assert found.contact_fraction == pytest.approx(erf(np.sqrt(2) * 0.3), rel=QUADRATURE)
