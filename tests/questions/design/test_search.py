"""Admissible changes of a compound, the gradient of its friction, and optima that are known."""

from dataclasses import replace
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

import gripscale as gs
from gripscale.core.errors import InputError
from gripscale.questions.design import compound_search
from gripscale.questions.design.compound_limits import (
    AdmissibleChanges,
    CompoundLimits,
    PointLimit,
    changed,
    modulus_parts,
    rolling_band,
)
from gripscale.questions.design.compound_search import DesignProblem, best_change, nearest_design
from gripscale.questions.design.goal_friction import CompoundGoal, GoalFriction, MeasuredPart
from gripscale.rubber import ShiftTable
from tests.half_space.rough_cases import WAVELENGTH, sine
from tests.half_space.test_sensitivity import line
from tests.samples import MAXWELL, SHIFTED_RUBBER

SPEED = 0.3
ROUGH = line(4096, 0.064, 1e-3)


def on(profile, rubber, shortest, pressure, **goal):
    """The friction of a rubber on one profile."""
    goals = [CompoundGoal(SPEED, pressure, **goal)]
    return GoalFriction(rubber, goals, [MeasuredPart(0, profile, shortest, 1e-2, 1.0)])


def log_friction(friction, ratio):
    """ln mu at the first goal, without the gradient."""
    solved = friction.contacts(changed(friction.rubber, ratio))
    lost = [contact.friction_from_dissipation for contact in solved]
    return float(np.log(friction.averaged(lost))[0])


def admissible(rubber, *points, **limits):
    return AdmissibleChanges.of(rubber, CompoundLimits(points=points, **limits))


@pytest.mark.parametrize("kelvin", [None, 303.15], ids=["measured", "10 K warmer"])
def test_gradient_as_differences(kelvin):
    friction = on(ROUGH, SHIFTED_RUBBER, 1e-3, 3e5, temperature=kelvin)
    ratio = 1.0 + 0.2 * np.sin(np.arange(11.0))
    _, slope = friction.log_friction(ratio)
    steps = 0.01 * np.eye(11)
    low, high = (
        np.array([log_friction(friction, end) for end in ratio + sign * steps])
        for sign in (-1.0, 1.0)
    )
    differences = (high - low) / 0.02
    # one per cent of the largest, as for the derivatives by the modulus (half_space)
    assert slope == pytest.approx(differences, abs=0.01 * np.abs(slope).max())
    assert np.abs(slope).max() > 0.1


def test_two_goals_are_weighted():
    friction = on(ROUGH, SHIFTED_RUBBER, 1e-3, 3e5)
    value, slope = friction.log_friction(np.ones(11))
    goals = [CompoundGoal(SPEED, 3e5, weight=3.0), CompoundGoal(3.0, 3e5, weight=1.0)]
    parts = [*friction.parts, MeasuredPart(1, ROUGH, 1e-3, 1e-2, 1.0)]
    both = GoalFriction(SHIFTED_RUBBER, goals, parts)
    fast = GoalFriction(SHIFTED_RUBBER, goals[1:], parts[:1])
    other, turned = fast.log_friction(np.ones(11))
    total, mean = both.log_friction(np.ones(11))
    # contacts start from others, which leaves the residual of the solver
    assert total == pytest.approx(0.75 * value + 0.25 * other, abs=1e-6)
    assert mean == pytest.approx(0.75 * slope + 0.25 * turned, abs=1e-6)


FREQUENCY = SPEED / WAVELENGTH
PHASES = np.array([0.1, 1.0, 10.0])
KNAPSACK = gs.Rubber(10e6, [1e6, 1e6, 1e6], PHASES / (2.0 * np.pi * FREQUENCY), bulk_modulus=1e12)
"""Relaxation times below, at and above the period of the sine; incompressible."""


