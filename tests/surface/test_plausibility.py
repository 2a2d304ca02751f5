"""What is implausible about a surface is said, and about a plausible one nothing is."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core import Severity
from gripscale.core.errors import InputError
from gripscale.surface import (
    HeightMap,
    Measured,
    Profile,
    SineStack,
    Surface,
    clean,
    fit_sines,
    height_difference,
    profile_warnings,
    read_profile,
    self_affine_profile,
)
from gripscale.surface.plausibility import noise_finding, road_between, sensor_noise, support_plates
from studies.shipped import road
from tests.samples import ROOT

from .surface_cases import ROAD, ROAD_ONLY, profile_of

ROUGH = self_affine_profile(0.8, 2e-3, 0.6e-3, 0.4, 1e-4, 7)


def changed(where, values):
    z = ROUGH.z.copy()
    z[where] = values
    return Profile(ROUGH.x, z)


def warnings_after_cleaning(profile, **options):
    return " | ".join(map(str, profile_warnings(profile, clean(profile, **options)[0])))


@pytest.mark.parametrize("hurst", [0.6, 0.8, 1.0])
@pytest.mark.parametrize("cut_off", [0.5e-3, 5e-3])
def test_rough_profiles_are_plausible(hurst, cut_off):
    for seed in range(5):
        rough = self_affine_profile(hurst, cut_off, 0.3 * cut_off, 0.2, 5e-5, seed)
        tilted = Profile(rough.x, rough.z + 0.15 * rough.x)
        assert warnings_after_cleaning(rough) == ""
        assert warnings_after_cleaning(tilted) == ""


@pytest.mark.parametrize("path", ROAD)
def test_the_road_is_plausible_between_its_plates_and_not_with_them(path):
    road = read_profile(path)
    assert warnings_after_cleaning(road, crop=ROAD_ONLY) == ""
    assert "plates, supports or filled gaps lie in the profile" in warnings_after_cleaning(road)
    assert warnings_after_cleaning(road, crop=ROAD_ONLY, spikes=None) == ""


def test_grooves_are_no_jumps():
    grooved = np.where(ROUGH.x % 20e-3 < 3e-3, -4e-3, 0.0) + 0.1 * ROUGH.z
    assert "jump" not in warnings_after_cleaning(Profile(ROUGH.x, grooved))


@pytest.mark.parametrize(("height", "words"), [(20e-3, "20 mm above"), (-9e-3, "8.9 mm below")])
def test_a_plate_or_a_support_is_a_stretch(height, words):
    says = warnings_after_cleaning(changed(slice(1000, 1400), height + 0.1 * ROUGH.z[1000:1400]))
    assert f"at 99.9 mm to 140 mm ({words} the road)" in says


def test_a_step_is_a_jump():
    says = warnings_after_cleaning(changed(slice(2000, None), ROUGH.z[2000:] + 20e-3))
    assert "heights jump in 1 place," in says


@pytest.mark.parametrize("sentinel", [-9999.0, -999.0, 9999.0, 1e30, -0.01])
def test_a_value_for_missing_heights_is_found_and_taken_out_by_name(sentinel):
    stretch = changed(slice(300, 330), sentinel)
    assert f"{sentinel * 1e3:g} mm, comes 28 times" in warnings_after_cleaning(stretch)
    believed = (-0.005, 0.005)
    assert warnings_after_cleaning(stretch, valid_range=believed) == ""


def test_a_single_far_height_is_a_spike_and_no_sentinel():
    assert warnings_after_cleaning(changed(300, -9999.0)) == ""


@pytest.mark.parametrize("filled", [0.3e-3, np.linspace(0.0, 0.3e-3, 800)])
def test_filled_gaps_are_flat(filled):
    says = warnings_after_cleaning(changed(slice(1000, 1800), filled))
    assert "plates, supports or filled gaps" in says


@pytest.mark.parametrize(
    ("x_scale", "z_scale", "says"),
    [
        (1.0, 1e3, "too high for a texture; is the unit of heights right?"),
        (1e3, 1e3, "too high for a texture"),
        (1.0, 1e-3, "hardly any slope; is the unit of heights right?"),
        (1e3, 1.0, "too coarse for a texture; is the unit of distances right?"),
        (1e-3, 1.0, "too high for a texture"),
    ],
)
def test_a_unit_a_thousand_times_off_is_doubted(x_scale, z_scale, says):
    assert says in warnings_after_cleaning(Profile(x_scale * ROUGH.x, z_scale * ROUGH.z))


def test_a_unit_that_makes_spikes_of_all_is_doubted():
    steep = Profile(ROUGH.x, 20.0 * ROUGH.z)
    assert "% of the heights stand at steps steeper than 3" in warnings_after_cleaning(steep)


def test_equal_heights_and_few_of_them():
    [equal] = profile_warnings(profile_of(np.ones(20)))
    assert str(equal) == "all heights are equal: is this the column of heights?"
    assert equal.severity == "doubt"
    every_other = np.where(np.arange(20) % 2, np.nan, np.arange(20.0) * 1e-5)
    assert profile_warnings(profile_of(every_other)) == ()


def test_what_is_no_part_of_the_profile_is_refused():
    short = Profile(ROUGH.x[:40], ROUGH.z[:40])
    with pytest.raises(InputError, match="cleaned must be a part of profile; got 4001 points"):
        profile_warnings(short, ROUGH)


def prepared(options, profile=ROUGH):
    cleaned, report = clean(profile)
    curve = height_difference(cleaned)
    measured = Measured([(profile, cleaned)], [report], None, "")
    return Surface(fit_sines(curve, **options), "", curve, options, measured)


def of_waves(options):
    """Return the findings but for those on ridges and on noise, which are of the profile."""
    surface = prepared(options)
    others = (*surface.direction, *surface.noise)
    return [finding for finding in surface.findings if finding not in others]


def test_it_is_said_where_the_waves_end():
    def note(options):
        [finding] = of_waves(options)
        return finding.sentence.partition(": ")[2]

    assert note({"scales": 7}).endswith("0.4 mm, the shortest the measurement carries.")
    assert note({"scales": 2}).endswith("where the fit puts it.")
    below = of_waves({"scales": 5, "smallest_wavelength": 0.2e-3})
    assert [str(finding) for finding in below] == [
        "The smallest wave, 0.2 mm, is shorter than the measurement resolves, 0.4 mm: it "
        "extrapolates the waves above it."
    ]
    assert of_waves({"scales": 5, "smallest_wavelength": 0.4e-3}) == []
    assert Surface(SineStack([1e-3], [1e-4]), "by hand").findings == ()


def test_more_waves_than_the_curve_holds_are_said():
    [edge] = of_waves({"scales": 12, "smallest_wavelength": 0.4e-3})
    assert str(edge).startswith("s_wavelength is 1.5, at the edge of the range searched, 1.5 to 30")
    given = of_waves({"scales": 2, "s_wavelength": 1.5})
    assert not any("s_wavelength" in str(finding) for finding in given)  # given, not found
    [longest] = of_waves({"scales": 24, "smallest_wavelength": 0.4e-3})
    assert str(longest).startswith("the largest wave, 6060 mm, is longer than 4 times")


def test_notes_name_the_profile_and_what_the_reader_changed():
    turned = replace(Profile(ROUGH.x[::-1], ROUGH.z[::-1]), name="lane")
    first, *_ = prepared({"scales": 7}, turned).findings
    assert str(first).startswith("lane: distances fell from row to row")


# Plates and supports are found where they are, and nowhere else.


@pytest.mark.parametrize("path", ROAD)
def test_the_plates_of_the_shipped_road_are_found_and_the_crop_is_that_of_its_case(path):
    road = read_profile(path)
    # The heights above 10 mm: those of the steel plates, 41 to 54 mm.
    high = road.x[road.z > 10e-3]
    first, last = support_plates(road)
    assert first.first == pytest.approx(high[0], abs=1e-3)
    assert first.last == pytest.approx(high[high < 0.5].max(), abs=1e-3)
    assert last.first == pytest.approx(high[high > 0.5].min(), abs=8e-3)  # missing heights before
    crop = road_between(road)
    assert crop is not None
    assert crop == pytest.approx(ROAD_ONLY, abs=51e-3)
    assert support_plates(clean(road, crop=crop)[0]) == ()


def test_a_plate_at_the_level_of_the_road_is_smooth():
    noise = np.random.default_rng(0).normal(scale=2e-6, size=400)
    (plate,) = support_plates(changed(slice(0, 400), noise))
    # pieces of a fiftieth of the profile, 8 mm
    assert (plate.first, plate.last) == pytest.approx((0.0, 40e-3), abs=8.1e-3)


def test_missing_heights_at_the_ends_of_a_plate_belong_to_it():
    z = np.full(400, 30e-3)
    z[40:] = np.nan
    (plate,) = support_plates(changed(slice(3601, 4001), z))
    assert (plate.first, plate.last) == pytest.approx((360e-3, 400e-3), abs=0.2e-3)


def test_what_is_shorter_than_a_plate_or_comes_often_is_none():
    assert support_plates(changed(slice(1000, 1009), 20e-3)) == ()
    grooved = np.where(ROUGH.x % 40e-3 < 6e-3, -4e-3, 0.0) + 0.1 * ROUGH.z
    assert support_plates(Profile(ROUGH.x, grooved)) == ()


def test_the_longest_part_is_the_road_on_whole_grains():
    # 0.4 m has grains of 1 mm, and a guard of a fortieth, 10 mm
    z = ROUGH.z.copy()
    z[:300] += 20e-3
    z[2500:3000] += 15e-3
    assert road_between(Profile(ROUGH.x, z)) == pytest.approx((0.040, 0.240), abs=1e-9)
    assert road_between(ROUGH) is None


def test_a_hill_without_steps_is_no_plate():
    hill = 10e-3 * np.exp(-0.5 * ((ROUGH.x - 0.2) / 8e-3) ** 2)
    assert support_plates(Profile(ROUGH.x, hill + 0.1 * ROUGH.z)) == ()


@pytest.mark.parametrize("seed", range(8))
def test_round_exposed_stones_of_a_short_profile_are_none(seed):
    """Half circles of 2 to 6 mm in fine mortar, 15 to 30 mm apart, over 0.1 m; all have steps."""
    random, x = np.random.default_rng(seed), 1e-4 * np.arange(1000)
    z, middle = random.normal(0.0, 5e-5, x.size), random.uniform(0.0, 0.01)
    while middle < x[-1]:
        radius = random.uniform(2e-3, 6e-3)
        z = np.maximum(z, np.sqrt(np.maximum(radius**2 - (x - middle) ** 2, 0.0)))
        middle += 2.0 * radius + random.uniform(15e-3, 30e-3)
    assert support_plates(Profile(x, z)) == ()


# White noise of the sensor: estimated, and stated where it changes the contact.

STEP, POINTS = 1e-4, 2**14
SURFACES = ROOT / "examples" / "data" / "surfaces"


def rough(shape, seed=0):
    """Return heights of rms 0.2 mm, H = 0.8 along x, from 12.8 mm down to two steps."""
    q = np.fft.rfftfreq(shape[-1], STEP)
    size = np.where(q > 1.0 / 12.8e-3, np.maximum(q, 1.0) ** -1.3, 0.0)
    waves = np.fft.rfft(np.random.default_rng(seed).standard_normal(shape)) * size
    z = np.fft.irfft(waves, shape[-1])
    return 2e-4 * z / z.std()


def with_noise(line, rms, seed=1):
    return replace(line, z=line.z + rms * np.random.default_rng(seed).standard_normal(len(line)))


@pytest.mark.parametrize("rms", [5e-5, 2e-4])
def test_the_noise_of_a_rough_line_is_found(rms):
    """1600 heights in the smoothest stretches tell a variance to 6 %; the choice takes 10 %."""
    line = Profile(STEP * np.arange(POINTS), rough((POINTS,)))
    assert sensor_noise([with_noise(line, rms)])[0] == pytest.approx(rms, rel=0.2)


@pytest.mark.parametrize("seed", range(4))
def test_roughness_is_no_noise(seed):
    line = Profile(STEP * np.arange(POINTS), rough((POINTS,), seed))
    assert noise_finding([line], 2.0 * STEP) is None
    with_jumps = line.z + 1e-3 * (np.arange(POINTS) % 700 < 300)
    assert noise_finding([replace(line, z=with_jumps)], 2.0 * STEP) is None


def test_measured_roads_and_surfaces_as_they_are_have_none():
    assert noise_finding([road(0), road(1)], 1e-4) is None
    assert noise_finding([gs.read_profile(SURFACES / "mitutoyo_2_mock.xlsx")], 1e-5) is None


def test_dropouts_add_none():
    """A tenth of the heights is missing, and the noise of the rest is the same."""
    line = with_noise(Profile(STEP * np.arange(POINTS), rough((POINTS,))), 1e-4)
    gaps = np.random.default_rng(5).random(POINTS // 16) < 0.1
    z = np.where(np.repeat(gaps, 16), np.nan, line.z)
    assert sensor_noise([replace(line, z=z)])[0] == pytest.approx(1e-4, rel=0.2)


def test_noise_of_a_map():
    x, y = STEP * np.arange(1024), STEP * np.arange(64)
    z = rough((64, 1024)).T
    noise = 1e-4 * np.random.default_rng(2).standard_normal(z.shape)
    assert sensor_noise(HeightMap(x, y, z + noise).lines())[0] == pytest.approx(1e-4, rel=0.2)
    assert noise_finding(HeightMap(x, y, z).lines(), 2.0 * STEP, STEP) is None


def test_short_lines_tell_nothing():
    line = Profile(STEP * np.arange(200), 1e-4 * np.random.default_rng(0).standard_normal(200))
    assert sensor_noise([line])[0] == 0.0


@pytest.mark.parametrize(("rms", "stated", "cut_off"), [(1e-5, "8.5", "0.16"), (2e-5, "19", "0.3")])
def test_a_case_doubts_noisy_heights(rms, stated, cut_off):
    """Noise on the shipped road: named with its number, its effect and a cut-off without it."""
    lines = [with_noise(road(station), rms, station) for station in (0, 1)]
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": 1e-4}
    rubber = gs.Rubber(3e6, [2e7], [1e-3], bulk_modulus=2e9)
    noisy, clean = (
        gs.Case(profiles, rubber, cleaning={}, **load) for profiles in (lines, [road(0), road(1)])
    )
    (doubt,) = (f for f in noisy.surface.doubts if "noise" in str(f))
    assert not any("noise" in str(f) for f in clean.surface.findings)
    assert doubt.severity == Severity.DOUBT
    assert sensor_noise(noisy.surface.measured.cleaned)[0] == pytest.approx(rms, rel=0.15)
    assert f"white noise of {stated} µm" in str(doubt)
    assert f"With a cut-off of {cut_off}" in str(doubt)
