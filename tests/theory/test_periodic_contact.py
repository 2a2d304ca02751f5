"""The boundary elements piece by piece: influence of one element, harmonics, edges."""

import numpy as np
import pytest
from scipy.integrate import quad

from gripscale.theory.half_plane import (
    GridContact,
    contact_edges,
    influence_column,
    nodes,
    pressure_harmonics,
)


def elastic(number):
    return 1.0 / number + 0.0j


@pytest.mark.parametrize("node", [0, 1, 5, 16])
def test_influence_of_a_hat_of_pressure(node):
    """sum_(m != 0) exp(i m x)/|m| = -2 ln|2 sin(x/2)|, averaged over the hat by quadrature.

    Harmonics beyond 16 N are left out: 1/(2 pi^2 16^2) = 2e-4 of 1/N at most.
    """
    points = 32
    step = 2 * np.pi / points

    def integrand(s: float) -> float:
        return (1 - abs(s) / step) * -2 * np.log(abs(2 * np.sin((node * step - s) / 2)))

    parts = [quad(integrand, a, b)[0] for a, b in ((-step, 0), (0, step))]
    expected = sum(parts) / (2 * np.pi)
    assert influence_column(elastic, points)[node] == pytest.approx(expected, abs=3e-4 / points)


def test_a_lagging_surface_is_pushed_up_behind_the_pressure():
    """c(m) = exp(-i delta) at m = 1 alone shifts the response by delta."""
    points, delta = 64, 0.3

    def lagging(number):
        return np.where(number == 1, np.exp(-1j * delta), 0.0)

    angle = 2 * np.pi * np.arange(points) / points
    expected = 2 / points * np.sinc(1 / points) ** 2 * np.cos(angle - delta)
    assert influence_column(lagging, points) == pytest.approx(expected, abs=1e-15)


def test_harmonics_of_a_piecewise_linear_pressure():
    """Against quadrature of the interpolant; the nodes start at -pi."""
    points = 16
    pressure = 1 + np.random.default_rng(3).random(points)
    grid = nodes(points)
    fine = -np.pi + 2 * np.pi * (np.arange(160000) + 0.5) / 160000
    values = np.interp(fine, np.append(grid, np.pi), np.append(pressure, pressure[0]))
    found = pressure_harmonics(pressure)
    for number in (1, 2, 7, 20):
        expected = np.mean(values * np.exp(-1j * number * fine))
        # midpoint rule, (number 2 pi/160000)^2/24
        assert found[number - 1] == pytest.approx(expected, abs=1e-7)


def test_edges_of_two_patches_one_across_the_period():
    """Gaps growing as distance^(3/2) from edges placed inside elements come back exactly."""
    points = 64
    angle = nodes(points)
    edges = [(-0.513, 0.4123), (2.9071, -2.6 + 2 * np.pi)]
    gap = np.full(points, np.inf)
    for start, end in edges:
        for shift in (-2 * np.pi, 0.0, 2 * np.pi):
            outside = np.maximum(start + shift - angle, angle - end - shift)
            gap = np.minimum(gap, np.maximum(outside, 0.0) ** 1.5)
    contact = GridContact(np.ones(points), gap, gap == 0.0, 1, True)
    assert np.array(contact_edges(contact)) == pytest.approx(np.array(edges), abs=1e-12)


def test_all_in_contact_is_one_patch():
    full = GridContact(np.ones(8), np.zeros(8), np.ones(8, dtype=bool), 1, True)
    assert contact_edges(full) == [(-np.pi, np.pi)]
