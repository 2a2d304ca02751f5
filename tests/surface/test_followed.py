"""Lines and maps are described without the flanks that rubber cannot follow, as a case has them."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.experiment.task import canonical_json
from gripscale.surface import Measured, find_cut_off, profile_spectrum, slope_by_wavelength
from gripscale.surface.low_pass import followed

X = 1e-4 * np.arange(4000)
EDGES = np.where((np.arange(4000) // 400) % 2, 2e-3, 0.0)
ROUGH = 1e-5 * np.random.default_rng(3).standard_normal((60, 50)).cumsum(axis=0)
LINE = gs.Profile(X, EDGES + 1e-5 * np.random.default_rng(2).standard_normal(4000).cumsum())
MAP = gs.HeightMap(X[:60], X[:50], np.where(ROUGH > 0.0, 1e-3, 0.0) + ROUGH)


@pytest.mark.parametrize("heights", [LINE, MAP], ids=["line", "map"])
def test_numbers_by_hand_are_those_of_a_case(heights):
    """Of heights with edges; filled twice they are the same object, whose numbers are the same."""
    case = Measured.of(heights if isinstance(heights, gs.HeightMap) else [heights])
    once = followed(heights)
    assert followed(once) is once
    for of in (gs.height_difference, profile_spectrum, slope_by_wavelength):
        by_hand = canonical_json(of(heights))
        assert canonical_json(of(once)) == by_hand != canonical_json(of(heights, steepest=np.inf))
    assert canonical_json(gs.height_difference(case.followed)) == canonical_json(
        gs.height_difference(heights)
    )
    assert find_cut_off(case.slopes, "instrument") == find_cut_off(heights, "instrument")


@pytest.mark.parametrize("heights", [LINE, MAP], ids=["line", "map"])
def test_gaps_stay_and_make_nothing_steep(heights):
    """A wide gap beside an edge and many small ones; what is filled twice is the same object."""
    gaps = np.random.default_rng(4).random(heights.z.shape) < 0.05
    gaps[20:35] = True
    gappy = replace(heights, z=np.where(gaps, np.nan, heights.z))
    once = followed(gappy)
    assert (np.isnan(once.z) == gaps).all()
    assert followed(once) is once
    assert np.nanmax(np.abs(np.diff(once.z, axis=0))) <= 4e-4 * (1.0 + 1e-9)


def test_the_texture_of_standards_keeps_all_flanks():
    """The edges of the line rise by 20; its rms slope by ISO 21920-2 has them."""
    raw = np.diff(LINE.z - np.polyval(np.polyfit(X, LINE.z, 1), X)) / 1e-4
    assert gs.surface.texture(LINE).rms_slope == pytest.approx(np.sqrt(np.mean(raw**2)), rel=1e-9)
