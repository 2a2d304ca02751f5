"""The parts of the study of isotropic maps, on surfaces and numbers by hand."""

import numpy as np
import pytest

from gripscale.surface import HeightMap
from studies.isotropic_maps import tables
from studies.isotropic_maps.setting import AREA, FRICTION, SMALLEST
from studies.isotropic_maps.solved import Numbers, OfMap, cut_off, statistics, turned_by_45_degrees

POINTS = 64
STEP = 1e-4
ALONG = STEP * np.arange(POINTS, dtype=np.float64)
WAVE = 2.0 * np.pi * 4 / (POINTS * STEP)
"""Of four periods [rad/m]."""


def contact(area: float, friction: float) -> Numbers:
    return {AREA: area, FRICTION: friction}


def of_map(area: float, of_lines: float) -> OfMap:
    return {
        "map": contact(area, 0.3),
        "lines": contact(of_lines, 0.2),
        "between directions": contact(1.1, 0.9),
        "statistics": {"rms slope": of_lines},
        "map at 45 degrees": contact(0.5 * area, 0.3),
    }


def test_statistics_of_a_sine_leave_out_what_is_too_short() -> None:
    short = 2.0 * np.pi / (4.0 * STEP)
    assert 4.0 * STEP == SMALLEST
    sine = 2e-4 * np.cos(WAVE * ALONG) + 1e-5 * np.cos(short * ALONG)
    unseen = 1e-4 * np.cos(2.0 * np.pi * 24 / (POINTS * STEP) * ALONG)  # below three steps
    found = statistics(np.stack([sine + unseen, np.roll(sine, 5)]), STEP)
    assert found["rms height"] == pytest.approx(np.sqrt(0.5 * (2e-4**2 + 1e-5**2)))
    slope = np.sqrt(0.5 * ((2e-4 * WAVE) ** 2 + (1e-5 * short) ** 2))
    assert found["rms slope"] == pytest.approx(slope)
    difference = 2e-4**2 * (1.0 - np.cos(WAVE * 8e-4)) + 1e-5**2 * (1.0 - np.cos(short * 8e-4))
    assert found["C_z(0.8 mm)"] == pytest.approx(difference)


def test_a_map_turned_by_45_degrees_has_its_waves_on_the_diagonal() -> None:
    """cos(q x) becomes cos(q (x + y)/sqrt 2), or with the minus sign."""
    surface = HeightMap(ALONG, ALONG, np.tile(np.cos(WAVE * ALONG)[:, None], (1, POINTS)))
    turned = turned_by_45_degrees(surface)
    x, y = np.meshgrid(turned.x, turned.y, indexing="ij")
    np.testing.assert_allclose(turned.z, np.cos(WAVE * (x + y) / np.sqrt(2.0)), atol=1e-9)


def test_a_map_is_cut_off_in_all_directions() -> None:
    """Its diagonal wave is shorter than each of the two it is the product of."""
    points = 512  # of a tenth of a millimetre
    x = STEP * np.arange(points)
    number = 2.0 * np.pi * 100 / (points * STEP)  # 0.512 mm; 0.362 mm on the diagonal
    along = np.cos(number * x)[:, None] * np.ones(points)
    np.testing.assert_allclose(cut_off(along).z, along, atol=1e-12)
    np.testing.assert_allclose(cut_off(along * along.T).z, 0.0, atol=1e-12)


def test_factors_are_of_means_with_the_scatter_of_ratios() -> None:
    found = [of_map(0.1, 0.2), of_map(0.2, 0.25)]
    assert tables.factor(found, AREA) == "0.67 ± 0.21"  # 0.3 / 0.45; 0.5 and 0.8
