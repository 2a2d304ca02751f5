"""Roughness below the measurement: what is kept, what is added, and how well it does."""

import math
import re
from dataclasses import replace
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
from gripscale.continuation.curve import BAND_OF_GROWTH, BAND_OF_OCTAVE, cut_off_at
from gripscale.continuation.roughness import Intermittency, PeriodicLine
from gripscale.core.errors import InputError
from gripscale.model import Load
from gripscale.surface import HeightMap, Measured, Surface, self_affine_profile
from tests.samples import THREE_SINES
from tests.verification.families import tread
from tests.verification.line_families import family_line
from tests.verification.withheld_octaves import coarser

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


def test_the_measured_part_is_the_direct_contact():
    data = continued()
    measured = next(step for step in data.steps if math.isclose(step.wavelength, data.resolved))
    direct = gs.solve_rough_contact(
        tread(), coarse_line(), smallest_wavelength=data.resolved, tolerance=None, **LOAD
    )
    for name in ("contact_fraction", "friction_from_dissipation"):
        assert measured.mean(name) == pytest.approx(getattr(direct, name), rel=1e-6)


def test_a_continued_line_passes_through_the_measured_points_and_not_beyond_a_step():
    z = np.repeat([0.0, 1e-3, 0.2e-3, -1e-3], 32)
    line = PeriodicLine.of(gs.Profile(1e-4 * np.arange(128), z), 4e-4, 1e-4, steepest=math.inf)
    heights = line.resolved_to(4e-4).profile().z
    points = line.profile().z[:: line.points // 128]
    assert heights[:: line.points // 128] == pytest.approx(points, abs=1e-15)
    # the waves of the measurement alone overshoot by a tenth of a step
    assert np.ptp(line.profile().z) > 1.05 * np.ptp(points)
    assert np.ptp(heights) == pytest.approx(np.ptp(points), rel=1e-12)


def test_two_octaves_of_a_gaussian_line_are_found_within_their_band():
    """The scatter of this one line is included: the added waves are others than the true ones."""
    found, true = continued(), truth()
    for name in ("contact_fraction", "friction_from_dissipation"):
        ratio = found.values(name)[-1] / true.values(name)[-1]
        assert abs(math.log(ratio)) < found.band(name)[-1], name
        # without continuation the friction is half as large and the area half as large again
        stopped = found.values(name)[found.octaves_below == 0.0][-1] / true.values(name)[-1]
        assert abs(math.log(stopped)) > found.band(name)[-1], name


def test_the_band_grows_with_the_octaves_and_with_what_they_add():
    data, name = continued(), "friction_from_dissipation"
    band, values = data.band(name), data.values(name)
    assert np.all(band[data.wavelength >= data.resolved] == 0.0)
    growth = math.log(values[-1] / values[-3])
    expected = math.hypot(2.0 * BAND_OF_OCTAVE, BAND_OF_GROWTH * growth)
    assert band[-1] == pytest.approx(expected, rel=1e-3)
    ends = data.to_dataset()
    up = ends.friction_from_dissipation_upper / ends.friction_from_dissipation
    assert float(up[-1]) == pytest.approx(math.exp(band[-1]))


def test_a_line_whose_last_octaves_disagree_is_not_continued():
    """Waves longer than 3 mm, and fine roughness from 1 mm on: at 0.8 mm it has just begun."""
    line = coarser(family_line("two_scales", 0), 2)
    found = contact_by_cut_off(tread(), line, down_to=0.2e-3, **LOAD)
    assert found.wavelength[-1] == pytest.approx(0.8e-3)
    assert re.match(
        r"The roughness is not continued below 0\.8 mm, where the measurement ends: the slopes of "
        r"its last two octaves are 1\.\d\d and 0\.\d\d times",
        found.refusal,
    )
    assert "The roughness is not continued" in repr(found)
    assert found.to_dataset().attrs["refusal"] == found.refusal
    surface = Surface(THREE_SINES, "", measured=Measured.of([line]))
    answer = ContinuedContact(down_to=0.2e-3).predict(tread(), surface, Load(3e5, 0.3, 0.1))
    assert answer.prediction_status.item() == found.refusal
    assert math.isnan(float(answer.total_friction))
    assert bool(answer.curve_measured.all())
    # a stated exponent needs no octave that foretells it
    stated = contact_by_cut_off(tread(), line, down_to=0.2e-3, roughness=HurstExponent(0.8), **LOAD)
    assert (stated.refusal, stated.wavelength[-1]) == ("", pytest.approx(0.2e-3))


def test_other_seeds_change_little():
    """Within 3 % on 1.7 m of road; this line is 0.2 m."""
    ends = [continued(seed=seed).values("friction_from_dissipation")[-1] for seed in (0, 1)]
    assert ends[1] == pytest.approx(ends[0], rel=0.15)
    assert ends[1] != ends[0]


def test_a_hurst_exponent_sets_the_slope_of_each_octave():
    steps = continued(HurstExponent(0.7)).steps
    ratios = [b.slope / a.slope for a, b in zip(steps[-3:-1], steps[-2:], strict=True)]
    assert ratios == pytest.approx([2.0**0.3] * 2, rel=1e-3)
    # the slope is that on the faces that touch, of new waves and of what was there of the octave
    (line,), (before,), (faces,) = steps[-1].lines, steps[-2].lines, steps[-2].faces
    new = replace(line, waves=line.waves - before.waves).slope(math.inf, 0.0)
    known = before.slope(steps[-2].wavelength, steps[-1].wavelength)
    slopes = [np.quantile(np.abs(slope[faces]), 0.68) for slope in (new, known)]
    assert math.hypot(*slopes) == pytest.approx(steps[-1].slope, rel=1e-9)


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
    for profile, low, high in ((fine_line(), -0.15, 0.15), (family_line("cascade", 1), 0.2, 1.0)):
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
