"""Roughness below the measurement: what is kept, what is added, and how well it does."""

import math
from functools import cache

import numpy as np
import pytest

import gripscale as gs
from gripscale.continuation import (
    ContinuedContact,
    FinerMeasurement,
    HurstExponent,
    contact_by_cut_off,
)
from gripscale.continuation.curve import BAND, cut_off_at
from gripscale.continuation.roughness import Intermittency, PeriodicLine
from gripscale.core.errors import InputError
from gripscale.model import Load
from gripscale.surface import HeightMap, Measured, Surface, self_affine_profile
from tests.samples import THREE_SINES
from tests.verification.families import tread
from tests.verification.withheld_octaves import coarser, intermittent

LOAD = {"pressure": 3e5, "speed": 0.3}


@cache
def fine_line() -> gs.Profile:
    """Return a Gaussian line of which coarser ones are parts."""
    return coarser(self_affine_profile(0.8, 2e-3, 0.6e-3, 0.2048, 25e-6, 1), 0)


@cache
def coarse_line() -> gs.Profile:
    return coarser(fine_line(), 2)


@cache
def continued(roughness=None, seed=0):
    """Return the coarse line continued to where the fine line ends."""
    end = fine_line().resolution_limit
    return contact_by_cut_off(
        tread(), coarse_line(), down_to=end, roughness=roughness, seed=seed, **LOAD
    )


@cache
def truth():
    return contact_by_cut_off(tread(), fine_line(), down_to=100e-6, **LOAD)


def test_measured_waves_stay_as_they_are():
    data = continued()
    measured = next(step for step in data.steps if math.isclose(step.wavelength, data.resolved))
    kept = data.steps[-1].lines[0].down_to(data.resolved)
    scale = np.abs(kept.waves).max()
    assert np.allclose(kept.waves, measured.lines[0].waves, atol=1e-12 * scale)
    direct = gs.solve_rough_contact(
        tread(), coarse_line(), smallest_wavelength=data.resolved, tolerance=None, **LOAD
    )
    # the same problem on another number of points
    assert measured.mean("friction_from_dissipation") == pytest.approx(
        direct.friction_from_dissipation, rel=0.02
    )


def test_two_octaves_of_a_gaussian_line_are_found_within_their_band():
    """The scatter of this one line is included: the added waves are others than the true ones."""
    found, true = continued(), truth()
    for name in ("contact_fraction", "friction_from_dissipation"):
        ratio = found.values(name)[-1] / true.values(name)[-1]
        assert abs(math.log(ratio)) < math.asinh(found.band[-1]), name
        # without continuation the friction is half as large and the area half as large again
        stopped = found.values(name)[found.octaves_below == 0.0][-1] / true.values(name)[-1]
        assert abs(math.log(stopped)) > math.asinh(found.band[-1]), name


def test_the_band_grows_with_the_root_of_the_octaves_below():
    data = continued()
    assert np.all(data.band[data.wavelength >= data.resolved] == 0.0)
    assert data.band[-1] == pytest.approx(BAND * math.sqrt(2.0), rel=1e-3)
    ends = data.to_dataset()
    up = ends.friction_from_dissipation_upper / ends.friction_from_dissipation
    assert float(up[-1]) == pytest.approx(math.exp(math.asinh(float(data.band[-1]))))


def test_other_seeds_change_little():
    """Within 3 % on 1.7 m of road; this line is 0.2 m."""
    ends = [continued(seed=seed).values("friction_from_dissipation")[-1] for seed in (0, 1)]
    assert ends[1] == pytest.approx(ends[0], rel=0.15)
    assert ends[1] != ends[0]


def test_a_hurst_exponent_sets_the_slope_of_each_octave():
    steps = continued(HurstExponent(0.7)).steps
    ratios = [b.slope / a.slope for a, b in zip(steps[-3:-1], steps[-2:], strict=True)]
    assert ratios == pytest.approx([2.0**0.3] * 2, rel=1e-3)
    # the slope is that on the faces that touch
    line, faces = steps[-1].lines[0], steps[-2].faces[0]
    slopes = np.abs(line.slope(steps[-2].wavelength, steps[-1].wavelength)[faces])
    assert np.quantile(slopes, 0.68) == pytest.approx(steps[-1].slope, rel=1e-9)


