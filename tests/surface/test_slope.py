"""Rms slope down to each wavelength: exact on a sine, statistical on rough surfaces.

Rough surfaces are compared with what they were drawn from. A band of wavenumbers from q to Q of a
line of length L holds (Q - q) L/(2 pi) independent waves; its power scatters by one over the root
of that, and by 1.4 times as much in windows tapered by Hann's (Welch 1967).
"""

import math

import numpy as np
import pytest
from scipy.special import gamma

import gripscale as gs
from gripscale.surface import areal_spectrum, self_affine_profile, slope_by_wavelength

STEP, LENGTH, AMPLITUDE = 5e-5, 2e-3, 1e-4
SINE_SLOPE = math.sqrt(2.0) * math.pi * AMPLITUDE / LENGTH
HURST, XI, HEIGHT = 0.7, 40e-3, 2.5e-3


def sine(points=8000):
    x = STEP * np.arange(points)
    return gs.Profile(x, AMPLITUDE * np.sin(2.0 * np.pi * x / LENGTH))


def rough(hurst=HURST, step=6.25e-5, seeds=4):
    return [self_affine_profile(hurst, XI, HEIGHT, 0.8, step, seed) for seed in range(seeds)]


def added(first, last):
    """Return the mean square slope of the waves from `first` to `last` [m] of these lines.

    Their covariance is 1 - (l/xi)^2H at small l, whose transform is C_1 ~ q^(-1 - 2H).
    """
    power = 2.0 - 2.0 * HURST
    level = HEIGHT**2 / np.pi * gamma(2.0 * HURST + 1.0) * np.sin(np.pi * HURST) / XI ** (2 * HURST)
    q, more = 2.0 * np.pi / first, 2.0 * np.pi / last
    return float(level * (more**power - q**power) / power)


def isotropic(points, step, seed):
    """Return a periodic map, H = 0.3, of waves from 8 steps up, and its rms gradient."""
    q = 2.0 * np.pi * np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(points, step)], indexing="ij"))
    kept = (q > 0.0) & (q < 2.0 * np.pi / (8.0 * step))
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((points, points)))
    wave = np.where(kept, noise / np.where(kept, q, 1.0) ** 1.3, 0.0)
    z = np.fft.ifft2(wave).real
    gradient = np.sqrt(np.sum(np.abs(q * wave) ** 2)) / points**2
    scale = 1e-4 / z.std()
    x = step * np.arange(points)
    return gs.HeightMap(x, x, scale * z), float(scale * gradient)


def test_a_sine_has_its_slope_from_its_wavelength_on():
    slopes = slope_by_wavelength(sine())
    # Hann's window leaks into the next two of the 50 waves of a window: (1 + 1/(3 50^2)) in square
    exact = pytest.approx(SINE_SLOPE, rel=1e-4)
    assert slopes.down_to(LENGTH / 1.05, "profile") == exact
    assert slopes.down_to(4.0 * STEP, "profile") == exact
    assert slopes.down_to(1.1 * LENGTH, "profile") < 1e-3 * SINE_SLOPE
    assert slopes.down_to(10.0, "profile") == 0.0
    assert slopes.reaches(0.9 * SINE_SLOPE, "profile") == pytest.approx(LENGTH, rel=1e-9)
    assert math.isnan(slopes.reaches(1.1 * SINE_SLOPE, "profile"))


@pytest.mark.parametrize("along", [True, False])
def test_grooves_on_a_map_are_not_taken_for_isotropic(along):
    x = STEP * np.arange(400)
    wave = AMPLITUDE * np.sin(2.0 * np.pi * x / LENGTH)
    z = np.broadcast_to(wave[:, None] if along else wave, (400, 400))
    slopes = slope_by_wavelength(gs.HeightMap(x, x, z))
    # a single wave is spread over a tenth of a decade, and q^3 C drawn straight between points
    assert slopes.down_to(LENGTH / 1.5) == pytest.approx(SINE_SLOPE, rel=0.06)
    # ten waves: Hann's window adds 1/(6 10^2)
    lines = slopes.down_to(LENGTH / 1.5, "profile")
    assert lines == pytest.approx(SINE_SLOPE if along else 0.0, rel=2e-3, abs=1e-12)


