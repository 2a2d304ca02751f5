"""Power spectra against Parseval, closed forms, a ring of waves and a surface made to measure."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy import signal, special
from scipy.special import gamma, j1

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.surface import (
    ArealSpectrum,
    Profile,
    ProfileSpectrum,
    areal_spectrum,
    map_spectrum,
    profile_spectrum,
)

STEP = 1e-4
HURST = 0.8


def wavy(points=4000, waves=40, amplitude=2e-4):
    """Return a cosine that fits the line a whole number of times."""
    x = STEP * np.arange(points)
    return Profile(x, amplitude * np.cos(2 * np.pi * waves * np.arange(points) / points))


def rough(points=4096, seed=1):
    return Profile(STEP * np.arange(points), np.random.default_rng(seed).normal(0, 1e-4, points))


def isotropic_map(size, step, seed):
    """Return one period of a surface with random phases, and the spectrum it was made of.

    Flat up to 8 waves a side, C ~ q^(-2 - 2H) above, nothing beyond a quarter of the sampling.
    """
    unit = 2 * np.pi / (size * step)
    number = np.fft.fftfreq(size, 1 / size)
    q = unit * np.hypot(number[:, None], number)
    knee, last = 8 * unit, unit * size / 4

    def density(at):
        flat = 1e-16 * np.maximum(at / knee, 1.0) ** (-2 - 2 * HURST)
        return np.where((at > 0.5 * unit) & (at <= last), flat, 0.0)

    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((size, size)))
    heights = np.fft.ifft2(np.sqrt(density(q)) * noise / np.abs(noise)).real * size**2 * unit
    points = np.geomspace(unit, last, 200)
    return heights, ArealSpectrum(points, density(points))


def test_a_wave_carries_its_variance_at_its_wavenumber():
    """Parseval: exact for a line of whole periods, to rounding."""
    found = profile_spectrum(wavy(), taper="none")
    carried = found.density * found.width
    assert found.wavenumber[np.argmax(carried)] == pytest.approx(2 * np.pi * 40 / (4000 * STEP))
    assert carried.max() == pytest.approx(0.5 * 2e-4**2, rel=1e-12, abs=0)
    assert found.rms_height == pytest.approx(2e-4 / np.sqrt(2), rel=1e-12, abs=0)
    k = 2 * np.pi * 40 / (4000 * STEP)
    assert found.rms_slope() == pytest.approx(k * found.rms_height, rel=1e-9, abs=0)
    assert found.rms_slope(2.1 * np.pi / k) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("points", [4096, 4097])
def test_the_sum_is_the_variance(points):
    profile = rough(points)
    found = profile_spectrum(profile, taper="none", steepest=np.inf)
    assert found.rms_height**2 == pytest.approx(profile.z.var(), rel=1e-12, abs=0)
    assert found.averaged(5).rms_height == pytest.approx(found.rms_height, rel=1e-12, abs=0)
    assert len(found.averaged(5).wavenumber) < 20


@pytest.mark.parametrize(("points", "taper"), [(50, "hann"), (51, "hann"), (50, "none")])
def test_windows_are_those_of_another_code(points, taper):
    """Welch's spectrum by scipy, of windows of an even and of an odd number of points."""
    z = np.random.default_rng(3).normal(0.0, 1e-5, 1007).cumsum()
    found = profile_spectrum(
        Profile(STEP * np.arange(z.size), z), window=points * STEP, taper=taper
    )
    weights, trend = {"hann": ("hann", "linear"), "none": ("boxcar", "constant")}[taper]
    detrend = partial(signal.detrend, type=trend)
    _, expected = signal.welch(z, 1.0 / STEP, weights, points, detrend=detrend)
    np.testing.assert_allclose(2.0 * np.pi * found.density, expected[1:], rtol=1e-10)


def test_several_profiles_are_averaged_by_their_length():
    first, second = wavy(4000), wavy(2000, 20, 4e-4)
    found = profile_spectrum([first, second], window=2000 * STEP, taper="none")
    mean = (2 * 0.5 * 2e-4**2 + 0.5 * 4e-4**2) / 3
    assert found.rms_height**2 == pytest.approx(mean, rel=1e-9, abs=0)


