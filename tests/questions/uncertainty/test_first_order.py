"""First-order effects of other inputs against solutions with them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gripscale.case import Case
from gripscale.case_file import read_case
from gripscale.core.errors import InputError
from gripscale.questions import Uncertainty, first_order
from gripscale.questions.uncertainty.first_order import SOLVED, Tangent
from gripscale.questions.uncertainty.sampled_inputs import CleanedProfiles
from gripscale.questions.uncertainty.sampling import draws
from gripscale.questions.uncertainty.sources import SOURCES
from tests.samples import case_text, write_short_road

CASE = case_text(
    'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "1 mm"', 'file = "dma.txt"\nterms = 4'
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a case of a short road."""
    path = tmp_path_factory.mktemp("first_order")
    write_short_road(path)
    (path / "case.toml").write_text(CASE)
    return path


@pytest.fixture(scope="module")
def results(folder: Path) -> Case:
    """The case, prepared."""
    return read_case(folder / "case.toml")


@pytest.fixture(scope="module")
def tangent(results: Case) -> Tangent:
    """Its direct contact with the derivatives."""
    return Tangent.of(results)


def test_another_rubber(results, tangent):
    case = tangent.usual
    rubber = case.rubber
    factors = 1.0 + 0.1 * np.cos(np.arange(rubber.moduli.size))
    changed = replace(case, rubber=replace(rubber, moduli=rubber.moduli * factors, admissible=None))
    expected, area = tangent.solved_change(changed)
    assert abs(expected) > 0.005
    # the second order of moduli changed by a tenth
    assert tangent.change(changed) == pytest.approx(expected, abs=0.002, rel=0.1)
    # a contact of a few hundred points changes by single points
    assert tangent.area_changes([changed])[0] == pytest.approx(area, abs=0.005, rel=0.1)


def test_other_heights(results, tangent):
    case = tangent.usual
    lines = []
    for line in results.surface.measured.cleaned:
        wave = 2e-6 * np.sin(2.0 * np.pi * line.x / 2e-3)
        lines.append(replace(line, z=line.z + wave))
    changed = replace(case, cleaned=CleanedProfiles(tuple(lines), results.surface.counted))
    expected, _ = tangent.solved_change(changed)
    assert abs(expected) > 0.002
    assert tangent.change(changed) == pytest.approx(expected, rel=0.15)


def test_another_cut_off(results, tangent):
    case = tangent.usual
    changed = case.ended_at(1.2 * case.end)
    expected, area = tangent.solved_change(changed)
    # the exponent is that of the last octave, of a road of a few waves
    assert tangent.change(changed) == pytest.approx(expected, rel=0.5)
    assert tangent.change(changed) < 0.0
    # one point of a contact of 43, and the part of a step at its ends
    assert tangent.area_changes([changed])[0] == pytest.approx(area, abs=0.03)
    assert tangent.area_changes([changed])[0] > 0.0


def test_another_temperature_and_pressure(folder):
    shift = 'reference_temperature = "20 C"\nshift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }'
    (folder / "shifted.toml").write_text(CASE.replace("terms = 4", f"terms = 4\n{shift}"))
    shifted = Tangent.of(read_case(folder / "shifted.toml"))
    for change in ({"warming": 0.5}, {"log_pressure": 0.05}):
        inputs = replace(shifted.usual, **change)
        expected = shifted.solved_change(inputs)
        derived = [shifted.change(inputs), shifted.area_changes([inputs])[0]]
        assert np.abs(expected).max() > 0.02
        # the second order, and one point of a contact of 43
        assert derived == pytest.approx(expected, abs=0.025), change


def test_noise_of_the_heights_is_one_way(results, tangent):
    """It makes the road rougher, by the square of its size: the error is what it moves, and not its
    scatter alone."""
    names = [name for name in SOURCES if name != "height_noise"]
    noise = Uncertainty(names, {"height_noise": "120 um"})
    sources = noise.of(results, ["direct"]).sources
    drawn = [each.inputs for each in draws(tangent.usual, sources, SOLVED["height_noise"], 0)]
    changes = np.array([tangent.solved_change(inputs) for inputs in drawn])
    mean, scatter = changes.mean(axis=0), changes.std(axis=0)
    assert mean[0] > 1.5 * scatter[0]
    assert mean[1] < -1.5 * scatter[1]
    error = float(first_order(results, noise).friction_error[0])
    assert error == pytest.approx(np.hypot(mean, scatter)[0])


def test_errors_of_each_source(results):
    data = first_order(results, count=16)
    errors = dict(zip(data.source.values, data.friction_error.values, strict=True))
    assert set(errors) == {"cleaning", "cut_off", "modulus", "bulk_modulus", "profile"}
    assert errors["cut_off"] > errors["bulk_modulus"] > 0.0
    # cut-offs are spread evenly in their logarithm over an octave
    exponent = Tangent.of(results).parts[0].contact.cut_off_exponents.friction
    spread = abs(exponent) * math.log(2.0) / math.sqrt(12.0)
    assert errors["cut_off"] == pytest.approx(spread, rel=0.05)
    areas = dict(zip(data.source.values, data.contact_fraction_error.values, strict=True))
    assert areas["cut_off"] > areas["modulus"] > areas["bulk_modulus"] > 0.0


def test_refuses_rest(folder):
    text = CASE.replace('speed = "0.3 m/s"', "speed = 0.0")
    (folder / "rest.toml").write_text(text)
    with pytest.raises(InputError, match="friction for its derivatives"):
        Tangent.of(read_case(folder / "rest.toml"))