def test_waves_longer_than_a_window_count_along_the_lines_of_a_map():
    x = STEP * np.arange(400)
    wave = AMPLITUDE * np.sin(2.0 * np.pi * x * 3.0 / (400 * STEP))
    slopes = slope_by_wavelength(gs.HeightMap(x, x, np.broadcast_to(wave[:, None], (400, 400))))
    exact = math.sqrt(2.0) * math.pi * AMPLITUDE * 3.0 / (400 * STEP)
    # three waves: Hann's window adds 1/(6 3^2), the line taken out of each takes some of it away
    assert slopes.down_to(LENGTH, "profile") == pytest.approx(exact, rel=0.05)


def test_lines_of_a_self_affine_surface():
    slopes = slope_by_wavelength(rough())
    for first, last in ((2e-3, 1e-3), (1e-3, 0.5e-3)):
        square = [slopes.down_to(length, "profile") ** 2 for length in (last, first)]
        # 4 x 400 waves or more: 0.035 is two standard deviations
        assert square[0] - square[1] == pytest.approx(added(first, last), rel=0.07)


def test_surface_of_lines_is_that_of_the_spectrum_the_theories_take():
    slopes = slope_by_wavelength(rough())
    areal = areal_spectrum(slopes.line)
    assert slopes.down_to(1e-3) == areal.rms_gradient(1e-3)
    found = slopes.reaches(areal.rms_gradient(1e-3))
    assert found == pytest.approx(1e-3, rel=1e-9)
    # waves seen at an angle: sqrt(2) times the root of sqrt(pi)/2 Gamma(H + 1)/Gamma(H + 1/2)
    seen = 0.5 * math.sqrt(math.pi) * gamma(HURST + 1.0) / gamma(HURST + 0.5)
    ratio = slopes.down_to(0.5e-3) / slopes.down_to(0.5e-3, "profile")
    assert ratio == pytest.approx(math.sqrt(2.0 * seen), rel=0.02)


def test_a_map_and_its_lines_tell_the_same_gradient():
    surface, gradient = isotropic(512, 5e-5, seed=3)
    whole, lines = slope_by_wavelength(surface), slope_by_wavelength(surface.lines())
    # within the 3/8 of the map that Hann's window weighs, waves of half the slope scatter by 1 %
    assert whole.down_to(whole.resolution_limit) == pytest.approx(gradient, rel=0.03)
    # all waves end at 8 steps: nothing is seen at an angle, and the gradient is sqrt(2) the slope
    slope = whole.down_to(whole.resolution_limit, "profile")
    assert gradient / slope == pytest.approx(math.sqrt(2.0), rel=0.03)
    # of lines alone, isotropy gives it back; where all waves end within one bin the fit is rough
    assert lines.down_to(lines.resolution_limit) == pytest.approx(gradient, rel=0.06)


def test_power_law_continues_what_was_not_measured():
    measured = rough()
    known = slope_by_wavelength(measured)
    coarse = slope_by_wavelength([gs.Profile(p.x, p.z, reliable=2e-3) for p in measured])
    assert coarse.resolution_limit == 2e-3
    for of in ("surface", "profile"):
        assert coarse.power_law(of).hurst == pytest.approx(HURST, abs=0.05)
        # three octaves at an exponent 0.05 off: 0.05 ln 8 of the part added, two thirds of all
        assert coarse.down_to(0.25e-3, of) == pytest.approx(known.down_to(0.25e-3, of), rel=0.05)
        law, wanted = coarse.power_law(of), known.down_to(0.5e-3, of) ** 2
        assert law.added(law.ratio(wanted)) == pytest.approx(wanted)


def test_noise_is_not_continued():
    noise = np.random.default_rng(1).standard_normal(8000)
    slopes = slope_by_wavelength(gs.Profile(STEP * np.arange(8000), 1e-5 * noise))
    with pytest.raises(gs.InputError, match="must fall as that of a self-affine surface"):
        slopes.power_law("profile")
    assert math.isnan(slopes.down_to(STEP, "profile"))


def test_wavelengths_run_from_the_longest_to_the_shortest_carried():
    slopes = slope_by_wavelength(rough(seeds=1))
    lengths = slopes.wavelength
    assert lengths[0] == pytest.approx(0.2, rel=0.01)
    assert lengths[-1] == pytest.approx(2.5e-4)
    told = [slopes.down_to(float(length), "profile") for length in lengths]
    assert (np.diff(told) >= 0.0).all()
