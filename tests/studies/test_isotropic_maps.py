"""The parts of the study of isotropic maps, on surfaces and numbers by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gripscale as gs
from gripscale.surface import HeightMap
from studies.isotropic_maps import folder, tables
from studies.isotropic_maps.folder import Folder
from studies.isotropic_maps.setting import AREA, CONSTRUCTIONS, FRICTION, SMALLEST, STATIONS
from studies.isotropic_maps.solved import (
    Numbers,
    OfLines,
    OfMap,
    cut_off,
    statistics,
    turned_by_45_degrees,
)

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


@pytest.mark.verification
def test_a_stopped_study_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solved: list[str] = []
    level = HeightMap(ALONG, ALONG, np.full((POINTS, POINTS), 1e-3))

    def lines(_: gs.Rubber, station: int) -> OfLines:
        solved.append(f"station {station}")
        return {"windows": {AREA: [0.1, 0.2], FRICTION: [0.3, 0.5]}, "statistics": {}}

    def map_of(_: gs.Rubber, surface: HeightMap, *, turned: bool) -> OfMap:
        assert surface is level
        solved.append(f"map, {turned=}")
        return of_map(0.1, 0.2)

    monkeypatch.setattr(folder, "of_lines", lines)
    monkeypatch.setattr(folder, "of_map", map_of)
    monkeypatch.setattr(folder, "isotropic_maps", lambda _, *, seeds, **__: [level for _ in seeds])
    rubber = gs.Rubber(1e6)
    Folder(tmp_path, 1).fill(rubber)
    # one map of each construction, those of lines turned, too
    first = ["station 0", "station 1", *["map, turned=False"] * 4, *["map, turned=True"] * 2]
    assert sorted(solved) == sorted(first)
    solved.clear()
    Folder(tmp_path, 3).fill(rubber)
    assert solved.count("map, turned=True") == 2 * len(STATIONS)
    assert solved.count("map, turned=False") == 1 * 2 * len(STATIONS)
    assert len(solved) == 8
    kept = Folder(tmp_path, 3)
    assert [len(kept.maps(0, name)) for name in CONSTRUCTIONS] == [2, 2, 3]
    assert kept.measured(1)["windows"][AREA] == [0.1, 0.2]
    np.testing.assert_allclose(kept.heights(1, "lines"), 1e-3, rtol=1e-6)


def test_factors_are_of_means_with_the_scatter_of_ratios() -> None:
    found = [of_map(0.1, 0.2), of_map(0.2, 0.25)]
    assert tables.factor(found, AREA) == "0.67 ± 0.21"  # 0.3 / 0.45; 0.5 and 0.8


def test_directions_are_those_of_one_map(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Folder, "maps", lambda *_: [of_map(0.1, 0.2), of_map(0.3, 0.4)])
    told = list(tables.directions(Folder(tmp_path, 2)))
    assert told[0].endswith("contact_fraction: along x over y 1.100 ± 0.000, 45° 0.500 ± 0.000")
    assert len(told) == 2 * len(STATIONS)
