"""Every strain energy of the list: slopes, small strain, names, and what is refused."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.rubber import (
    STRAIN_ENERGIES,
    Isihara,
    KrausEnergy,
    MooneyRivlin,
    NeoHookean,
    Rubber,
    Yeoh,
    strain_energy,
)
from gripscale.rubber.softening import Kraus

LAWS = [
    *(NeoHookean(), MooneyRivlin(0.3), Yeoh(-0.06, 0.005), Isihara(0.2, -0.03)),
    KrausEnergy(0.15, 0.08, 0.002),
]


def test_every_kind_is_tried_here():
    assert {law.kind for law in LAWS} == set(STRAIN_ENERGIES)


@pytest.mark.parametrize("law", LAWS)
def test_a_law_is_made_from_its_kind_and_parameters(law):
    assert strain_energy(law.kind, **law.parameters()) == law


@pytest.mark.parametrize("law", LAWS)
def test_the_shear_modulus_at_small_strain_is_one(law):
    """Factors depart from 1 by the strain at most, times the parameters' order 1."""
    assert law.uniaxial_factor([1.0 - 1e-9, 1.0, 1.0 + 1e-9]) == pytest.approx([1] * 3, abs=1e-8)
    assert law.shear_factor([-1e-9, 0.0, 1e-9]) == pytest.approx([1] * 3, abs=1e-14)


def test_the_secant_modulus_of_shear_is_that_of_the_sweep():
    """Kraus' closed form with the exponent 1/2, from the measured strain on; below it a third."""
    law = Kraus(0.15, 0.1, 0.08, measured_at=0.002, deformation="shear")
    shear = np.geomspace(0.02, 1.0, 9)
    factors = law.factors(shear / np.sqrt(3.0)).storage
    assert KrausEnergy(0.15, 0.08, 0.002).shear_factor(shear) == pytest.approx(factors, rel=2e-3)


@pytest.mark.parametrize(
    ("kind", "parameters", "says"),
    [
        ("ogden", {},
         "kind must be one of neo_hookean, mooney_rivlin, yeoh, isihara, kraus; got 'ogden'"),
        ("yeoh", {"second": 0.1},
         "yeoh takes second, third, of which second, third must be given; got second"),
        ("yeoh", {}, "yeoh takes second, third, of which second, third must be given; got none"),
        ("neo_hookean", {"share": 0.1}, "neo_hookean takes no parameters.* got share"),
        ("mooney_rivlin", {"share": "half"}, "share must be a finite number; got 'half'"),
        ("mooney_rivlin", {"share": np.nan}, "share must be a finite number; got nan"),
        ("mooney_rivlin", {"share": 1.5}, "share must be at most 1; got 1.5"),
        ("mooney_rivlin", {"share": -0.1}, "share must not be negative; got -0.1"),
    ],
)  # fmt: skip
def test_what_is_no_strain_energy_is_named(kind, parameters, says):
    with pytest.raises(InputError, match=says):
        strain_energy(kind, **parameters)


def test_a_rubber_takes_any_law_and_nothing_else():
    class Stiffer(NeoHookean):
        kind = "stiffer"

    assert Rubber(1e6, strain_energy=Stiffer()).strain_energy == Stiffer()
    with pytest.raises(InputError, match=r"strain_energy must be a StrainEnergy; got str"):
        Rubber(1e6, strain_energy="yeoh")
