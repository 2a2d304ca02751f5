"""What is implausible about a surface is said, and about a plausible one nothing is."""

from dataclasses import replace

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import (
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
    assert "plates, supports or filled gaps" in warnings_after_cleaning(
        changed(slice(1000, 1800), filled)
    )


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
