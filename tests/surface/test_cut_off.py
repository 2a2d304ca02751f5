"""Rules for the smallest wavelength that counts: what they find, say and refuse."""

import math

import pytest

import gripscale as gs
from gripscale.surface import RmsSlope, find_cut_off, self_affine_profile, slope_by_wavelength
from gripscale.surface.cut_off import cut_off_rule

ROUGH = [self_affine_profile(0.7, 10e-3, 1e-3, 0.4, 1e-4, seed) for seed in (1, 2)]
SLOPES = slope_by_wavelength(ROUGH)


@pytest.mark.parametrize("of", ["surface", "profile"])
def test_slope_down_to_the_cut_off_is_the_one_asked_for(of):
    wanted = 0.6 * SLOPES.down_to(SLOPES.resolution_limit, of)
    found = find_cut_off(ROUGH, RmsSlope(wanted, of))
    # of a line the sum runs over whole waves of a window, of which one adds up to 1 %
    tolerance = 1e-9 if of == "surface" else 0.01
    assert getattr(found, f"{of}_slope") == pytest.approx(wanted, rel=tolerance)
    assert SLOPES.down_to(1.01 * found.wavelength, of) < wanted
    assert found.surface_slope > found.profile_slope
    assert not found.beyond_measurement
    assert f"rms slope {wanted:g} of the {of}" in str(found)


def test_instrument_is_four_steps_or_what_it_measures_reliably():
    assert find_cut_off(ROUGH, "instrument").wavelength == pytest.approx(4e-4)
    one = gs.Profile(ROUGH[0].x, ROUGH[0].z, reliable=1e-3)
    assert find_cut_off(one, "instrument").wavelength == 1e-3


def test_a_stated_length_is_told_where_it_lies():
    inside, beyond = find_cut_off(SLOPES, 1e-3), find_cut_off(SLOPES, 2e-4)
    assert (inside.wavelength, inside.beyond_measurement) == (1e-3, False)
    assert beyond.beyond_measurement
    assert "beyond the measurement, which ends at 0.4 mm" in str(beyond)
    assert beyond.surface_slope > find_cut_off(SLOPES, "instrument").surface_slope


def test_slope_that_was_not_measured_is_refused_with_what_was():
    reached = SLOPES.down_to(SLOPES.resolution_limit)
    with pytest.raises(gs.InputError, match=rf"at most {reached:.3g} at 0.4 mm.*; got 7"):
        find_cut_off(SLOPES, RmsSlope(7.0))


def test_slope_beyond_the_measurement_is_extrapolated_only_where_asked_for():
    wanted = 1.2 * SLOPES.down_to(SLOPES.resolution_limit)
    found = find_cut_off(SLOPES, RmsSlope(wanted, extrapolate=True))
    assert found.beyond_measurement
    assert found.surface_slope == pytest.approx(wanted)
    # h'^2 ~ q^(2 - 2H) far above xi: 1.2^(1/(1 - H)) = 1.84 further down, H itself within 0.05
    assert 1.5 < SLOPES.resolution_limit / found.wavelength < 2.2
    with pytest.raises(gs.InputError, match=r"within a factor of 100 below 0\.4 mm"):
        find_cut_off(SLOPES, RmsSlope(100.0, extrapolate=True))


def test_too_short_a_profile_tells_no_slope_of_a_surface():
    flat = gs.Profile(ROUGH[0].x[:64], 0.0 * ROUGH[0].z[:64])
    assert math.isnan(find_cut_off(flat, 1e-3).surface_slope)
    with pytest.raises(gs.InputError, match="too short to tell the slope of the surface"):
        find_cut_off(flat, RmsSlope(1.0))


@pytest.mark.parametrize(
    ("stated", "rule"),
    [
        ("0.1 mm", 1e-4),
        (2e-4, 2e-4),
        ("instrument", "instrument"),
        ({"rms_slope": 1.3}, RmsSlope(1.3)),
        ({"rms_slope": 1, "of": "profile", "extrapolate": True}, RmsSlope(1.0, "profile", True)),
        ("rms_slope 1.3", RmsSlope(1.3)),
        ("rms_slope 1.3 of profile", RmsSlope(1.3, "profile")),
        ("rms_slope 1.3 extrapolate", RmsSlope(1.3, extrapolate=True)),
        (RmsSlope(1.3), RmsSlope(1.3)),
    ],
)
def test_rules_are_read_as_a_case_states_them(stated, rule):
    found = cut_off_rule(stated)
    assert found == (pytest.approx(rule) if isinstance(rule, float) else rule)


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ("dust", 'or "instrument", or {'),
        ("-1 mm", "greater than zero"),
        ({"slope": 1.3}, "expected a table such as"),
        ({"rms_slope": 1.3, "under": "surface"}, "expected a table such as"),
        ({"rms_slope": -1.3}, "rms_slope must be"),
        ({"rms_slope": 1.3, "of": "road"}, "of must be"),
        ({"rms_slope": 1.3, "extrapolate": "yes"}, "extrapolate must be"),
        ("rms_slope 1.2.3", "expected a number after rms_slope"),
        (True, "expected a length"),
    ],
)
def test_other_rules_are_refused_in_a_sentence(stated, words):
    with pytest.raises(ValueError, match=words):
        cut_off_rule(stated)


def test_only_these_rules_are_known():
    with pytest.raises(gs.InputError, match="rule must be one of instrument"):
        find_cut_off(SLOPES, "dust")
    with pytest.raises(gs.InputError, match="rule must be"):
        find_cut_off(SLOPES, -1.0)
