"""Strain softening: Kraus' law, sweeps as measured, and the series they make."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.core import InputError
from gripscale.rubber import softening as tread
from gripscale.rubber.softening import (
    HARDER_TREAD,
    SOFTER_TREAD,
    TYPICAL_TREAD,
    Kraus,
    SofteningFactors,
    SofteningTable,
    TypicalTread,
    softened,
    softening_of_sweeps,
)
from studies.treads import SERIES_S, sweeps
from studies.typical_tread import spread

KRAUS = Kraus(0.25, 0.2, critical_strain=0.02, measured_at=1e-3, deformation="shear")
STRAIN = np.geomspace(1e-3, 1.0, 31)
RUBBER = gs.Rubber(5e6, np.geomspace(3e6, 3e8, 12), np.geomspace(1e-1, 1e-9, 12))


def _kraus_moduli(strain, g0=4e6, g_inf=1e6, loss_most=0.8e6, loss_inf=0.16e6, critical=0.02):
    """Kraus' law written out, m = 1/2."""
    ratio = strain / critical
    storage = g_inf + (g0 - g_inf) / (1.0 + ratio)
    loss = loss_inf + 2.0 * (loss_most - loss_inf) * np.sqrt(ratio) / (1.0 + ratio)
    return storage, loss


def test_kraus_law_against_the_law_written_out():
    storage, loss = _kraus_moduli(STRAIN)
    left = KRAUS.factors(STRAIN / np.sqrt(3.0))
    assert left.storage == pytest.approx(storage / storage[0], rel=1e-12)
    assert left.loss == pytest.approx(loss / loss[0], rel=1e-12)
    assert not left.outside.any()


def test_at_and_below_the_strain_of_the_measurement_nothing_changes():
    left = KRAUS.factors([0.0, 1e-6, 1e-3 / np.sqrt(3.0)])
    assert left.storage == pytest.approx(1.0)
    assert left.loss == pytest.approx(1.0)


def test_a_table_of_kraus_law_is_kraus_law_between_its_rows():
    storage, loss = _kraus_moduli(STRAIN)
    table = SofteningTable([STRAIN], [storage], [loss], measured_at=1e-3, deformation="shear")
    at = np.sqrt(STRAIN[:-1] * STRAIN[1:]) / np.sqrt(3.0)
    # linear in the logarithms between rows a tenth of a decade apart
    assert table.factors(at).storage == pytest.approx(KRAUS.factors(at).storage, rel=1e-3)
    assert table.factors(at).loss == pytest.approx(KRAUS.factors(at).loss, rel=3e-3)


def test_tension_needs_no_conversion():
    table = SofteningTable([[0.01, 0.1]], [[2.0, 1.0]], [[1.0, 1.0]], 0.01, "tension")
    assert table.factors(0.1).storage == pytest.approx(0.5)
    assert table.factors(np.sqrt(1e-3)).storage == pytest.approx(np.sqrt(0.5))


def test_beyond_the_largest_strain_the_last_moduli_are_held_and_flagged():
    table = SofteningTable([[0.01, 0.1]], [[2.0, 1.0]], [[1.0, 0.8]], 0.01, "tension")
    left = table.factors([0.1, 0.2])
    assert left.storage == pytest.approx([0.5, 0.5])
    assert left.loss == pytest.approx([0.8, 0.8])
    assert left.outside.tolist() == [False, True]


def test_between_two_temperatures_factors_are_interpolated_and_flagged_beyond():
    table = SofteningTable(
        [[0.01, 0.1]] * 2, [[2.0, 1.0], [2.0, 1.6]], [[1.0, 1.0]] * 2, 0.01, "tension", [300, 340]
    )
    assert table.factors(0.1, 310.0).storage == pytest.approx(0.5 + 0.25 * 0.3)
    assert not table.factors(0.1, 310.0).outside
    assert table.factors(0.1, 350.0).storage == pytest.approx(0.8)
    assert table.factors(0.1, 350.0).outside
    with pytest.raises(gs.InputError, match="temperature must be given"):
        table.factors(0.1)


