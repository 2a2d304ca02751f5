"""Passes on two meshes: the fixed point of the fine one, found with few of its solutions."""

import numpy as np
import pytest

from gripscale.conditions.fixed_point import MOST_PASSES, SETTLED, Iteration, solve_coupled
from gripscale.core.errors import ConvergenceError

X = np.array([0.3, -1.2, 0.8])
"""Fixed point of the fine mesh."""
SLOPE = np.array([[0.5, 0.2, 0.0], [-0.4, -1.5, 0.1], [0.0, 0.3, 0.6]])


class Mesh:
    """f(x) = y + slope (x - y) + a bend, y the fixed point; results are what x leaves of two."""

    def __init__(self, at=X, slope=SLOPE, bend=0.05):
        self.at, self.slope, self.bend = at, slope, bend
        self.solved = 0

    def __call__(self, assumed, last):
        self.solved += 1
        x = np.zeros(3) if assumed is None else assumed
        found = self.at + self.slope @ (x - self.at) + self.bend * (x - self.at) ** 2
        return Iteration(self.solved, assumed, found, np.exp(x[:2]))


def results(at):
    return np.exp(at[:2])


def test_the_fixed_point_is_that_of_the_fine_mesh():
    """Another fixed point and another slope on the coarse mesh: four fine solutions, 1e-3."""
    fine = Mesh()
    coarse = Mesh(X + np.array([0.05, -0.1, 0.2]), 0.9 * SLOPE)
    passes = solve_coupled(fine, coarse)
    assert passes.settled
    assert passes.last.results == pytest.approx(results(X), rel=1e-3)
    assert passes.last.results != pytest.approx(results(coarse.at), rel=1e-2)
    assert passes.fine == fine.solved <= 4
    assert passes.coarse == coarse.solved


def test_without_a_coarse_mesh_it_takes_more_passes():
    fine = Mesh()
    passes = solve_coupled(fine, None)
    assert passes.settled
    assert passes.last.results == pytest.approx(results(X), rel=1e-3)
    assert (passes.fine, passes.coarse) == (fine.solved, 0)
    assert passes.fine > 4


def test_a_coarse_mesh_that_says_the_opposite_does_not_decide():
    fine, coarse = Mesh(), Mesh(X + 0.5, -0.8 * SLOPE)
    passes = solve_coupled(fine, coarse)
    assert passes.fine <= MOST_PASSES
    if passes.settled:
        assert passes.last.results == pytest.approx(results(X), rel=1e-2)


@pytest.mark.parametrize("fails_at", [1, 2, 5])
def test_a_coarse_mesh_that_fails_is_given_up(fails_at):
    fine, coarse = Mesh(), Mesh(X + 0.1)

    def failing(assumed, last):
        if coarse.solved == fails_at - 1:
            raise ConvergenceError("no solution")
        return coarse(assumed, last)

    passes = solve_coupled(fine, failing)
    assert passes.settled
    assert passes.last.results == pytest.approx(results(X), rel=1e-3)
    assert passes.fine == fine.solved


def test_what_never_settles_ends():
    """Results that jump by a tenth from pass to pass."""
    fine = Mesh()

    def jumping(assumed, last):
        found = fine(assumed, last)
        return Iteration(0, assumed, found.found + 0.1 * (-1) ** fine.solved, found.results)

    for coarse in (None, Mesh(X + 0.1)):
        fine.solved = 0
        passes = solve_coupled(jumping, coarse)
        assert not passes.settled
        assert passes.fine == fine.solved == MOST_PASSES


def test_a_fine_solution_that_fails_is_the_answer():
    def failed(assumed, last):
        return Iteration("failed", assumed, X, results(X), usable=False)

    for coarse in (None, Mesh()):
        passes = solve_coupled(failed, coarse)
        assert (passes.last.solved, passes.fine, passes.settled) == ("failed", 1, False)


def test_the_bound_is_a_third_of_what_is_promised():
    assert pytest.approx(1e-3 / 3.0, rel=0.2) == SETTLED
