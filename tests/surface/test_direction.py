"""Ridges of a road: from profiles along and across sliding, and from a map."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.surface.direction import (
    area_over_truth,
    direction_of_map,
    direction_of_profiles,
    texture_lengths,
)
from gripscale.surface.surface import each_measured
from tests.samples import ZENER
from tests.verification.known_surfaces import LARGEST, surface, two_lines

SMALLEST = 0.4e-3
LAGS = 0.5 * SMALLEST, 0.25 * LARGEST


def finding(family, seed, share=1.0):
    """Return what two lines along and eight short ones across tell, or a share of each."""
    whole = surface(family, seed)
    along, across = (
        two_lines(whole, seed),
        [whole.line(number, "y") for number in range(100, 2000, 256)],
    )
    cut = [
        [gs.Profile(p.x[: int(share * len(p))], p.z[: int(share * len(p))]) for p in lines]
        for lines in (along, across)
    ]
    return direction_of_profiles(cut[0], cut[1], LAGS)


@pytest.mark.parametrize(
    ("family", "starts", "area"),
    [
        ("gauss", "The surface is isotropic: the rms slope over 0.2 mm", None),
        ("2:1 along", "The surface has ridges", 1.0 / 1.29),
        ("2:1 across", "The surface has ridges", 1.0 / 0.86),
        ("3:1 along", "The surface has ridges", 1.0 / 1.52),
        ("6:1 across", "The surface has ridges", 1.0 / 0.68),
    ],
)
def test_two_profiles_across_each_other_decide(family, starts, area):
    """The effect is that measured on four maps of each; two lines scatter by 7 % (of area)."""
    for seed in range(2):
        told = finding(family, seed)
        assert told.sentence.startswith(starts)
        if area is None:
            assert told.severity == "good"
        else:
            assert told.area == pytest.approx(area - 1.0, abs=0.08)


def test_profiles_that_are_too_short_decide_nothing():
    told = finding("stones", 0, share=0.2)
    assert told.sentence.startswith("The profiles are too short to show ridges")
    assert told.effect > 0.1


def test_one_direction_leaves_ridges_open():
    told = direction_of_profiles(two_lines(surface("gauss", 0), 0), [], LAGS)
    assert "ridges 3:1 make the area up to 1.5 times too large" in told.sentence
    assert 'with lay = "across", decides' in told.sentence
    assert told.area == pytest.approx(1.0 / 1.52 - 1.0)


def test_area_by_slopes_rises_with_ridges_along_and_is_one_without():
    ratios = np.geomspace(0.1, 10.0, 41)
    areas = [area_over_truth(ratio) for ratio in ratios]
    assert (np.diff(areas) <= 0.0).all()
    assert area_over_truth(1.0) == pytest.approx(1.0)


def test_texture_aspect_ratio_of_stretched_waves():
    """Waves r times as long one way have 1/r; a map of some 16 waves scatters by 15 %."""
    for ratio in (2.0, 3.0, 6.0):
        for way in ("along", "across"):
            whole = surface(f"{ratio:g}:1 {way}", 1)
            assert texture_lengths(whole)[1] == pytest.approx(1.0 / ratio, rel=0.15)
    isotropic = surface("gauss", 0)
    assert texture_lengths(isotropic)[1] > 0.8
    assert direction_of_map(isotropic) is None
    told = direction_of_map(whole)
    assert "its direct contact holds" in told.sentence
    tilted = replace(whole, z=whole.z + 0.1 * whole.x[:, None])
    assert texture_lengths(tilted)[1] == pytest.approx(texture_lengths(whole)[1], rel=1e-6)
    assert np.isnan(texture_lengths(replace(whole, z=np.zeros(whole.z.shape)))[1])


def test_a_profile_across_is_compared_and_never_solved():
    """Correlation, waves and contacts are those of the profile along alone."""
    whole = surface("3:1 along", 0)
    along, across = whole.line(0), replace(whole.line(900, "y"), lay="across")
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": SMALLEST, "waves": 4}
    alone, both = (gs.Case(lines, ZENER, **load) for lines in ([along], [across, along]))
    assert both.surface.sines.wavelength.tolist() == alone.surface.sines.wavelength.tolist()
    assert [part.measured.cleaned for _, part in each_measured(both.surface)] == [[along]]
    assert any("The surface has ridges" in f.sentence for f in both.findings())
    assert any("Profiles in one direction" in f.sentence for f in alone.findings())
    with pytest.raises(InputError, match="must have a profile along sliding; got all of them"):
        gs.Case([across], ZENER, **load)
    with pytest.raises(InputError, match="lay must be one of along, across"):
        replace(along, lay="slanted")