@pytest.mark.parametrize(
    "law", [KRAUS, SofteningTable([[1e-3, 1.0]], [[2, 1]], [[1, 1]], 0.1, "shear")]
)
def test_a_law_survives_its_dict(law):
    assert Conditions.from_dict({"softening": law.to_dict()}).softening == law


@pytest.mark.parametrize("factor", [1.0, 0.3])
def test_equal_factors_only_scale_the_series(factor):
    out = softened(RUBBER, factor, factor, [1e3, 1e4])
    omega = np.geomspace(1e-2, 1e10, 30)
    expected = factor * RUBBER.complex_modulus(omega)
    assert out.rubber.complex_modulus(omega) == pytest.approx(expected, rel=1e-12)
    assert out.misfit == 0.0


@pytest.mark.parametrize(("f", "g"), [(0.5, 0.6), (0.3, 0.4), (0.6, 0.4), (0.8, 1.0)])
def test_the_softened_series_has_both_moduli_where_the_wave_excites_it(f, g):
    omega = 1e4 * np.geomspace(1.0, 16.0, 12)
    out = softened(RUBBER, f, g, omega)
    ratio = out.rubber.complex_modulus(omega[0]).real / RUBBER.complex_modulus(omega[0]).real
    lost = out.rubber.complex_modulus(omega[0]).imag / RUBBER.complex_modulus(omega[0]).imag
    missed = max(abs(ratio / f - 1.0), abs(lost / g - 1.0))
    assert missed == pytest.approx(out.misfit, rel=1e-6, abs=1e-12)
    # 5 %: factors apart do not fit any series exactly (Kramers-Kronig), and a fit shares it out
    assert missed < 0.05
    every = out.rubber.complex_modulus(omega) / RUBBER.complex_modulus(omega).real
    softer, hard = (rubber.complex_modulus(omega) for rubber in (out.rubber, RUBBER))
    ratios = np.array([softer.real / (f * hard.real), softer.imag / (g * hard.imag)])
    assert np.abs(ratios - 1.0).max() < 0.2
    assert every.real.min() > 0.0
    assert out.rubber.equilibrium_modulus >= 0.33 * f * RUBBER.equilibrium_modulus


def test_a_relaxed_rubber_is_softened_by_the_storage_factor():
    out = softened(RUBBER, 0.4, 0.7, ())
    assert out.rubber.equilibrium_modulus == pytest.approx(0.4 * RUBBER.equilibrium_modulus)


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"kind": "payne"}, "kind"),
        ({"kind": "kraus", "storage_ratio": 0.2}, "critical_strain"),
        (KRAUS.to_dict() | {"storage_ratio": 1.2}, "storage_ratio"),
        (KRAUS.to_dict() | {"deformation": "bending"}, "deformation"),
        (KRAUS.to_dict() | {"measured_at": 0.0}, "measured_at"),
        ({"kind": "table", "strain": [[0.1, 0.01]], "storage": [[1.0, 1.0]], "loss": [[1.0, 1.0]],
         "measured_at": 0.05, "deformation": "shear"}, "strain must rise"),
        ({"kind": "table", "strain": [[0.01, 0.1]], "storage": [[1.0, 1.0]], "loss": [[1.0, 1.0]],
         "measured_at": 0.5, "deformation": "shear"}, "measured_at"),
        ({"kind": "table", "strain": [[0.01, 0.1]] * 2, "storage": [[1.0, 1.0]] * 2,
         "loss": [[1.0, 1.0]] * 2, "measured_at": 0.05, "deformation": "shear"}, "temperature"),
    ],
)  # fmt: skip
def test_a_wrong_law_is_one_sentence(values, word):
    with pytest.raises(gs.InputError, match=word) as caught:
        Conditions.from_dict({"softening": values})
    assert "\n" not in str(caught.value)


