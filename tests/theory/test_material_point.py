"""The material point: small strain, steps, energies by differences, an independent integration."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp, trapezoid

from gripscale.core.errors import InputError
from gripscale.rubber import (
    MooneyRivlin,
    NeoHookean,
    Rubber,
    Yeoh,
    simple_shear_stress,
    uniaxial_stress,
)
from gripscale.rubber.finite_strain import network_states
from tests.closed_forms import step_relaxation_stress

LAWS = [NeoHookean(), MooneyRivlin(0.4), Yeoh(-0.05, 0.004)]
SERIES = {"moduli": [3e6, 5e6, 2e6], "relaxation_times": [0.03, 0.4, 5.0]}


def rubber(law=LAWS[0]):
    return Rubber(2e6, **SERIES, strain_energy=law)


def fundamental(time, stress, omega, per_cycle):
    """Amplitude of exp(i w t) over the last cycle, for a strain sin(w t): E' + i E'' per strain."""
    last = slice(-per_cycle, None)
    wave = np.exp(-1j * omega * time[last])
    return 2j * np.mean(stress[last] * wave)


def cyclic(omega, cycles, per_cycle):
    return np.arange(cycles * per_cycle + 1) * (2 * np.pi / omega / per_cycle)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("omega", [0.5, 5.0, 50.0])
def test_small_cyclic_strain_gives_the_prony_sums(law, omega):
    """Chords of Y lose (w dt)^2/12 = 5.7e-5 of the fundamental, so of E_glassy - E* as well.

    Finite strain 1e-3 adds its square; after 12 of the longest relaxation times the start is
    forgotten to exp(-12) = 6e-6: together 1e-5 of |E*|.
    """
    per_cycle, amplitude = 240, 1e-3
    cycles = int(np.ceil(12 * 5.0 * omega / (2 * np.pi))) + 1
    time = cyclic(omega, cycles, per_cycle)
    strain = amplitude * np.sin(omega * time)
    expected = complex(rubber().complex_modulus(omega))
    pulled = uniaxial_stress(rubber(law), time, 1.0 + strain)
    sheared = simple_shear_stress(rubber(law), time, strain)
    for found in (
        fundamental(time, pulled, omega, per_cycle) / amplitude,
        3 * fundamental(time, sheared, omega, per_cycle) / amplitude,
    ):
        chords = 5.8e-5 * abs(rubber().glassy_modulus - expected)
        assert abs(found - expected) < chords + 1e-5 * abs(expected)
        assert (found.real, found.imag) == pytest.approx((expected.real, expected.imag), rel=1e-3)


def test_large_cyclic_shear_of_a_neo_hookean_rubber_is_linear():
    """T = G* g at any amplitude: the shear test again at g = 2, same tolerance."""
    omega, per_cycle = 5.0, 240
    time = cyclic(omega, 49, per_cycle)
    stress = simple_shear_stress(rubber(), time, 2.0 * np.sin(omega * time))
    found = fundamental(time, stress, omega, per_cycle) / 2.0
    expected = rubber().complex_modulus(omega) / 3.0
    assert (found.real, found.imag) == pytest.approx((expected.real, expected.imag), rel=2e-4)


@pytest.mark.parametrize("stretch", [0.4, 1.7, 3.0])
def test_step_relaxation_is_the_closed_form(stretch):
    """Exact, but for rounding: Y is constant from the first sample on."""
    time = np.geomspace(1e-3, 30.0, 40) - 1e-3
    found = uniaxial_stress(rubber(), time, np.full(40, stretch))
    expected = step_relaxation_stress(rubber(), stretch=stretch, time=time)
    assert found == pytest.approx(expected, rel=1e-11)


def test_a_step_between_two_equal_times():
    time = [0.0, 1.0, 1.0, 1.5]
    found = uniaxial_stress(rubber(), time, [1.0, 1.0, 2.0, 2.0])
    expected = step_relaxation_stress(rubber(), stretch=2.0, time=[0.0, 0.5])
    assert found[:2] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert found[2:] == pytest.approx(expected, rel=1e-12)


def energy(law, first, second):
    """W over G_inf, as published (Mooney 1940, Rivlin 1948, Yeoh 1993), from I1 - 3 and I2 - 3."""
    if isinstance(law, MooneyRivlin):
        return 0.5 * ((1 - law.share) * first + law.share * second)
    if isinstance(law, Yeoh):
        return 0.5 * (first + law.second * first**2 + law.third * first**3)
    return 0.5 * first


