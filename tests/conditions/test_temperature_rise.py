"""The heat of a sliding contact against closed forms and an independent integral."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma, k0e

import gripscale as gs
from gripscale.chain.heat import WaveHeat
from gripscale.conditions import (
    LossDepth,
    ThermalProperties,
    harmonic_at_surface,
    harmonic_decay,
    harmonic_where_lost,
    uniform_at_surface,
    uniform_where_lost,
)
from gripscale.conditions.flash_temperature import (
    LossLayers,
    PassingHarmonics,
    ierfc,
    uniform_from_others,
)
from tests.samples import THERMAL

KAPPA, D = 0.25, THERMAL.diffusivity
SURFACE = LossDepth(0.0)


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
    assert pytest.approx(0.25 / (1150.0 * 1500.0)) == D
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


# Harmonics of heat switched on when a contact begins: time integrals and both limits.


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


# Uniform heat of sources at different depths, where each loses its energy.


def between_sampled_depths(depth, other, time):
    """Return q l/(2 kappa) (E ierfc(|Z - Z'|/l) + E ierfc((Z + Z')/l)) of sampled depths."""
    draw = np.random.default_rng(1)
    length = 2.0 * np.sqrt(THERMAL.diffusivity * time)
    z, source = (draw.gamma(3, each.mean / 3.0, 400_000) for each in (depth, other))
    both = ierfc(np.abs(z - source) / length) + ierfc((z + source) / length)
    return float(length * both.mean() / (2.0 * THERMAL.conductivity))


@pytest.mark.parametrize("ratio", [2.0, 8.0, 32.0])
@pytest.mark.parametrize("spread", [1.0, 3.0, 10.0])
def test_the_deeper_of_two_depths_decides(spread, ratio):
    """2 sqrt(D t) = `spread` times the deeper depth: 20 % off where both are near, 5 % else."""
    deep, shallow = LossDepth(1e-4), LossDepth(1e-4 / ratio)
    time = (0.5e-4 * spread) ** 2 / THERMAL.diffusivity
    tops = [uniform_at_surface(time, each, THERMAL) for each in (deep, shallow)]
    error = 0.05 if ratio > 2.0 or spread > 1.0 else 0.2
    for which in (0, 1):
        rise = uniform_from_others([1.0, 1.0], tops, which)
        assert rise == pytest.approx(between_sampled_depths(deep, shallow, time), rel=error)


def test_what_lies_deeper_than_the_heat_spreads_stays_cold():
    deep, shallow, time = LossDepth(1e-2), LossDepth(1e-5), 0.1
    tops = [uniform_at_surface(time, each, THERMAL) for each in (deep, shallow)]
    assert uniform_from_others([0.0, 1.0], tops, 0) < 0.01 * tops[1]


# Loss in layers against the closed forms of what it samples, and as the block tells it.

WAVELENGTH = 1e-3
K = 2.0 * np.pi / WAVELENGTH
PLANE = LossDepth.under(K)


def sampled(layers):
    """(k z)^2 exp(-2 k z) in layers that grow with depth."""
    edges = 1.5 * WAVELENGTH * np.linspace(0.0, 1.0, layers + 1) ** 2
    s = 2.0 * K * edges
    below = (1.0 + s + 0.5 * s**2) * np.exp(-s)
    return LossLayers.of(edges, -np.diff(below))


def errors(layers):
    """Errors of the temperatures it decides, relative to those where energy is lost."""
    one = sampled(layers)
    out = []
    for speed in (0.0, 1e-2, 1.0):
        m = harmonic_decay(K * np.arange(1.0, 6.0), K * np.arange(1.0, 6.0), speed, THERMAL)
        size = np.abs(harmonic_where_lost(m, PLANE, THERMAL)).max()
        for of in (harmonic_at_surface, harmonic_where_lost):
            out.append(float(np.abs(of(m, one, THERMAL) - of(m, PLANE, THERMAL)).max() / size))
    for time in (1e-4, 1e-2, 1.0, 1e3):
        size = uniform_where_lost(time, PLANE, THERMAL)
        for of in (uniform_at_surface, uniform_where_lost):
            out.append(abs(of(time, one, THERMAL) - of(time, PLANE, THERMAL)) / size)
    return out


def test_many_layers_are_the_distribution():
    """Even loss within a layer errs by the second order of its height."""
    coarse, fine = max(errors(20)), max(errors(80))
    assert coarse < 0.03
    assert fine < 2e-3
    assert fine < coarse / 10.0


def test_the_mean_depth_is_the_mean():
    assert sampled(200).mean == pytest.approx(PLANE.mean, rel=1e-3)
    assert sampled(200).share.sum() == pytest.approx(1.0, rel=1e-12)


RUBBER = gs.Rubber(1e6, [2e6, 4e6], [1e-4, 1e-5], bulk_modulus=1e11)


def solved(amplitude, **mesh):
    return gs.solve_scale(
        RUBBER, wavelength=WAVELENGTH, amplitude=amplitude, pressure=3e5, speed=3.0, **mesh
    )


def test_rows_lose_what_the_block_loses():
    wave = solved(1e-4)
    edges, lost = wave.loss_by_depth
    assert lost.sum() == pytest.approx(wave.friction_from_dissipation, rel=1e-12)
    assert edges.shape == (lost.size + 1,)
    assert edges[-1] == pytest.approx(1.5 * WAVELENGTH)


def test_full_contact_at_small_slope_loses_as_deep_as_a_half_plane():
    """Rows of finite height put the loss deeper, by half with twice the columns: 1.3 %, 0.7 %."""
    off = []
    for columns, rows in ((64, 14), (128, 20)):
        heat = WaveHeat.of(solved(1e-6, columns=columns, rows=rows), RUBBER)
        assert isinstance(heat.depth, LossLayers)
        off.append(heat.depth.mean / PLANE.mean - 1.0)
    assert 0.0 < off[1] < 0.01
    assert off[1] < 0.7 * off[0]


def test_a_wave_without_rows_is_taken_for_a_half_plane():
    wave = gs.theory.solve_half_plane(
        RUBBER, wavelength=WAVELENGTH, amplitude=1e-6, pressure=3e5, speed=3.0
    )
    assert wave.loss_by_depth is None
    assert WaveHeat.of(wave, RUBBER).depth.mean == pytest.approx(PLANE.mean, rel=1e-3)
