"""A surface known by its spectrum: closed forms of its correlation and lines, and its lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import gamma, j1

import gripscale as gs
from gripscale.core import InputError

FIRST, LAST = 1e3, 1e5


def band(density: float = 1e-14) -> gs.Spectrum:
    """Return a constant spectrum between two wavenumbers."""
    q = np.geomspace(FIRST, LAST, 400)
    return gs.Spectrum(q, np.full(q.size, density), name="band")


def self_affine(hurst: float = 0.8) -> gs.Spectrum:
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