@pytest.mark.parametrize("law", LAWS)
def test_long_after_a_step_the_stress_is_the_slope_of_the_energy(law):
    """dW/ds and dW/dg by central differences, h = 1e-5: error of order h^2 and 1e-16/h."""
    base, h = rubber(law), 1e-5
    time = [0.0, 1e3]  # exp(-200) is left of the slowest network

    def pulled(s):
        return energy(law, s**2 + 2 / s - 3, 2 * s + s**-2 - 3)

    def sheared(g):
        return energy(law, g**2, g**2)

    for s in (0.6, 1.3, 2.5):
        found = uniaxial_stress(base, time, [s, s])[-1] / base.equilibrium_shear_modulus
        assert found == pytest.approx((pulled(s + h) - pulled(s - h)) / (2 * h), rel=1e-8)
    for g in (-0.7, 0.2, 2.0):
        found = simple_shear_stress(base, time, [g, g])[-1] / base.equilibrium_shear_modulus
        assert found == pytest.approx((sheared(g + h) - sheared(g - h)) / (2 * h), rel=1e-8)


PERIOD = 1.3


def loading(time):
    """Stretch between 1 and 2.6, with a second harmonic."""
    phase = 2 * np.pi * np.asarray(time) / PERIOD
    return 1.8 - 0.7 * np.cos(phase) - 0.1 * np.cos(2 * phase)


def integrated_stress(base, time):
    """Stress from d A/dt = (C^-1 - A)/tau by eighth-order Runge-Kutta, 3x3 tensors."""
    tau = base.relaxation_times

    def rate(now, flat):
        s = float(loading(now))
        inverse = np.linalg.inv(np.diag([s**2, 1 / s, 1 / s]))
        return ((inverse - flat.reshape(-1, 3, 3)) / tau[:, None, None]).ravel()

    start = np.tile(np.eye(3), (len(tau), 1, 1)).ravel()
    options = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12}
    run = solve_ivp(rate, (0.0, time[-1]), start, t_eval=time, **options)
    stress = []
    for s, flat in zip(loading(time), run.y.T, strict=True):
        f = np.diag([s, s**-0.5, s**-0.5])
        h = np.tensordot(base.shear_moduli, flat.reshape(-1, 3, 3), 1)
        cauchy = f @ (h + base.equilibrium_shear_modulus * np.eye(3)) @ f.T
        stress.append((cauchy[0, 0] - cauchy[1, 1]) / s)
    return np.array(stress)


def test_finite_cyclic_stretch_against_an_independent_integration():
    """Chords of Y err by dt^2/12 Y'' on average, so the error falls to a quarter at half the step.

    At 800 samples a cycle that is (2 pi/800)^2/12 = 5.1e-6 of a first harmonic.
    """
    base, coarse = rubber(), 100
    time = np.linspace(0.0, 3 * PERIOD, 3 * coarse + 1)
    expected = integrated_stress(base, time)
    errors = []
    for refinement in (1, 2, 8):
        fine = np.linspace(0.0, 3 * PERIOD, 3 * coarse * refinement + 1)
        found = uniaxial_stress(base, fine, loading(fine))[::refinement]
        errors.append(np.abs(found - expected).max() / expected.max())
    assert errors[1] == pytest.approx(errors[0] / 4, rel=0.05)
    assert errors[2] < 6e-6  # measured 4.6e-6


def dissipated(base, time, stretch):
    """Loss rate of the networks [W/m3]: sum G_i/(2 tau_i) (tr(A C) + tr((A C)^-1) - 6).

    From psi_i = G_i/2 (A:C - 3 - ln det A) and the evolution of A; no term is ever negative.
    """
    inverse = np.column_stack([stretch**-2, stretch])
    a = network_states(base.relaxation_times, time, inverse, rest=(1.0, 1.0))
    ratio = a / inverse[:, None, :]
    excess = ratio[..., 0] + 1 / ratio[..., 0] + 2 * (ratio[..., 1] + 1 / ratio[..., 1]) - 6
    stored = ratio[..., 0] + 2 * ratio[..., 1] - 3 - np.log(a[..., 0]) - 2 * np.log(a[..., 1])
    moduli = base.shear_moduli
    return excess @ (moduli / (2 * base.relaxation_times)), stored @ (moduli / 2)


SERIES_OF_TERMS = st.lists(
    st.tuples(st.floats(1e4, 1e8), st.floats(1e-2, 1e2)), min_size=1, max_size=5
)