def test_missing_heights_are_interpolated_and_counted():
    """Every 50th height of a wave of 100 steps: the chord is off by (2 pi/100)^2/2 of it there."""
    z = wavy().z.copy()
    z[5::50] = np.nan
    found = profile_spectrum(Profile(STEP * np.arange(4000), z), taper="none")
    assert found.interpolated == pytest.approx(0.02)
    assert found.rms_height == pytest.approx(2e-4 / np.sqrt(2), rel=1e-3, abs=0)


def test_the_spectrum_of_a_map_is_that_it_was_made_of():
    """Amplitudes are exact, only phases random: what is left is the curvature of C within a ring,
    and the rings cut by the spectrum's end. A window sees the waves that fall under it."""
    z, truth = isotropic_map(512, STEP, 0)
    found = map_spectrum(z, x_step=STEP, y_step=STEP, taper="none", per_decade=40)
    inner = (found.wavenumber > 10 * truth.wavenumber[0]) & (
        found.wavenumber < 0.97 * truth.wavenumber[-1]
    )
    assert inner.sum() > 30
    assert found.density[inner] == pytest.approx(truth.at(found.wavenumber[inner]), rel=0.01, abs=0)
    gx, gy = (np.fft.ifft2(np.fft.fft2(z) * 1j * k).real for k in _wavenumbers(512))
    rms = np.sqrt(np.mean(gx**2 + gy**2))
    assert found.rms_gradient() == pytest.approx(rms, rel=0.005, abs=0)
    assert found.profile_rms_slope() == pytest.approx(np.sqrt(np.mean(gx**2)), rel=0.005, abs=0)
    tilted = z + 0.05 * STEP * np.arange(512)[:, None]
    measured = map_spectrum(tilted, x_step=STEP, y_step=STEP, per_decade=10)
    assert measured.rms_gradient() == pytest.approx(rms, rel=0.05, abs=0)


