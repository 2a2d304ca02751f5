"""The brush against its closed form, a marching integration, and the heat of a parabola."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from examples.slip_curve.brush import Brush, brush_force

LENGTH, PRESSURE, STIFFNESS, ROAD = 0.1, 3e5, 1.5e8, 22.0
BRUSH = Brush(LENGTH, PRESSURE, STIFFNESS)
SLIP = np.array([1e-4, 0.01, 0.02, 0.05, 0.08, 0.1, 0.3, 0.99, 1.0])


def constant(speed, pressure, warming):
    return np.full(speed.shape, 0.8)


def by_speed(speed, pressure, warming):
    """Return friction largest at 1 m/s, higher under less pressure, constant below 1 cm/s."""
    return (
        0.9
        * np.exp(-0.1 * np.log10(np.maximum(speed, 0.01)) ** 2)
        * (pressure / PRESSURE + 1e-9) ** -0.05
    )


def test_constant_friction_is_the_closed_form():
    """1 - (1 - sigma/sigma*)^3, exact but for the halvings: 1e-8."""
    with np.errstate(divide="ignore"):
        over = SLIP / (1.0 - SLIP) / (0.8 * BRUSH.compliance)
    exact = 0.8 * np.where(over < 1.0, 1.0 - (1.0 - over) ** 3, 1.0)
    solved = brush_force(BRUSH, constant, SLIP, ROAD)
    assert solved.force == pytest.approx(exact, rel=1e-6)


def marched(slip, points=2000):
    """Return the force of bristles point by point, which slide behind the last one that sticks."""
    sigma = slip / (1.0 - slip)
    stuck, sliding = np.empty(points), np.empty(points)
    for i, y in enumerate((np.arange(points) + 0.5) / points):
        pressure = 6.0 * PRESSURE * y * (1.0 - y)
        gained = (1.0 - slip) * ROAD * 6.0 * PRESSURE / (STIFFNESS * LENGTH) * (1.0 - 2.0 * y)

        def excess(speed, gained=gained, pressure=pressure):
            return speed - slip * ROAD + gained * float(by_speed(np.array(speed), pressure, 0.0))

        speed = brentq(excess, 1e-6, 1e3) if excess(1e-6) < 0.0 else 1e-6
        sliding[i] = float(by_speed(np.array(speed), pressure, 0.0)) * pressure
        stuck[i] = STIFFNESS * sigma * LENGTH * y
    sticks = np.flatnonzero(stuck < sliding)
    last = sticks[-1] + 1 if sticks.size else 0
    return float(stuck[:last].sum() + sliding[last:].sum()) / points / PRESSURE


@pytest.mark.parametrize("slip", [0.01, 0.04, 0.08, 0.2, 0.7])
def test_friction_over_speed_is_that_of_marching(slip):
    """The midpoint rule misses the point where sliding begins by up to 1/4000 of the patch."""
    assert brush_force(BRUSH, by_speed, slip, ROAD).force == pytest.approx(marched(slip), rel=1e-3)


def test_heat_of_a_locked_wheel():
    """q = mu v 6 p_0 y (1 - y): the half integral is 4/3 z^(3/2) - 16/15 z^(5/2), largest at 3/4.

    16 points of quadrature miss the top by less than 1/16 of the patch: 0.5 %.
    """
    effusivity = 650.0
    warm = Brush(LENGTH, PRESSURE, STIFFNESS, effusivity)
    time = 20.0 * LENGTH / ROAD
    top = 4.0 / 3.0 * 0.75**1.5 - 16.0 / 15.0 * 0.75**2.5
    expected = 0.8 * ROAD * 6.0 * PRESSURE * top * math.sqrt(time / math.pi) / effusivity
    assert brush_force(warm, constant, 1.0, ROAD).warming == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(("power", "most"), [(0.1, 0.022), (0.2, 0.08)])
def test_bristles_that_creep_have_less_force(power, most):
    """d tau/dx (1 - s) v/k = s v - v_s with mu(v_s) = tau/p from the entry on, without sticking."""

    def friction(speed, pressure, warming):
        return 0.8 * speed**power + 0.0 * pressure

    def rate(y, stress, slip):
        pressure = 6.0 * PRESSURE * y * (1.0 - y)
        sliding = (np.maximum(stress, 0.0) / (0.8 * pressure)) ** (1.0 / power)
        return STIFFNESS * LENGTH / ((1.0 - slip) * ROAD) * (slip * ROAD - sliding)

    y, excess = np.linspace(1e-6, 1.0 - 1e-6, 20001), []
    for slip in (0.005, 0.02, 0.05, 0.1):
        solved = solve_ivp(
            rate, (y[0], y[-1]), [0.0], "LSODA", y, args=(slip,), rtol=1e-8, atol=1e-2
        )
        creeping = np.trapezoid(solved.y[0], y) / PRESSURE
        excess.append(float(brush_force(BRUSH, friction, slip, ROAD).force) / creeping - 1.0)
    assert min(excess) > 0.0
    assert 0.9 * most < max(excess) < most
