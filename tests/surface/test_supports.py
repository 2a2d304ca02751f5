"""Plates and supports are found where they are, and nowhere else."""

import numpy as np
import pytest

from gripscale.surface import Profile, clean, read_profile, self_affine_profile
from gripscale.surface.plausibility import road_between, support_plates

from .surface_cases import ROAD, ROAD_ONLY

ROUGH = self_affine_profile(0.8, 2e-3, 0.6e-3, 0.4, 1e-4, 7)
"""4001 points over 0.4 m: a quarter of a hundredth is 1 mm, the guard 10 mm."""


def with_heights(where: slice, values: object) -> Profile:
    z = ROUGH.z.copy()
    z[where] = values
    return Profile(ROUGH.x, z)


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


@pytest.mark.parametrize("tilt", [0.0, 0.15])
@pytest.mark.parametrize("hurst", [0.6, 0.8])
def test_a_rough_profile_has_none(hurst, tilt):
    for seed in range(4):
        rough = self_affine_profile(hurst, 5e-3, 1.5e-3, 0.2, 5e-5, seed)
        assert support_plates(Profile(rough.x, rough.z + tilt * rough.x)) == ()


def test_a_plate_at_the_level_of_the_road_is_smooth():
    noise = np.random.default_rng(0).normal(scale=2e-6, size=400)
    (plate,) = support_plates(with_heights(slice(0, 400), noise))
    # pieces of a fiftieth of the profile, 8 mm
    assert (plate.first, plate.last) == pytest.approx((0.0, 40e-3), abs=8.1e-3)


def test_missing_heights_at_the_ends_of_a_plate_belong_to_it():
    z = np.full(400, 30e-3)
    z[40:] = np.nan
    (plate,) = support_plates(with_heights(slice(3601, 4001), z))
    assert (plate.first, plate.last) == pytest.approx((360e-3, 400e-3), abs=0.2e-3)


def test_what_is_shorter_than_a_plate_or_comes_often_is_none():
    assert support_plates(with_heights(slice(1000, 1009), 20e-3)) == ()
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
