"""The typical tread: its numbers from the published sweeps, and what it says of each compound."""

import numpy as np
import pytest

from gripscale.conditions.conditions import Conditions
from gripscale.rubber import softening as tread
from gripscale.rubber.softening import (
    HARDER_TREAD,
    SOFTER_TREAD,
    TYPICAL_TREAD,
    TypicalTread,
    softening_of_sweeps,
)
from studies.treads import SERIES_S, sweeps
from studies.typical_tread import spread

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
    assert HARDER_TREAD.to_dict() == {
        "kind": "typical_tread",
        "deviation": 1.0,
        "deformation": None,
    }
    stored = {"softening": HARDER_TREAD.to_dict()}
    assert Conditions.from_dict(stored).softening == HARDER_TREAD
