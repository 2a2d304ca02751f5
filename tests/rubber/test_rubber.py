"""The Maxwell solid against its own integral definition, limits and bad input."""

import dataclasses
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from gripscale.core.errors import InputError
from gripscale.rubber import (
    STRAIN_ENERGIES,
    Isihara,
    KrausEnergy,
    MooneyRivlin,
    NeoHookean,
    Rubber,
    Yeoh,
    springpot_modulus,
    strain_energy,
    styrene_butadiene,
)
from gripscale.rubber.softening import Kraus

SERIES = st.lists(st.tuples(st.floats(1e3, 1e9), st.floats(1e-12, 1e6)), min_size=0, max_size=8)


def make(series, equilibrium=2e6):
    return Rubber(equilibrium, [e for e, _ in series], [t for _, t in series], bulk_modulus=2e10)


@given(SERIES, st.floats(1e-6, 1e14))
@settings(max_examples=100, deadline=None)
def test_complex_modulus_is_the_sum_of_its_elements(series, omega):
    expected = 2e6 + sum(e * 1j * omega * t / (1 + 1j * omega * t) for e, t in series)
    # rounding of a sum of at most nine terms
    assert make(series).complex_modulus(omega) == pytest.approx(expected, rel=1e-12)


def test_complex_modulus_is_the_transform_of_the_relaxation_modulus():
    """E*(w) = E_inf + i w int_0^inf (E(t) - E_inf) exp(-i w t) dt, by quadrature."""
    rubber = make([(3e6, 0.2), (5e6, 1.5)])
    omega = 2.0

    def transient(time):
        return float(rubber.relaxation_modulus(time)) - rubber.equilibrium_modulus

    cosine = quad(lambda t: transient(t) * np.cos(omega * t), 0, 60, limit=400)[0]
    sine = quad(lambda t: transient(t) * np.sin(omega * t), 0, 60, limit=400)[0]
    expected = rubber.equilibrium_modulus + 1j * omega * (cosine - 1j * sine)
    # quad's default relative tolerance is 1.5e-8, the tail beyond 60 s is exp(-40)
    assert rubber.complex_modulus(omega) == pytest.approx(expected, rel=1e-7)


def test_limits_in_time_and_frequency():
    rubber = make([(3e6, 0.2), (5e6, 1.5)])
    assert rubber.glassy_modulus == 10e6
    assert rubber.relaxation_modulus([0.0, np.inf]) == pytest.approx([10e6, 2e6])
    assert rubber.complex_modulus([0.0, 1e15]) == pytest.approx([2e6, 10e6])
    assert rubber.equilibrium_shear_modulus + rubber.shear_moduli.sum() == pytest.approx(10e6 / 3)
    assert rubber.loss_factor(0.0) == 0.0
    assert rubber.complex_modulus(np.ones((2, 3))).shape == (2, 3)
    assert Rubber(3e6).relaxation_modulus(1.0) == 3e6  # without terms


def test_poisson_ratio_and_plane_strain_modulus_agree():
    """Elastic: E/(1-nu^2) from the true Young's modulus 9KG/(3K+G); incompressible: 4/3 E."""
    rubber = Rubber(3e8, bulk_modulus=1e9)
    shear, bulk = 1e8, 1e9
    nu = float(rubber.poisson_ratio(1.0))
    assert nu == pytest.approx((3 * bulk - 2 * shear) / (2 * (3 * bulk + shear)), rel=1e-14)
    young = 9 * bulk * shear / (3 * bulk + shear)
    assert rubber.plane_strain_modulus(1.0).real == pytest.approx(young / (1 - nu**2), rel=1e-13)
    stiff = Rubber(3e6, [9e6], [1.0], bulk_modulus=1e15)
    assert stiff.plane_strain_modulus(1.0) == pytest.approx(4 / 3 * stiff.complex_modulus(1.0))


