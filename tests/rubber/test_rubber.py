"""The Maxwell solid against its own integral definition, limits and bad input."""

import dataclasses
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from gripscale.core.errors import InputError
from gripscale.rubber import MooneyRivlin, NeoHookean, Rubber, Yeoh

SERIES = st.lists(st.tuples(st.floats(1e3, 1e9), st.floats(1e-12, 1e6)), min_size=0, max_size=8)


def make(series, equilibrium=2e6):
    return Rubber(equilibrium, [e for e, _ in series], [t for _, t in series], bulk_modulus=2e10)


@given(SERIES, st.floats(1e-6, 1e14))
@settings(max_examples=100, deadline=None)
def test_complex_modulus_is_the_sum_of_its_elements(series, omega):
    expected = 2e6 + sum(e * 1j * omega * t / (1 + 1j * omega * t) for e, t in series)
    # rounding of a sum of at most nine terms
    assert make(series).complex_modulus(omega) == pytest.approx(expected, rel=1e-12)


@given(SERIES, st.floats(1e-6, 1e14), st.floats(1.01, 100.0))
@settings(max_examples=100, deadline=None)
def test_a_passive_solid_loses_energy_and_stiffens_with_frequency(series, omega, factor):
    rubber = make(series)
    slow, fast = rubber.complex_modulus(np.array([omega, factor * omega]))
    assert slow.imag >= 0.0
    assert fast.real >= slow.real * (1 - 1e-14)
    assert rubber.equilibrium_modulus <= slow.real * (1 + 1e-14)
    assert fast.real <= rubber.glassy_modulus * (1 + 1e-14)
    assert rubber.complex_modulus(-omega) == pytest.approx(slow.conjugate(), rel=1e-14)


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


def test_an_elastic_rubber_has_no_terms():
    rubber = Rubber(3e6)
    assert rubber.complex_modulus([0.0, 1.0, 1e9]) == pytest.approx([3e6, 3e6, 3e6])
    assert rubber.relaxation_modulus(1.0) == 3e6


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
    assert rubber.outside_band([0.5, 1.0, 10.0, -10.0, 101.0]).tolist() == [
        True,
        False,
        False,
        False,
        True,
    ]
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