def test_full_contact_of_a_sine_is_a_knapsack():
    """There mu is proportional to E'' of one frequency. With E' limited at the same frequency each
    modulus takes of the limit as much as its storage, and gives 1/(w tau) of that: the fastest are
    raised first."""
    bound = 0.55
    friction = on(sine(), KNAPSACK, WAVELENGTH / 2.0, 3e6)
    stiff = PointLimit("storage_modulus", 0.0, bound, frequency=FREQUENCY)
    limits = admissible(KNAPSACK, stiff, factor_per_decade=1e3)
    optimum = best_change(friction, limits, np.ones(4))

    storage = np.array([10.0, *(PHASES**2 / (1.0 + PHASES**2))])
    known = np.full(4, 0.5)
    free = bound * storage.sum() - known @ storage
    for i in (1, 2, 3):  # E_inf loses nothing and stays at its least
        known[i] += min(1.5, free / storage[i])
        free -= (known[i] - 0.5) * storage[i]
    assert 0.5 < known[2] < 2.0
    assert optimum.ratio == pytest.approx(known, abs=1e-6)
    loss = np.array([0.0, *(PHASES / (1.0 + PHASES**2))])
    today, _ = friction.log_friction(np.ones(4))
    # full contact is solved in closed form; the bulk modulus is finite
    gain = loss @ known / loss.sum()
    assert np.exp(optimum.log_friction - today) == pytest.approx(gain, rel=1e-4)
    assert abs(optimum.gap) < 1e-4


class Bowl:
    """In place of ln mu a parabola with its top at known moduli."""

    def __init__(self, top):
        self.top = np.asarray(top)

    def log_friction(self, ratio):
        away = ratio - self.top
        return -float(away @ away), -2.0 * away


TOP = np.array([1.05, 0.95, 0.9, 0.92])
"""Inside the limits of `narrow`."""


def narrow():
    return admissible(MAXWELL, largest_factor=1.5)


def test_an_optimum_inside_the_limits_is_found():
    """No corner is best there: quadratic programming goes on where the corners leave a gap.

    The design then gives away no more than it may, though friction falls with the square of the
    distance, which no slope tells.
    """
    bowl, limits = Bowl(TOP), narrow()
    optimum = best_change(bowl, limits, np.ones(4))
    assert optimum.log_friction > -2e-4  # the gap at which the search ends
    design = nearest_design(bowl, limits, optimum)
    assert design.log_friction >= optimum.log_friction - 1.1e-3
    assert limits.violation(design.ratio) < 1e-6
    beyond = best_change(Bowl(np.array([1.0, 1.0, 3.0, 0.5])), limits, np.ones(4))
    assert beyond.ratio[2] == pytest.approx(1.5, abs=1e-4)


def test_a_design_stays_near_today():
    """Friction that one modulus decides changes this one; a corner changes all."""
    limits = admissible(MAXWELL, factor_per_decade=1e3)
    bowl = Bowl(np.array([0.0, 2.0, 0.0, 0.0]))
    bowl.log_friction = lambda ratio: (float(ratio[1]), np.array([0.0, 1.0, 1e-5, 1e-5]))
    optimum = best_change(bowl, limits, np.ones(4))
    assert np.abs(np.log(optimum.ratio[2:])).max() > 0.3
    design = nearest_design(bowl, limits, optimum)
    assert limits.violation(design.ratio) < 1e-6
    assert design.ratio[1] == pytest.approx(2.0, abs=2e-3)  # what a design gives away is 0.001
    # the others only pay for the stiffer glass: 2 MPa more of 10
    assert np.abs(np.log(design.ratio[2:])).max() < 0.3


def test_quadratic_steps_that_end_lower_do_not_count(monkeypatch):
    bowl, limits = Bowl(TOP), narrow()
    monkeypatch.setattr(compound_search, "MOST_CORNERS", 2)
    corners = compound_search._corner_steps(bowl, limits, np.ones(4))
    ends_lower = SimpleNamespace(x=limits.best(-corners.slope))
    monkeypatch.setattr("scipy.optimize.minimize", lambda *_, **__: ends_lower)
    assert best_change(bowl, limits, np.ones(4)).log_friction >= corners.log_friction


