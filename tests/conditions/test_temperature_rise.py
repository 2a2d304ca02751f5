"""The heat of a sliding contact against closed forms and an independent integral."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import k0e

import gripscale as gs
from gripscale.conditions import (
    LossDepth,
    ThermalProperties,
    harmonic_at_surface,
    harmonic_decay,
    harmonic_where_lost,
    uniform_at_surface,
    uniform_where_lost,
)
from gripscale.conditions.flash_temperature import ierfc
from tests.samples import THERMAL

KAPPA, D = 0.25, THERMAL.diffusivity
SURFACE = LossDepth(0.0)


def test_diffusivity():
    assert pytest.approx(0.25 / (1150.0 * 1500.0)) == D


def mean_over_depths(function, mean, deepest=math.inf):
    """The mean of a function of the depth over the gamma distribution of shape 3, by quadrature.

    The function vanishes below the `deepest`, the distribution from 60/b on.
    """
    b = 3.0 / mean
    end = min(60.0, b * deepest)
    return quad(lambda s: 0.5 * s**2 * math.exp(-s) * function(s / b), 0.0, end, epsabs=0.0)[0]


@pytest.mark.parametrize("speed", [0.0, 1e-3, 10.0])
@pytest.mark.parametrize("mean", [1e-4, 1e-6])
def test_a_moving_harmonic_source(mean, speed):
    """A source at depth z, D (T'' - k^2 T) = v dT/dx below and above it, T'(0) = 0: exp(-m z)."""
    k = 1e4
    m = harmonic_decay(k, k, speed, THERMAL)
    assert m**2 == pytest.approx(k**2 + 1j * k * speed / D, rel=1e-12)
    real, imaginary = (
        mean_over_depths(lambda z, part=part: getattr(np.exp(-m * z), part), mean, 40.0 / m.real)
        for part in ("real", "imag")
    )
    found = harmonic_at_surface(m, LossDepth(mean), THERMAL)
    assert found == pytest.approx((real + 1j * imaginary) / (KAPPA * m), rel=1e-6)


def test_a_surface_source_is_the_limit_of_a_shallow_one():
    m = harmonic_decay(1e4, 1e4, 0.3, THERMAL)
    at_surface = harmonic_at_surface(m, SURFACE, THERMAL)
    assert at_surface == pytest.approx(1.0 / (KAPPA * m), rel=1e-12)
    assert harmonic_where_lost(m, SURFACE, THERMAL) == pytest.approx(at_surface, rel=1e-12)
    shallow = LossDepth(1e-12)
    assert harmonic_at_surface(m, shallow, THERMAL) == pytest.approx(at_surface, rel=1e-6)


@pytest.mark.parametrize("time", [1e-6, 1e-3, 1.0, 1e3])
@pytest.mark.parametrize("mean", [1e-2, 1e-4, 1e-6])
def test_uniform_heat_in_depth(mean, time):
    """The mean of Carslaw & Jaeger's plane source, q l ierfc(z/l)/kappa with l = 2 sqrt(D t)."""
    length = 2.0 * math.sqrt(D * time)
    spread = mean_over_depths(lambda z: float(ierfc(z / length)), mean, 7.0 * length)
    exact = length * spread / KAPPA
    found = uniform_at_surface(time, LossDepth(mean), THERMAL)
    assert found == pytest.approx(exact, rel=1e-7, abs=0.0)


def test_uniform_heat_at_the_surface():
    exact = 2.0 * math.sqrt(0.3 / (math.pi * KAPPA * 1150.0 * 1500.0))
    assert uniform_at_surface(0.3, SURFACE, THERMAL) == pytest.approx(exact, rel=1e-12)
    assert uniform_where_lost(0.3, SURFACE, THERMAL) == pytest.approx(exact, rel=1e-12)
    assert uniform_at_surface(0.0, SURFACE, THERMAL) == 0.0


@pytest.mark.parametrize("mean", [1e-5, 1e-3])
def test_what_is_lost_quickly_stays_where_it_is(mean):
    """Before it spreads, heat warms each depth by itself: mean of s(z)^2 t / (rho c)."""
    time = 1e-6 * mean**2 / D
    density_squared = 3.0 / 16.0 * 3.0 / mean
    found = uniform_where_lost(time, LossDepth(mean), THERMAL)
    # conduction changes it by about the spread over the mean depth
    assert found == pytest.approx(density_squared * time / (1150.0 * 1500.0), rel=5e-3)