def test_valid_band_tells_what_is_outside():
    rubber = Rubber(1e6, [1e6], [1.0], valid_band=(1.0, 100.0))
    outside = rubber.outside_band([0.5, 1.0, 10.0, -10.0, 101.0])
    assert outside.tolist() == [True, *[False] * 3, True]
    assert not Rubber(1e6).outside_band(1e9)


def test_equality_hash_and_immutability():
    first, second = make([(1e6, 1.0)]), make([(1e6, 1.0)])
    assert first == second
    assert hash(first) == hash(second)
    assert first != make([(1e6, 2.0)])
    assert dataclasses.replace(first, name="x").name == "x"
    with pytest.raises(dataclasses.FrozenInstanceError):
        first.name = "y"
    with pytest.raises(ValueError, match="read-only"):
        first.moduli[0] = 0.0


@pytest.mark.parametrize("law", [NeoHookean(), MooneyRivlin(0.1), Yeoh(-0.1, 0.02)])
@pytest.mark.parametrize("band", [None, (0.1, 1e5 / 3)])
def test_a_rubber_as_a_dictionary_is_the_rubber(law, band):
    """Every number, exactly, also through text."""
    rubber = Rubber(
        2e6 / 3,
        [1e6 / 7, 3e6],
        [1e-12 / 3, 0.1],
        bulk_modulus=1.7e9,
        name="tread",
        source="bench",
        valid_band=band,
        strain_energy=law,
    )
    values = rubber.to_dict()
    assert values["moduli"] == [1e6 / 7, 3e6]
    assert values["strain_energy"] == {"kind": law.kind, **law.parameters()}
    assert Rubber.from_dict(json.loads(json.dumps(values))) == rubber


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"colour": "black"}, "values must have the keys equilibrium_modulus, .* 'colour'"),
        ({"strain_energy": {"kind": "ogden"}}, "kind must be one of neo_hookean"),
        ({"strain_energy": {}}, "kind must be one of neo_hookean.* got None"),
        ({"strain_energy": "yeoh"}, "strain_energy must be a mapping with its kind; got 'yeoh'"),
        ({"moduli": [-1.0]}, "moduli must be greater than zero"),
    ],
)
def test_a_dictionary_of_something_else_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        Rubber.from_dict({**Rubber(1e6).to_dict(), **change})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"equilibrium_modulus": 0.0}, r"equilibrium_modulus must be greater than zero \[Pa\]"),
        ({"equilibrium_modulus": "soft"}, "equilibrium_modulus .* got 'soft'"),
        ({"moduli": [1e6, -1.0]}, r"moduli must be greater than zero .* index 1"),
        ({"moduli": [1e6]}, "same length; got 1 and 2"),
        ({"moduli": [[1e6, 1e6]]}, "one dimension"),
        ({"relaxation_times": [1.0, np.nan]}, r"relaxation_times .* nan at index 1"),
        ({"relaxation_times": [1.0, 0.0]}, "relaxation_times must be greater than zero"),
        ({"bulk_modulus": np.inf}, "bulk_modulus must be a finite number"),
        ({"bulk_modulus": 6e5}, "bulk_modulus .* 2/9 of E_inf . sum E_i, 666667"),
        ({"valid_band": (2.0, 1.0)}, "valid_band .* a lower and a higher"),
        ({"valid_band": (2.0,)}, "valid_band .* a lower and a higher"),
    ],
)
def test_bad_values_are_named(change, message):
    good = {"equilibrium_modulus": 1e6, "moduli": [1e6, 1e6], "relaxation_times": [1.0, 2.0]}
    with pytest.raises(InputError, match=message):
        Rubber(**{**good, **change})