def mixtures(limits, count, slope):
    """Random admissible changes: corners, some along the gradient, and mixtures of three."""
    random, size = np.random.default_rng(0), limits.rubber.moduli.size + 1
    objectives = [random.standard_normal(size) for _ in range(count // 4)]
    objectives += [slope * random.lognormal(0.0, 1.0, size) for _ in range(count // 4)]
    corners = np.array([limits.best(objective) for objective in objectives])
    picks = random.integers(len(corners), size=(count // 2, 3))
    shares = random.dirichlet(np.ones(3), size=count // 2)
    return [*corners, *np.einsum("ik,ikj->ij", shares, corners[picks])]


def test_no_random_admissible_change_is_better():
    friction = on(ROUGH, SHIFTED_RUBBER, 1e-3, 3e5)
    rolling = PointLimit("loss_factor", 0.0, 1.0, temperature=333.15)
    stiff = PointLimit("storage_modulus", 0.9, 1.1, temperature=293.15)
    limits = admissible(SHIFTED_RUBBER, rolling, stiff)
    today, slope = friction.log_friction(np.ones(11))
    optimum = best_change(friction, limits, np.ones(11))
    tried = [log_friction(friction, ratio) for ratio in mixtures(limits, 80, slope)]
    # one of them may be the optimum itself, solved from another start
    assert max(tried) < optimum.log_friction + 1e-6
    assert optimum.log_friction > today + 0.1
    assert np.median(tried) < optimum.log_friction - 0.02


def test_limits_hold_for_the_rubber_itself():
    rolling = PointLimit("loss_factor", 0.5, 0.9, temperature=333.15)
    stiff = PointLimit("storage_modulus", 0.95, 1.05, frequency=1.0, temperature=293.15)
    limits = admissible(SHIFTED_RUBBER, rolling, stiff, largest_factor=3.0)
    random = np.random.default_rng(1)
    for _ in range(20):
        ratio = limits.best(random.standard_normal(11))
        assert ratio is not None
        rubber = changed(SHIFTED_RUBBER, ratio)
        bodies = rubber, SHIFTED_RUBBER
        loss, today = (body.at(333.15).loss_factor(20.0 * np.pi) for body in bodies)
        assert 0.5 - 1e-6 < loss / today < 0.9 + 1e-6
        storage, today = (body.complex_modulus(2.0 * np.pi).real for body in bodies)
        assert 0.95 - 1e-6 < storage / today < 1.05 + 1e-6
        order = np.argsort(rubber.relaxation_times)
        steps = np.abs(np.diff(np.log2(ratio[1:][order])))
        decades = np.diff(np.log10(rubber.relaxation_times[order]))
        assert (steps <= decades + 1e-6).all()
        assert rubber.glassy_modulus <= SHIFTED_RUBBER.glassy_modulus * (1.0 + 1e-6)
        assert limits.violation(ratio) < 1e-6
    # all moduli 3.5 times today's: 0.5 above the largest factor, 2.45 above E', 2.5 above the glass
    assert limits.violation(np.full(11, 3.5)) == pytest.approx(2.5, abs=1e-9)
    assert admissible(MAXWELL).violation(np.full(4, 0.4)) == pytest.approx(0.1)


def test_parts_add_up_to_the_modulus():
    omega = np.geomspace(1e-3, 1e9, 30)
    storage, loss = modulus_parts(SHIFTED_RUBBER, omega)
    whole = SHIFTED_RUBBER.complex_modulus(omega)
    assert storage.sum(axis=-1) + 1j * loss.sum(axis=-1) == pytest.approx(whole, rel=1e-12)


def test_least_level_of_one_relaxation():
    """tan(delta) = r_1 l/(r_0 + r_1 s): least with r_1 at its lower, r_0 at its upper bound."""
    rubber = gs.Rubber(1e6, [9e6], [1e-3])
    point = PointLimit("loss_factor", 0.0, 1.0, frequency=1e3 / (2.0 * np.pi))  # w tau = 1
    free = CompoundLimits(factor_per_decade=1e3, points=())
    today, least = 4.5 / (1.0 + 4.5), 0.5 * 4.5 / (2.0 + 0.5 * 4.5)
    lossier = replace(point, low=1.1, high=1.3)  # which today's rubber does not keep
    for points, level in (((), least / today), ((lossier,), 1.1)):
        limits = replace(free, points=points)
        problem = DesignProblem(SimpleNamespace(rubber=rubber), limits, (point,))
        assert problem.least_level() == pytest.approx(level, rel=1e-5)


def test_a_limit_on_the_loss_compliance_is_a_tangent():
    """No admissible change exceeds it, and one reaches it where its tan(delta) does too."""
    point = PointLimit("loss_compliance", 0.0, 0.8, temperature=333.15)
    limits = admissible(SHIFTED_RUBBER, point, largest_factor=3.0)
    random, today = np.random.default_rng(2), point.value(SHIFTED_RUBBER)
    corners = [limits.best(random.standard_normal(11)) for _ in range(40)]
    values = [point.value(changed(SHIFTED_RUBBER, corner)) / today for corner in corners]
    assert max(values) <= 0.8 + 1e-6
    assert max(values) > 0.77
    ((row, least),) = limits.point_rows(replace(point, high=1.0))
    assert row @ np.ones(11) == pytest.approx(least, rel=1e-12)  # today's compound is on it
    with pytest.raises(InputError, match=r"low of a loss_compliance must be zero; got 0\.5"):
        PointLimit("loss_compliance", 0.5, 1.0)


def test_a_design_keeps_its_rolling_resistance_between_the_points_of_the_band():
    """At frequencies and temperatures between those that are held, to two per cent."""
    friction = on(ROUGH, SHIFTED_RUBBER, 1e-3, 3e5)
    problem = DesignProblem(friction, CompoundLimits(), rolling_band(SHIFTED_RUBBER))
    optimum = best_change(friction, problem.admissible(1.0), np.ones(11))
    design = changed(SHIFTED_RUBBER, optimum.ratio)
    kelvins, losses = (313.15, 318.15, 328.15, 338.15, 343.15), ("loss_factor", "loss_compliance")
    for kelvin, hertz, quantity in product(kelvins, (10.0, 22.0, 50.0), losses):
        point = PointLimit(quantity, 0.0, 1.0, hertz, kelvin)
        assert point.value(design) / point.value(SHIFTED_RUBBER) <= 1.02


ROADS = {"case": gs.surface.Surface(None, "none")}


def test_other_temperatures_need_a_shift():
    with pytest.raises(InputError, match="the limit on the loss_factor at 60 C needs a"):
        admissible(MAXWELL, PointLimit("loss_factor", 0.0, 1.0, temperature=333.15))
    with pytest.raises(InputError, match=r"a goal at 0 C needs a rubber with a temperature shift"):
        GoalFriction.of(MAXWELL, [CompoundGoal(1.0, 3e5, 273.15)], ROADS)


SWEPT = replace(SHIFTED_RUBBER, shift=ShiftTable([243.15, 293.15, 313.15], [5.1, 0.0, -1.5]))
"""Sweeps from -30 to 40 C."""


def test_a_limit_beyond_the_sweeps_is_taken_where_they_end():
    wanted = PointLimit("loss_factor", 0.0, 1.0, temperature=333.15)
    taken = admissible(SWEPT, wanted).points[0]
    assert taken.temperature == pytest.approx(313.15)
    assert str(taken) == (
        "tan δ at 10 Hz and 40 °C (the shift ends there, not at 60 °C), 0 to 1 times today's"
    )
    assert taken.within_shift(SWEPT) == taken
    inside = PointLimit("loss_factor", 0.0, 1.0, temperature=293.15)
    assert admissible(SWEPT, inside).points == (inside,)
    ends = ShiftTable([298.15, 313.15], [0.0, -1.0])
    warm = replace(SWEPT, shift=ends, reference_temperature=298.15)
    handling = AdmissibleChanges.of(warm, CompoundLimits()).points[0]
    assert handling.temperature == pytest.approx(298.15)


def test_a_goal_beyond_the_sweeps_is_refused_in_celsius_with_its_cure():
    words = r"of a goal must lie within -30 to 40 °C.*got 60 °C.*shift = \{ kind"
    with pytest.raises(InputError, match=words):
        GoalFriction.of(SWEPT, [CompoundGoal(1.0, 3e5, 333.15)], ROADS)