def test_averages_over_depths_against_sampled_depths():
    depth, length = LossDepth(2e-4), 3e-4
    draw = np.random.default_rng(1)
    z, other = draw.gamma(3.0, 2e-4 / 3.0, (2, 1_000_000))
    m = 4e3 + 3e3j
    for found, sample in (
        (depth.decay(m), np.exp(-m * z)),
        (depth.decay_between(m), np.exp(-m * np.abs(z - other))),
        (depth.spread(length), ierfc(z / length)),
        (depth.spread(length, "difference"), ierfc(np.abs(z - other) / length)),
        (depth.spread(length, "sum"), ierfc((z + other) / length)),
    ):
        error = np.std(sample) / 1000.0
        assert abs(found - sample.mean()) < 4.0 * error


def test_the_loss_under_a_harmonic_lies_where_its_shear_is():
    """(k z)^2 exp(-2 k z) has its mean at 3/(2 k), and weighs exp(-m z) as a gamma of shape 3."""
    k, m = 2e3, 5e3

    def density(z):
        return 4.0 * k * (k * z) ** 2 * math.exp(-2.0 * k * z)

    depth = LossDepth.under(k)
    assert quad(density, 0.0, 40.0 / k)[0] == pytest.approx(1.0, rel=1e-8)
    mean = quad(lambda z: z * density(z), 0.0, 40.0 / k)[0]
    assert depth.mean == pytest.approx(mean, rel=1e-8)
    weighed = quad(lambda z: math.exp(-m * z) * density(z), 0.0, 40.0 / k)[0]
    assert depth.decay(np.array(m)) == pytest.approx(weighed, rel=1e-8)


@pytest.mark.parametrize("peclet", [0.1, 1.0, 10.0])
def test_the_peak_under_a_moving_band_is_jaegers(peclet):
    """A band of half width b, v b/(2 D) = `peclet`: the peak within 2 % of Jaeger's integral.

    T = 2 D q/(pi kappa v) int exp(u) K_0(|u|) du, Carslaw & Jaeger, sec. 10.7. The bands here come
    again after a length in which the trail of one has cooled; what is left of it is subtracted.
    """
    b = 1e-4
    speed, apart, points = 2.0 * D * peclet / b, 400.0 * b, 2**16
    x = np.arange(points) * apart / points
    heat = np.fft.rfft((x < 2.0 * b) * 1.0)
    k = 2.0 * np.pi * np.arange(1, heat.size) / apart
    heat[0] = 0.0
    m = harmonic_decay(k, k, speed, THERMAL)
    heat[1:] *= harmonic_at_surface(m, SURFACE, THERMAL)
    temperature = np.fft.irfft(heat, points)
    assert np.ptp(temperature) == pytest.approx(_jaeger_peak(b, speed), rel=0.02)


def _jaeger_peak(b, speed):
    half = speed * b / (2.0 * D)

    def weight(u):  # exp(u) K_0(|u|) without overflow
        return math.exp(u - abs(u)) * k0e(abs(u)) if u != 0.0 else 0.0

    def at(place):
        low, high = place - half, place + half
        inside = [0.0] if low < 0.0 < high else None
        return quad(weight, low, high, points=inside, limit=200)[0]

    return 2.0 * D / (math.pi * KAPPA * speed) * max(map(at, np.linspace(-half, half, 81)))


@pytest.mark.parametrize(
    ("name", "value"), [("conductivity", 0.0), ("density", -1.0), ("specific_heat", math.nan)]
)
def test_thermal_properties_must_be_positive(name, value):
    values = {"conductivity": 0.25, "density": 1150.0, "specific_heat": 1500.0, name: value}
    with pytest.raises(gs.InputError, match=name):
        ThermalProperties(**values)


@pytest.mark.parametrize("mean", [-1.0, math.inf])
def test_a_depth_must_be_one_that_exists(mean):
    with pytest.raises(gs.InputError, match="mean"):
        LossDepth(mean)
