"""The parts of the study of the law from lines to maps, on small maps and numbers by hand."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gripscale.surface import HeightMap
from studies import line_to_map
from studies.line_to_map import (
    PRESSURES,
    RUBBERS,
    SPEED,
    FittedLaw,
    SolvedMap,
    draw,
    family_table,
    freedom_of,
    scatter_of,
    summary,
)
from studies.surface_families import FAMILIES, STEP, Draw, family_map

SMALL = (256, 128)


@pytest.mark.parametrize("family", FAMILIES)
def test_a_map_is_the_same_for_a_seed_and_periodic(family: str) -> None:
    surface, again = family_map(family, 3, SMALL), family_map(family, 3, SMALL)
    np.testing.assert_array_equal(surface.z, again.z)
    assert not np.allclose(surface.z, family_map(family, 4, SMALL).z)
    steps = np.abs(np.diff(surface.z, axis=0))
    across_the_end = np.abs(surface.z[0] - surface.z[-1])
    assert across_the_end.max() <= 1.5 * steps.max()
    assert 0.1 < (np.diff(surface.z, axis=0) / STEP).std() < 2.0


def test_a_gaussian_surface_has_the_waves_and_the_slope_it_should() -> None:
    draw = Draw(np.random.default_rng(1), SMALL)
    heights = draw.gaussian(0.8, 6.4e-3, 0.4e-3)
    power = np.abs(np.fft.rfft2(heights)) ** 2
    wavelength = 2.0 * np.pi / np.maximum(draw.wavenumber, 1.0)
    outside = (wavelength > 6.5e-3) | (wavelength < 0.39e-3)
    assert power[outside].sum() < 1e-12 * power.sum()
    assert heights.std() == pytest.approx(1.0)
    sloped = draw.sloped(heights, 0.7)
    slope = np.roll(sloped, -1, 0) - np.roll(sloped, 1, 0)
    assert slope.std() / (2.0 * STEP) == pytest.approx(0.7)


def lawful(family: str, seed: int, heights: list[float], pressure: float = 3e5) -> SolvedMap:
    """Return a map whose area is small and that of its lines by a law; likewise its friction.

    ln f = -0.1 - 0.2 t - 0.03 (T / P)^(1/3) + 0.9 S, with the means of the lines.
    """
    relative, t = pressure / 1e6 * (1.0 + len(family) / 10.0), float(np.mean(heights))
    tail = 0.1 + 0.2 * (seed % 3) + 0.05 * len(family)
    few, softening = np.cbrt(tail / relative), 0.1 * (len(family) % 3)
    area = 1e-6 * np.exp(-0.1 - 0.2 * t - 0.03 * few + 0.9 * softening)
    friction = 0.2 * np.exp(-0.3 + 0.15 * t + 0.02 * few)
    lines = [[height, tail, relative, softening] for height in heights]
    contacts = [[number] * len(heights) for number in (1e-6, 0.2)]
    errors = [[0.0, 0.0, 8.0]] * len(heights)
    return SolvedMap(family, seed, "tread", pressure, 0.3, area, friction, lines, *contacts, errors)


def test_a_law_without_scatter_comes_back() -> None:
    maps = [
        lawful(family, seed, [1.0 + 0.2 * seed + 0.3 * number] * 3)
        for number, family in enumerate(FAMILIES)
        for seed in range(2)
    ]
    fitted = FittedLaw.of(maps, "area")
    assert fitted.law.constant == pytest.approx(-0.1)
    assert fitted.law.slope == pytest.approx(-0.2, rel=1e-4)
    assert fitted.law.tail == pytest.approx(-0.03, rel=1e-4)
    assert fitted.law.softening == pytest.approx(0.9, rel=1e-4)
    assert fitted.law.scatter == pytest.approx(0.0, abs=1e-4)
    assert fitted.law.tail_scatter == pytest.approx(0.0, abs=1e-4)
    assert FittedLaw.of(maps, "friction").law.slope == pytest.approx(0.15)
    assert len(list(family_table(fitted))) == 2 + len(FAMILIES)


def test_a_family_off_the_law_is_seen_where_it_is_held_out() -> None:
    maps = [
        lawful(family, seed, [1.0 + 0.5 * seed] * 2) for family in FAMILIES for seed in range(4)
    ]
    off = [replace(m, area=m.area * np.exp(0.3)) if m.family == "pits" else m for m in maps]
    fitted = FittedLaw.of(off, "area")
    held_out = {m.family: missed for m, missed in zip(off, fitted.held_out, strict=True)}
    np.testing.assert_allclose(held_out["pits"], 0.3, atol=1e-5)
    assert -0.15 < held_out["cells"].mean() < -0.01


def test_errors_of_pairs_are_of_the_lines_and_the_law() -> None:
    uneven = replace(lawful("pits", 0, [2.0, 2.0, 2.0]), line_areas=[0.1, 0.2, 0.3])
    np.testing.assert_allclose(uneven.pair_errors("area"), np.log([0.75, 1.0, 1.25]), atol=1e-12)
    np.testing.assert_allclose(uneven.pairs[:, 1], 2.0)
    assert uneven.ratio("area") == pytest.approx(np.log(uneven.area / 0.2))


def test_scatter_comes_back_from_what_a_law_misses() -> None:
    random = np.random.default_rng(0)
    pressures = np.geomspace(1e3, 1e6, 2000)
    maps = [lawful("pits", 0, [2.0, 2.0], pressure) for pressure in pressures.tolist()]
    summits = np.array([m.line.columns[1] for m in maps])
    missed = np.hypot(0.1, 0.05 * summits) * random.standard_normal(summits.size)
    high, low = scatter_of(maps, "area", list(missed[:, None]))
    assert high == pytest.approx(0.1, rel=0.1)
    assert low == pytest.approx(0.05, rel=0.1)
    # what an answer knows of its sampling error is no scatter of the law
    known = [replace(m, line_errors=[[0.2 * 2.0**0.5, 0.0, 8.0]] * 2) for m in maps]
    np.testing.assert_allclose(known[0].sampling_errors("area"), 0.2)
    missed = math.hypot(0.2, 0.1) * random.standard_normal(summits.size)
    high, _ = scatter_of(known, "area", list(missed[:, None]))
    assert high == pytest.approx(0.1, rel=0.2)


def test_families_that_scatter_alike_leave_no_doubt_of_it() -> None:
    random = np.random.default_rng(3)
    maps = [lawful(family, seed, [2.0, 2.0]) for family in FAMILIES for seed in range(40)]
    fitted = FittedLaw.of(maps, "area")
    law = fitted.law._replace(scatter=0.1, tail_scatter=0.0)
    noise = [np.array([0.1 * random.standard_normal()]) for _ in maps]
    # each variance is one of 40 numbers, the mean over eleven families one of 440
    assert freedom_of(replace(fitted, law=law, held_out=noise)) > 150.0


def test_a_stopped_study_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    solved: list[tuple[str, int, float]] = []

    def solve_map(
        rubber: str, surface: HeightMap, family: str, seed: int, pressure: float, speed: float
    ) -> SolvedMap:
        assert (rubber, speed) == (RUBBERS[seed], SPEED)
        solved.append((family, seed, pressure))
        return lawful(family, seed, [1.0 + len(solved) / 40.0, 2.0], pressure)

    monkeypatch.setattr(line_to_map, "solve_map", solve_map)
    monkeypatch.setattr(line_to_map, "family_map", lambda *_: None)
    path = tmp_path / "maps.jsonl"
    first = line_to_map.solved_maps(path, 1)
    assert [pressure for *_, pressure in solved[:6]] == [*PRESSURES[0], *PRESSURES[1]]
    maps = line_to_map.solved_maps(path, 2)
    assert len(solved) == len(set(solved)) == 2 * len(PRESSURES[0]) * len(FAMILIES)
    assert maps[: len(first)] == first
    laws = [FittedLaw.of(maps, quantity) for quantity in line_to_map.QUANTITIES]
    assert any("largest t" in line for line in summary(laws[0]))
    draw(laws, tmp_path / "law.png")
    assert (tmp_path / "law.png").stat().st_size > 10_000