def _wavenumbers(size):
    k = 2 * np.pi * np.fft.fftfreq(size, STEP)
    k[size // 2] = 0.0
    return k[:, None], k


def test_missing_heights_of_a_map_are_filled_and_counted():
    x = np.arange(64.0)
    z = np.cos(2 * np.pi * x / 64)[:, None] * np.ones(32)
    whole = map_spectrum(z, x_step=STEP, y_step=STEP, taper="none")
    z[10, ::2] = np.nan
    z[:, 3] = np.nan  # a whole line: its neighbours, which are the same, stand on both sides
    found = map_spectrum(z, x_step=STEP, y_step=STEP, taper="none")
    assert found.interpolated == pytest.approx((64 + 16) / (64 * 32))
    assert found.density[0] == pytest.approx(whole.density[0], rel=1e-3, abs=0)


@pytest.mark.parametrize("hurst", [0.3, 0.5, 0.8, 1.0])
def test_both_ways_to_the_surface_agree_on_a_power_law(hurst):
    """q^3 C linear in log q between ten points a decade follows a power of up to 1 to h^2/12, h =
    0.23: 0.5 %."""
    q = np.geomspace(1e2, 1e5, 31)
    lines = ProfileSpectrum(q, 1e-12 * q ** (-1 - 2 * hurst))
    general, closed = areal_spectrum(lines), _of_power_law(lines, hurst)
    assert general.density == pytest.approx(closed.density, rel=5e-3, abs=0)
    naive = lines.density / (2 * np.pi * q)
    assert closed.density / naive == pytest.approx(
        np.full(31, {0.3: 1.366, 0.5: np.pi / 2, 0.8: 1.839, 1.0: 2.0}[hurst]), rel=1e-3
    )


def _of_power_law(lines, hurst):
    """Return C = C_1 / (2 sqrt(pi) q Gamma(H + 1/2) / Gamma(H + 1)) where self-affine."""
    ratio = special.gamma(hurst + 0.5) / special.gamma(hurst + 1.0)
    q = lines.wavenumber
    return ArealSpectrum(q, lines.density / (2.0 * np.sqrt(np.pi) * q * ratio))


def _power_law():
    q = np.geomspace(1e2, 1e5, 31)
    return ProfileSpectrum(q, 1e-12 * q ** (-1 - 2 * HURST))


def test_lines_of_an_isotropic_map_lead_back_to_its_spectrum():
    """All 512 lines of a map with a knee and an end. Their mean knows no phases: what is left is
    the sum over plane waves in place of the integral, and ten points a decade: 4 % of C at single
    points, 0.2 % of the moments."""
    z, truth = isotropic_map(512, STEP, 3)
    x = STEP * np.arange(512)
    lines = profile_spectrum([Profile(x, line) for line in z.T], taper="none")
    keep = lines.wavenumber < 1.02 * truth.wavenumber[-1]
    seen = ProfileSpectrum(lines.wavenumber[keep], lines.density[keep], lines.width[keep])
    found = areal_spectrum(seen)
    assert found.rms_gradient() == pytest.approx(truth.rms_gradient(), rel=0.005, abs=0)
    assert found.profile_rms_slope() == pytest.approx(lines.rms_slope(), rel=0.005, abs=0)
    inner = (found.wavenumber > 1e3) & (found.wavenumber < 1e4)
    assert inner.sum() >= 8
    assert found.density[inner] == pytest.approx(truth.at(found.wavenumber[inner]), rel=0.05, abs=0)


def test_moments_of_a_power_law():
    """2 pi int q^3 C dq in closed form; the interpolation's own error as above."""
    c, h = 1e-10, 0.8
    q = np.geomspace(1e2, 1e5, 61)
    spectrum = ArealSpectrum(q, c * q ** (-2 - 2 * h))
    for last, smallest in ((1e5, None), (1e4, 2 * np.pi / 1e4)):
        square = 2 * np.pi * c * (last ** (2 - 2 * h) - 1e2 ** (2 - 2 * h)) / (2 - 2 * h)
        assert spectrum.rms_gradient(smallest) ** 2 == pytest.approx(square, rel=1e-3, abs=0)
    square = 2 * np.pi * c * (1e2 ** (-2 * h) - 1e5 ** (-2 * h)) / (2 * h)
    assert spectrum.rms_height**2 == pytest.approx(square, rel=5e-3, abs=0)
    assert (spectrum.at([50.0, 2e5]) == 0.0).all()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ProfileSpectrum([1.0, 2.0], [1.0]), "the same length, at least 2; got 2 and 1"),
        (lambda: ArealSpectrum([2.0, 1.0], [1.0, 1.0]), "wavenumber must increase; got 1 rad/m"),
        (lambda: ArealSpectrum([1.0, 2.0], [1.0, -1.0]), "density must not be negative; got -1"),
        (lambda: ProfileSpectrum([1.0, 2.0], [1.0, 1.0], [1.0]), "width must have 2 entries"),
        (lambda: profile_spectrum([]), "profile must be a Profile or a list"),
        (lambda: profile_spectrum(rough(), window=1.0), "window must be from 0.0016 m to 0.4096 m"),
        (lambda: profile_spectrum(rough(), taper="welch"), "taper must be one of hann, none"),
        (lambda: map_spectrum([1.0], x_step=1, y_step=1), r"z must be a table of heights \[m\]"),
        (
            lambda: map_spectrum(np.full((16, 16), np.nan), x_step=1, y_step=1),
            "z must have some heights; got 256 points, all missing",
        ),
        (lambda: areal_spectrum(ProfileSpectrum([1.0, 2.0], [1.0, 1.0])), "at least 4 points"),
        (lambda: _power_law().rms_slope(1e-6), "smallest_wavelength must be among those"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(InputError, match=message):
        make()


# A surface known by its spectrum: closed forms of its correlation and lines, and its lines.

FIRST, LAST = 1e3, 1e5


def band(density=1e-14):
    """Return a constant spectrum between two wavenumbers."""
    q = np.geomspace(FIRST, LAST, 400)
    return gs.Spectrum(q, np.full(q.size, density), name="band")


def self_affine(hurst=0.8):
    q = np.geomspace(FIRST, LAST, 200)
    return gs.Spectrum(q, 1e-14 * (q / FIRST) ** (-2.0 - 2.0 * hurst), name="self-affine")


def test_correlation_of_a_band_is_the_closed_form():
    """int q (1 - J_0(q l)) dq = q^2/2 - q J_1(q l)/l; the plateau is twice the variance.

    200 points a decade do not resolve J_0 at large q l, where a white band is the worst case.
    """
    lag = np.geomspace(1e-6, 1e-1, 60)
    found = band().height_difference(lag)
    ends = [0.5 * q**2 - q * j1(q * lag) / lag for q in (FIRST, LAST)]
    np.testing.assert_allclose(found.value, 4e-14 * np.pi * (ends[1] - ends[0]), rtol=5e-3)
    assert found.value[-1] == pytest.approx(2.0 * band().rms_height ** 2, rel=5e-3)


def test_correlation_at_small_lags_is_the_slope_of_lines():
    found = self_affine().height_difference([1e-8])
    assert np.sqrt(found.value[0]) / 1e-8 == pytest.approx(
        self_affine().profile_rms_slope(), rel=2e-3
    )


def test_spectrum_of_lines_of_a_power_law():
    """C_1 = 2 sqrt(pi) q C Gamma(H + 1/2)/Gamma(H + 1) far from the ends."""
    hurst, q = 0.8, np.geomspace(1.1e3, 4e3, 10)
    surface = self_affine(hurst)
    closed = 2.0 * np.sqrt(np.pi) * q * surface.at(q) * gamma(hurst + 0.5) / gamma(hurst + 1.0)
    np.testing.assert_allclose(surface.of_lines(q), closed, rtol=0.01)
    assert surface.of_lines([FIRST, 1.1 * LAST])[1] == 0.0


def test_lines_have_the_stated_height_and_slope():
    surface = self_affine()
    lines, correlation = surface.lines(footprint=0.1)
    assert [line.name for line in lines] == [f"self-affine {n}" for n in (1, 2, 3, 4)]
    for line in lines:
        assert line.z.std() == pytest.approx(surface.rms_height, rel=0.03)
        assert np.gradient(line.z, line.step).std() == pytest.approx(
            surface.profile_rms_slope(), rel=0.05
        )
        assert line.resolution_limit == pytest.approx(2.0 * np.pi / LAST)
    again, _ = surface.lines(footprint=0.1)
    np.testing.assert_array_equal(again[2].z, lines[2].z)
    assert not np.array_equal(lines[0].z, lines[1].z)
    measured = gs.height_difference(lines, steepest=np.inf)
    at = np.geomspace(1e-5, 1e-3, 5)
    logs = [(np.log(c.lag), np.log(c.value)) for c in (measured, correlation)]
    found, known = (np.exp(np.interp(np.log(at), *curve)) for curve in logs)
    np.testing.assert_allclose(found, known, rtol=0.05)


def test_heights_of_lines_are_gaussian():
    lines, _ = band().lines(footprint=0.1)
    z = np.concatenate([line.z for line in lines])
    assert np.mean(z**4) / np.mean(z**2) ** 2 == pytest.approx(3.0, abs=0.1)
    assert np.mean(z**3) / np.mean(z**2) ** 1.5 == pytest.approx(0.0, abs=0.05)


def test_a_cut_off_leaves_shorter_waves_out_of_lines():
    fine, _ = self_affine().lines(0.1)
    coarse, _ = self_affine().lines(0.1, smallest_wavelength=1e-3)
    assert coarse[0].step == pytest.approx(1e-3 / 8)
    assert fine[0].step == pytest.approx(2.0 * np.pi / LAST / 8)


def test_long_waves_are_left_out_where_they_hold_most_of_the_heights():
    surface = self_affine()
    whole, short = (surface.lines(footprint)[0][0] for footprint in (0.1, 5e-4))
    assert whole.z.std() == pytest.approx(surface.rms_height, rel=0.03)
    assert short.z.std() < 0.7 * surface.rms_height
    cut = surface.without_long_waves(1e-3)
    assert cut.rms_height < 0.7 * surface.rms_height
    assert cut.rms_gradient() > 0.8 * surface.rms_gradient()


def test_what_is_refused():
    with pytest.raises(InputError, match="phases must be one of real, worn, random; got 'fixed'"):
        replace(band(), phases="fixed")
    with pytest.raises(InputError, match="smallest_wavelength must be at least"):
        gs.Spectrum([1.0, 1e9], [1e-14, 1e-30]).lines(footprint=1.0)


def test_the_finding_says_what_a_spectrum_does_not():
    finding = band().finding
    assert "does not tell its phases" in finding.sentence
    assert np.isnan(finding.area)
    assert replace(band(), phases="random").finding.area == pytest.approx(2.9 - 1.0)
