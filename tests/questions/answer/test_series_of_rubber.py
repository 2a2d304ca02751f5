"""An answer has the series of its own load, and says what that misses of the measured moduli."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.half_space.sampling_error import SERIES
from gripscale.half_space.sensitivity import FrictionAdjoint
from gripscale.half_space.solve import solve_rough_contact
from gripscale.rubber import fit_prony, fit_prony_report, read_master_curve
from gripscale.rubber.material import MeasuredModuli
from gripscale.surface import self_affine_profile
from tests.samples import MEASURED_DMA

pytestmark = pytest.mark.filterwarnings("ignore::gripscale.core.RubberWarning")

ROAD = self_affine_profile(0.8, 3e-3, 4e-4, length=0.24, step=1e-4, seed=1)
COLD = Conditions(heat="none", softening="none")
TOLD = "With the moduli as measured, not the series fitted to them"


@cache
def master():
    return read_master_curve(MEASURED_DMA, reference_temperature="20 C")


def case_of(rubber, speed=0.3):
    load = {"pressure": 3e5, "speed": speed}
    return gs.Case(ROAD, rubber, **load, smallest_wavelength=4e-4, conditions=COLD, filled=True)


@cache
def answered(before=None, speed=0.3):
    """Return the answer at a speed; of a rubber that was fitted for the speed `before`."""
    rubber = master() if before is None else case_of(master(), before).rubber
    return gs.answer(case_of(rubber, speed))


def series_error(answer, name):
    at = answer.data.factor_label.values.tolist().index(SERIES)
    return float(answer.data[f"answer_{name}_factor_uncertainty"][at])


def told(answer):
    return " ".join(str(finding) for finding in answer.findings if TOLD in str(finding))


def weighted_series(weight):
    """Return 60 terms, the rows that decide in these cases weighted so many times."""
    rubber, fit = fit_prony_report(master(), terms=60)
    omega = fit.problem.rows.omega
    band = np.where((omega > 30.0) & (omega < 1e4), weight, 1.0)
    return replace(fit.problem, row_weight=band).applied_to(rubber)


def test_the_interval_holds_many_terms_weighted_where_they_decide():
    found = answered()
    many = gs.answer(case_of(weighted_series(10.0)))
    for name in ("friction", "contact_fraction"):
        low, high = getattr(found, f"{name}_interval")
        assert low < getattr(many, name) < high
        apart = math.log(getattr(many, name) / getattr(found, name))
        assert abs(apart) < 0.03  # 11 % of friction with even weights
        assert series_error(found, name) < 0.03


def test_the_error_is_the_change_by_the_measured_moduli():
    """Of contacts solved anew, to the 5 % of grids; by the adjoint to first order, to a fifth."""
    rubber = case_of(master(), 30.0).rubber
    load = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": 4e-4}
    series, moduli = (
        solve_rough_contact(each, ROAD, **load, tolerance=0.02)
        for each in (rubber, MeasuredModuli.of(rubber))
    )
    change = math.log(moduli.friction_from_dissipation / series.friction_from_dissipation)
    found = answered(30.0)
    assert abs(change) > 0.03
    assert series_error(found, "friction") == pytest.approx(abs(change), rel=0.25)
    omega = 0.3 * series.grid.along
    pair = (each.plane_strain_modulus(omega) for each in (MeasuredModuli.of(rubber), rubber))
    difference = FrictionAdjoint.of(series).by_modulus(np.subtract(*map(np.log, pair))).sum()
    first = difference / series.friction_from_dissipation
    assert first == pytest.approx(change, rel=0.3)


@pytest.mark.parametrize("before", [3e-4, 300.0])
def test_a_rubber_fitted_for_one_load_and_used_at_another_tells(before):
    found, own = answered(before), answered()
    assert "fits it for its load" in told(found)
    names = ("friction", "contact_fraction")
    errors = [max(series_error(each, name) for name in names) for each in (found, own)]
    assert errors[0] > max(2.0 * errors[1], 0.05)
    for name in names:
        low, high = getattr(found, f"{name}_interval")
        assert low < getattr(own, name) < high
    assert "fits it for its load" not in told(own)


def test_a_fitted_rubber_keeps_its_series():
    rubber = fit_prony(master())
    case = case_of(rubber)
    assert case.rubber is rubber
    assert case.replace(speed=3.0).rubber is rubber
    assert gs.Rubber.from_dict(rubber.to_dict()).admissible == rubber.admissible


def test_a_study_has_the_answer_of_each_load():
    study = gs.vary(case_of(master()), speed=[3e-3, 0.3])
    for speed in (3e-3, 0.3):
        point = float(study.data.sel(speed=speed)["answer_friction"])
        assert point == pytest.approx(answered(speed=speed).friction, rel=1e-9)


def test_a_case_is_the_same_whatever_load_it_had_before():
    case = case_of(master())
    assert case.replace(speed=3.0).replace(speed=0.3).key == case.key
    assert case.replace(speed=3.0).key != case.key
