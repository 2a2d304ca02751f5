"""The boundary elements piece by piece: harmonics and edges."""

import numpy as np
import pytest

from gripscale.theory.half_plane import GridContact, contact_edges, nodes, pressure_harmonics


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