class Halved:
    """A law of its own, of no class of gripscale: half the moduli at every strain."""

    kind = "halved"

    def factors(self, strain, temperature=None):
        half = np.full(np.shape(strain), 0.5)
        return SofteningFactors(half, half, np.zeros(half.shape, dtype=bool))

    def to_dict(self):
        return {"kind": self.kind}


def test_a_law_needs_its_methods_and_no_base():
    law = Halved()
    assert Conditions(softening=law).softening is law
    with pytest.raises(InputError, match="must be a law of"):
        Conditions(softening=0.5)


# The typical tread: its numbers from the published sweeps, and what it says of each compound.

MEASURED = spread()


def test_the_numbers_are_those_of_the_published_sweeps():
    """To their last digit."""
    for number, (mean, scatter) in enumerate(
        [(tread.MEAN_STORAGE, tread.STORAGE_SCATTER), (tread.MEAN_LOSS, tread.LOSS_SCATTER)]
    ):
        assert np.array(mean) == pytest.approx(np.exp(MEASURED.mean[:, number]), abs=5.1e-4)
        assert np.array(scatter) == pytest.approx(MEASURED.scatter[number], abs=5.1e-4)


def test_both_factors_move_together():
    """From 0.5 % of strain on; below it the loss modulus hardly changes."""
    assert (MEASURED.correlation[1:] > 0.98).all()


def test_the_law_is_the_table_at_its_points_and_between_temperatures():
    law = TypicalTread(deformation="tension")
    at_points = law.factors(tread.STRAIN, 323.15)
    assert at_points.storage == pytest.approx(tread.MEAN_STORAGE[1])
    assert at_points.loss == pytest.approx(tread.MEAN_LOSS[1])
    assert not at_points.outside.any()
    middle = law.factors(0.1)  # 25 C without a temperature
    assert float(middle.storage) == pytest.approx((0.278 + 0.434) / 2)
    assert law.factors(0.3, 293.15).outside
    assert law.factors(0.1, 353.15).outside
    assert float(law.factors(1e-4, 293.15).storage) == 1.0


def test_a_deviation_is_the_scatter():
    mean, hard, soft = (
        TypicalTread(deviation, "tension").factors(0.05, 303.15) for deviation in (0.0, 1.0, -1.0)
    )
    for name, scatter in (("storage", 0.226), ("loss", 0.307)):
        middle = getattr(mean, name)
        assert np.log(getattr(hard, name) / middle) == pytest.approx(scatter)
        assert np.log(getattr(soft, name) / middle) == pytest.approx(-scatter)


def test_the_named_laws_do_not_state_the_kind_of_strain():
    assert [law.deviation for law in (SOFTER_TREAD, TYPICAL_TREAD, HARDER_TREAD)] == [-1, 0, 1]
    assert all(law.deformation is None for law in (SOFTER_TREAD, TYPICAL_TREAD, HARDER_TREAD))


@pytest.mark.parametrize("name", SERIES_S)
def test_each_compound_lies_within_ninety_per_cent(name):
    """Between 1 and 20 % of strain, at 30 C."""
    law = softening_of_sweeps(list(sweeps(name).values()), measured_at=1e-3)
    strain = np.geomspace(0.01, 0.2, 9)
    own = law.factors(strain, 303.15)
    low, high = (TypicalTread(d).factors(strain, 303.15) for d in (-1.645, 1.645))
    for which in ("storage", "loss"):
        values = getattr(own, which)
        assert (getattr(low, which) < values).all()
        assert (values < getattr(high, which)).all()


def test_a_result_stores_it_by_its_name():
    stored = {"kind": "typical_tread", "deviation": 1.0, "deformation": None}
    assert HARDER_TREAD.to_dict() == stored
    assert Conditions.from_dict({"softening": stored}).softening == HARDER_TREAD