def test_many_frequencies_in_any_shape_are_what_each_is_alone():
    """More than one block of them, of both signs: to the last bit, and conjugate below zero."""
    rubber = Rubber(2e6, [1e6, 3e6, 9e6], [1e-1, 1e-3, 1e-5])
    omega = np.geomspace(1e-3, 1e9, 700).reshape(7, 100)
    together = rubber.complex_modulus(omega)
    alone = [complex(rubber.complex_modulus(one)) for one in omega.ravel()]
    assert together.ravel().tolist() == alone
    assert (rubber.complex_modulus(-omega) == together.conj()).all()


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        *(("complex_modulus", x, "omega must be finite") for x in (np.nan, [1.0, np.inf], "fast")),
        *(("relaxation_modulus", x, "time must not be negative") for x in (-1.0, np.nan)),
    ],
)
def test_bad_frequencies_and_times(name, value, message):
    with pytest.raises(InputError, match=message):
        getattr(Rubber(1e6), name)(value)


# Every strain energy of the list: slopes, small strain, names, and what is refused.

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


# The springpot rubber and its Prony series.


def test_springpots_at_the_reference_frequency():
    """At w_r each springpot is its modulus at a phase of 90 degrees times its exponent."""

    def turned(modulus, degrees):
        return complex(modulus * np.exp(1j * np.deg2rad(degrees)))

    expected = turned(1.76e6, 2.3) + 1 / (1 / turned(1.12e9, 55.0) + 1 / turned(1.12e9, 2.0))
    assert springpot_modulus(2 * np.pi * 6.94e7) == pytest.approx(expected, rel=1e-13)


def test_low_frequencies_have_the_rubbery_loss_angle():
    """The transition spring pot is down by (1e-12)^(55/90-2.3/90), a few 1e-5 of the whole."""
    modulus = complex(springpot_modulus(2 * np.pi * 6.94e7 * 1e-12))
    assert np.degrees(np.angle(modulus)) == pytest.approx(2.3, abs=0.01)


def test_the_series_follows_the_springpots():
    """Two elements per decade ripple by 2 sech(2 pi^2/ln 10) = 0.04 %; the rest is smoothing and
    the ends, where half of the neighbours are missing."""
    omega = np.geomspace(1e-2, 1e10, 1000)
    ratio_parts = styrene_butadiene().complex_modulus(omega), springpot_modulus(omega)
    storage = ratio_parts[0].real / ratio_parts[1].real - 1
    loss = ratio_parts[0].imag / ratio_parts[1].imag - 1
    assert np.abs(storage).max() < 0.005
    assert np.abs(loss).max() < 0.02
    inside = (omega > 1e-1) & (omega < 1e9)
    assert np.abs(storage[inside]).max() < 0.002
    assert np.abs(loss[inside]).max() < 0.005


def test_it_says_what_it_is():
    rubber = styrene_butadiene()
    assert "styrene-butadiene" in rubber.name
    assert "not stated" in rubber.source
    assert rubber.valid_band == pytest.approx((1e-2, 1e10))
    assert styrene_butadiene() is rubber


@pytest.mark.parametrize("omega", [0.0, -1.0, np.inf])
def test_bad_frequencies(omega):
    with pytest.raises(InputError, match="omega must be"):
        springpot_modulus(omega)


# Numbers no measurement has: one sentence of ours for each, and never a warning.


def test_extreme_products_of_frequency_and_time():
    """w tau from 1e-200 to 1e200: the limits of a solid, without a warning."""
    rubber = Rubber(1e6, [2e6, 4e6], [1e-100, 1e100])
    assert rubber.complex_modulus([1e-99, 1e99]).real == pytest.approx([5e6, 5e6], rel=1e-1)
    assert rubber.complex_modulus([0.0, 1e100]) == pytest.approx([1e6, 6e6], rel=0.4)
    assert Rubber(1e6, [2e6], [1e60]).complex_modulus(1e100) == pytest.approx(3e6)
    assert rubber.relaxation_modulus(1e308) == 1e6
    with pytest.raises(InputError, match=r"omega must be finite numbers of at most 1e.100"):
        rubber.complex_modulus(1e101)
    with pytest.raises(InputError, match="relaxation_times must be numbers of at most"):
        Rubber(1e6, [1e6], [1e155])