def test_a_finer_measurement_of_the_same_surface_gives_its_slopes():
    """Gaussian faces are as rough as all of the line: the finer line is a piece of it."""
    piece = gs.Profile(fine_line().x[:3000], fine_line().z[:3000])
    found = continued(FinerMeasurement(piece))
    assert found.overlap == pytest.approx(1.0, abs=0.25)  # of 200 longer waves
    ratio = (
        found.values("friction_from_dissipation")[-1]
        / truth().values("friction_from_dissipation")[-1]
    )
    assert ratio == pytest.approx(1.0, abs=0.12)


def test_a_finer_measurement_in_a_wrong_unit_is_refused():
    wrong = FinerMeasurement(gs.Profile(fine_line().x[:3000], 1e3 * fine_line().z[:3000]))
    with pytest.raises(InputError, match=r"faces are 0\.00\d+ times as steep .*check units"):
        continued(wrong)


def test_a_finer_measurement_that_ends_too_early_is_refused():
    finer = FinerMeasurement(gs.Profile(fine_line().x[:3000], fine_line().z[:3000]))
    with pytest.raises(InputError, match=r"down_to must be at least 0\.0001 m, the shortest"):
        contact_by_cut_off(tread(), coarse_line(), down_to=50e-6, roughness=finer, **LOAD)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"down_to": 1e-7}, "down_to must be at least 1.56e-06 m, 8 octaves below the 0.4 mm"),
        ({"down_to": -1.0}, "down_to must be greater than zero"),
        ({"lines": []}, "lines must be a list of at least one Profile"),
        ({"roughness": 0.8}, "roughness must be OwnFaces, HurstExponent or FinerMeasurement"),
        ({"longest": 0.5e-3}, "lines must hold three octaves above 0.4 mm"),
    ],
)
def test_wrong_arguments_are_refused_by_value(change, message):
    arguments = {"lines": coarse_line(), "down_to": 200e-6, **LOAD, **change}
    with pytest.raises(InputError, match=message):
        contact_by_cut_off(tread(), **arguments)


def test_hurst_exponents_beyond_one_or_below_zero_are_refused():
    with pytest.raises(InputError, match=r"hurst must be at most 1; got 1\.2"):
        HurstExponent(1.2)
    with pytest.raises(InputError, match="hurst must be greater than zero"):
        HurstExponent(-0.2)


def test_waves_stated_by_hand_and_maps_are_refused():
    x = 1e-4 * np.arange(16.0)
    measured = Measured.of(HeightMap(x, x, np.zeros((16, 16))))
    for surface, kind in (
        (Surface(THREE_SINES, ""), "waves stated by hand"),
        (Surface(THREE_SINES, "", measured=measured), "a map"),
    ):
        with pytest.raises(InputError, match=f"from measured profiles; got {kind}"):
            ContinuedContact().predict(tread(), surface, Load(3e5, 0.3, 0.1))


def test_random_phases_have_no_coupling_and_cascades_have():
    """A cascade with b = 1 by construction: its estimate is less, for both octaves are random."""
    random = np.random.default_rng(0)
    for profile, low, high in ((fine_line(), -0.15, 0.15), (intermittent(1, 0.1), 0.3, 1.0)):
        waves = np.fft.rfft(profile.z)
        line = PeriodicLine(profile.step * profile.x.size, profile.x.size, waves)
        everywhere = np.ones(line.points, dtype=bool)
        found = Intermittency.of([line], [everywhere], 4.0 * profile.resolution_limit, random)
        assert low < found.coupling < high


def test_the_cut_off_at_a_slope_is_between_its_neighbours():
    lengths, slopes = np.array([4e-3, 2e-3, 1e-3]), np.array([0.2, 0.4, 0.8])
    assert cut_off_at(0.6, lengths, slopes) == pytest.approx(math.sqrt(2.0) * 1e-3)
    assert math.isnan(cut_off_at(0.9, lengths, slopes))
    assert math.isnan(cut_off_at(0.1, lengths, slopes))
