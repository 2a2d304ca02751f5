"""Bad input to the direct contact: one clear sentence, whatever comes in."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.surface import HeightMap

from .rough_cases import ZENER, isotropic_heights

X = np.arange(32) * 4e-4
Z = isotropic_heights(32, length=32 * 4e-4, rms=2e-4, shortest=1.6e-3)
MAP = HeightMap(X, X, Z)
LINE = MAP.line(7)
LOAD = {"pressure": 3e5, "speed": 0.3, "tolerance": None, "workers": 1}


@pytest.mark.parametrize("surface", [LINE, MAP])
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"surface": MAP, "workers": 0}, r"workers must be a whole number from 1 to 1024; got 0"),
        ({"pressure": 0.0}, r"pressure must be greater than zero \[Pa\]; got 0"),
        ({"pressure": math.nan}, r"pressure must be a finite number \[Pa\]; got nan"),
        ({"pressure": "3 pints"}, r"pressure = '3 pints': "),
        ({"pressure": 1e-90}, r"pressure must be from 1e-12 to 1e\+15 Pa; got 1e-90"),
        ({"speed": -0.3}, r"speed must not be negative \[m/s\]; got -0.3"),
        ({"speed": 1e90}, r"speed must be at most 1\.\d+e\+11 m/s, .* got 1e\+90 m/s"),
        ({"smallest_wavelength": 1e-4}, r"from 0\.0008 m, two steps .* 0\.0128 m, its length"),
        ({"smallest_wavelength": 1.0}, r"smallest_wavelength must be from .*; got 1 m"),
        ({"smallest_wavelength": 0.0}, r"smallest_wavelength must be greater than zero"),
        ({"tolerance": 0.0}, r"tolerance must be greater than zero; got 0"),
        ({"tolerance": 2.0}, r"tolerance must be from 1e-05 to below 1, being a relative .* got 2"),
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