@given(SERIES_OF_TERMS, st.floats(0.4, 4.0), st.floats(0.4, 4.0), st.sampled_from(LAWS))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_a_closed_cycle_from_rest_costs_work(series, first, second, law):
    """Work from s = 1 over two extremes back to 1 = dissipation + energy left in the networks >= 0.

    Smooth path, 4000 samples; trapezoid sums err by (pi/4000)^2/12 times a second derivative of
    at most some hundred: 1e-4 of the work done in the loop.
    """
    base = Rubber(1e6, *zip(*series, strict=True), strain_energy=law, bulk_modulus=1e10)
    time = np.linspace(0.0, 1.0, 4001)
    half = np.sin(2 * np.pi * time) ** 2
    stretch = np.exp(half * np.where(time < 0.5, np.log(first), np.log(second)))
    stress = uniaxial_stress(base, time, stretch)
    work = trapezoid(stress, stretch)
    done = trapezoid(np.abs(stress * np.gradient(stretch, time)), time)
    rate, stored = dissipated(base, time, stretch)
    assert (rate >= -1e-12 * rate.max()).all()
    assert work >= -1e-10 * done
    assert work == pytest.approx(trapezoid(rate, time) + stored[-1], rel=1e-3, abs=1e-4 * done)


@given(SERIES_OF_TERMS, st.floats(-3.0, 3.0), st.sampled_from(LAWS))
@settings(max_examples=40, deadline=None, derandomize=True)
def test_cyclic_shear_costs_what_its_loss_modulus_says(series, amplitude, law):
    """Second cycle from rest: work >= 0, for every strain energy the same (the base loses none)."""
    base = Rubber(1e6, *zip(*series, strict=True), strain_energy=law, bulk_modulus=1e10)
    plain = Rubber(1e6, *zip(*series, strict=True), bulk_modulus=1e10)
    time = cyclic(2 * np.pi, 1, 1000)
    shear = amplitude * np.sin(2 * np.pi * time)
    work = [trapezoid(simple_shear_stress(r, time, shear), shear) for r in (base, plain)]
    scale = base.glassy_modulus * max(amplitude**2, 1e-12)
    assert work[1] >= -1e-12 * scale
    assert work[0] == pytest.approx(work[1], abs=1e-4 * scale)


def test_small_and_large_steps_share_one_recurrence():
    """Steps of 1e-3 tau (power series) and of 50 tau against the ramp's closed form.

    Y = 1 + r t from rest at Y = 1: A = Y - r tau (1 - exp(-t/tau)).
    """
    for tau, samples in ((100.0, 11), (1.0, 5001), (0.01, 3)):
        time = np.linspace(0.0, 1.0, samples)
        inverse = 1.0 + 0.5 * time
        found = network_states(np.array([tau]), time, inverse[:, None], rest=(1.0,))[:, 0, 0]
        expected = inverse + 0.5 * tau * np.expm1(-time / tau)
        assert found == pytest.approx(expected, rel=1e-12)


def test_an_elastic_rubber_needs_no_memory():
    base = Rubber(3e6, strain_energy=Yeoh(0.1, 0.01))
    assert simple_shear_stress(base, [0.0, 1.0], [0.0, 0.1]) == pytest.approx(
        [0.0, 1e5 * (1 + 0.2 * 0.01 + 0.03 * 1e-4)]
    )
    assert uniaxial_stress(base, [0.0], [1.0]) == pytest.approx([0.0])


@pytest.mark.parametrize(
    ("time", "driven", "message"),
    [
        ([0.0, 1.0, 0.5], [1.0, 1.0, 1.0], r"time must not fall \[s\]; got 0.5 at index 2"),
        ([0.0, 1.0], [1.0], "same length, at least 1; got 2 and 1"),
        ([], [], "same length, at least 1; got 0 and 0"),
        ([0.0, 1.0], [1.0, np.nan], "nan at index 1"),
        ([0.0, np.inf], [1.0, 1.0], r"time .* inf at index 1"),
    ],
)
def test_bad_histories_are_named(time, driven, message):
    for respond in (uniaxial_stress, simple_shear_stress):
        with pytest.raises(InputError, match=message):
            respond(rubber(), time, driven)


def test_a_stretch_of_zero_is_refused():
    with pytest.raises(InputError, match="stretch must be greater than zero; got 0 at index 1"):
        uniaxial_stress(rubber(), [0.0, 1.0], [1.0, 0.0])
