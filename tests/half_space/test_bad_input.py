"""Bad input to the direct contact: one clear sentence, whatever comes in."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.half_space import random_phases, windows
from gripscale.surface import HeightMap

from .rough_cases import ZENER, isotropic_heights

X = np.arange(32) * 4e-4
Z = isotropic_heights(32, length=32 * 4e-4, rms=2e-4, shortest=1.6e-3)
MAP = HeightMap(X, X, Z)
LINE = MAP.line(7)
LOAD = {"pressure": 3e5, "speed": 0.3, "tolerance": None, "workers": 1}
NAN, INF = math.nan, math.inf


@pytest.mark.parametrize("surface", [LINE, MAP])
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pressure": 0.0}, r"pressure must be greater than zero \[Pa\]; got 0"),
        ({"pressure": -3e5}, r"pressure must be greater than zero \[Pa\]; got -300000"),
        ({"pressure": NAN}, r"pressure must be a finite number \[Pa\]; got nan"),
        ({"pressure": INF}, r"pressure must be a finite number \[Pa\]; got inf"),
        ({"pressure": 10**400}, r"pressure must be a finite number \[Pa\]; got a whole number"),
        ({"pressure": "3 pints"}, r"pressure = '3 pints': "),
        ({"pressure": "high"}, r"pressure must be a finite number \[Pa\]; got 'high'"),
        ({"pressure": 1e-90}, r"pressure must be from 1e-12 to 1e\+15 Pa; got 1e-90"),
        ({"speed": NAN}, r"speed must be a finite number \[m/s\]; got nan"),
        ({"speed": -0.3}, r"speed must not be negative \[m/s\]; got -0.3"),
        ({"speed": 1e90}, r"speed must be at most 1\.\d+e\+11 m/s, .* got 1e\+90 m/s"),
        ({"smallest_wavelength": 1e-4}, r"from 0\.0008 m, two steps .* 0\.0128 m, its length"),
        ({"smallest_wavelength": 1.0}, r"smallest_wavelength must be from .*; got 1 m"),
        ({"smallest_wavelength": NAN}, r"smallest_wavelength must be a finite number"),
        ({"smallest_wavelength": 0.0}, r"smallest_wavelength must be greater than zero"),
        ({"tolerance": 0.0}, r"tolerance must be greater than zero; got 0"),
        ({"tolerance": 2.0}, r"tolerance must be from 1e-05 to below 1, being a relative .* got 2"),
        ({"tolerance": 1e-30}, r"tolerance must be from 1e-05 to below 1, being a relative error"),
        ({"tolerance": NAN}, r"tolerance must be a finite number; got nan"),
        ({"most_points": 16}, r"most_points must be at least \d+, four points in each wave"),
        ({"most_points": 1e20}, r"most_points must be a whole number from 1 to"),
        ({"periodic": "yes"}, r"periodic must be True or False; got 'yes'"),
        ({"rubber": "tread"}, r"rubber must be a Rubber; got str"),
        ({"rubber": gs.Rubber(1e16, bulk_modulus=1e20)}, r"modulus of the rubber must be from"),
    ],
)
def test_values_out_of_range(surface, change, words):
    arguments = {"rubber": ZENER, "surface": surface, **LOAD} | change
    with pytest.raises(InputError, match=words):
        gs.solve_rough_contact(**arguments)


@pytest.mark.parametrize(
    ("surface", "words"),
    [
        (Z, "surface must be a Profile or a HeightMap; got ndarray"),
        ([LINE, LINE], "surface must be a Profile or a HeightMap; got list"),
        (None, "surface must be a Profile or a HeightMap; got NoneType"),
        (HeightMap(X, X, 1e6 * Z), r"heights of the surface must stay below its length, 0\.0128 m"),
        (HeightMap(X, 1e3 * X, Z), "longer each way than 2 of its steps, of which the largest is"),
        (HeightMap(1e-12 * X, 1e-12 * X, Z), "step of the surface must be from 1e-12 to"),
    ],
)
def test_surfaces_that_are_none(surface, words):
    with pytest.raises(InputError, match=words):
        gs.solve_rough_contact(ZENER, surface, **LOAD)


def test_threads_of_a_map():
    with pytest.raises(InputError, match="workers must be a whole number from 1 to 1024; got 0"):
        gs.solve_rough_contact(ZENER, MAP, **(LOAD | {"workers": 0}))


def test_other_doors():
    with pytest.raises(InputError, match="surface must be a Profile or a HeightMap; got str"):
        windows("road", 0.1)
    with pytest.raises(InputError, match="surface must be a Profile or a HeightMap; got ndarray"):
        random_phases(Z, seed=1)


WORDS = [None, True, "3", "", b"1", [], [1.0], (1.0, 2.0), {}, object(), abs, 1 + 0j]
NUMBERS = [0, -1.0, 1e-300, 5e-324, 1e300, NAN, INF, -INF, 10**400, -(10**400), 2.5, 1e-3, 1e-6]
ARRAYS = [np.array(1.0), np.array([1.0, 2.0]), np.float32(1.0), np.int64(0), Z]
VALUES = [*WORDS, *NUMBERS, *ARRAYS]
CLEANING = ["crop", "valid_range", "trim", "spikes", "spike_slope", "form"]
NAMES = [*LOAD, "smallest_wavelength", "periodic", "most_points"]


def test_no_other_exception_comes_out_of_a_solution():
    """Three hundred calls with one or two arguments replaced; warnings are errors here, too."""
    draw, said = random.Random(5), []
    for _ in range(300):
        arguments = LOAD | {"most_points": 5000}
        for name in draw.sample(NAMES, draw.randint(1, 2)):
            arguments[name] = draw.choice(VALUES)
        try:
            found = gs.solve_rough_contact(ZENER, draw.choice([LINE, MAP]), **arguments)
            assert not found.converged or np.isfinite(found.friction)
        except InputError as error:
            said.append(str(error))
    assert 150 < len(said) < 300
    assert "\n" not in "".join(said)


def mutated(draw: random.Random, values: np.ndarray) -> object:
    """Return values with one of them odd, cut, of another shape, or something else altogether."""
    if draw.random() < 0.5:
        return values
    if draw.random() < 0.3:
        return draw.choice(VALUES)
    changed = values.copy()
    changed.flat[draw.randrange(changed.size)] = draw.choice([NAN, INF, -1.0, 0.0, 1e30])
    return draw.choice([changed, changed, changed[: draw.randrange(32)], changed[..., None]])


def test_no_other_exception_comes_out_of_maps():
    """Three hundred maps; those that are maps go through all that takes one."""
    draw, said, kept = random.Random(6), [], 0
    for _ in range(300):
        try:
            surface = HeightMap(mutated(draw, X), mutated(draw, 2 * X), mutated(draw, Z))
        except InputError:
            continue
        kept += 1
        odd = {name: draw.choice(VALUES) for name in draw.sample(CLEANING, draw.randint(0, 2))}
        for step in (
            lambda s: gs.clean_map(s, **odd),  # noqa: B023 used at once
            lambda s: windows(s, draw.choice([*VALUES, 7e-3, (7e-3, 9e-3)])),
            lambda s: random_phases(s, draw.choice(VALUES)),
            lambda s: s.line(draw.choice(VALUES)),
            lambda s: gs.solve_rough_contact(ZENER, s, **LOAD),
            lambda s: gs.height_difference(s.turned().lines()),
        ):
            try:
                step(surface)
            except InputError as error:
                said.append(str(error))
    assert kept > 30
    assert "\n" not in "".join(said)
