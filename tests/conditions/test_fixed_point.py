"""Fixed point of a fine mesh with the help of a coarse one: few fine solutions suffice."""

import numpy as np
import pytest

from gripscale.conditions.fixed_point import MOST_PASSES, Iteration, solve_fixed_point
from gripscale.core.errors import ConvergenceError

X = np.array([0.3, -1.2, 0.8])
"""Fixed point of the fine mesh."""
SLOPE = np.array([[0.5, 0.2, 0.0], [-0.4, -1.5, 0.1], [0.0, 0.3, 0.6]])


class Mesh:
    """f(x) = y + slope (x - y) + bend (x - y)^2, y the fixed point; the results are exp(x)."""

    def __init__(self, at=X, slope=SLOPE, bend=0.05):
        self.at, self.slope, self.bend = at, slope, bend
        self.solved = 0

    def __call__(self, x, last):
        self.solved += 1
        at = np.zeros(3) if x is None else x
        value = self.at + self.slope @ (at - self.at) + self.bend * (at - self.at) ** 2
        return Iteration(self.solved, x, value, np.exp(at[:2]))


def results(at):
    return np.exp(at[:2])


def test_the_fixed_point_is_that_of_the_fine_mesh():
    """Another fixed point and another slope on the coarse mesh: four fine solutions, 1e-3."""
    fine = Mesh()
    coarse = Mesh(X + np.array([0.05, -0.1, 0.2]), 0.9 * SLOPE)
    fixed_point = solve_fixed_point(fine, coarse)
    assert fixed_point.converged
    assert fixed_point.last.results == pytest.approx(results(X), rel=1e-3)
    assert fixed_point.last.results != pytest.approx(results(coarse.at), rel=1e-2)
    assert fixed_point.fine == fine.solved <= 4
    assert fixed_point.coarse == coarse.solved


def test_without_a_coarse_mesh_it_takes_more_solutions():
    fine = Mesh()
    fixed_point = solve_fixed_point(fine, None)
    assert fixed_point.converged
    assert fixed_point.last.results == pytest.approx(results(X), rel=1e-3)
    assert (fixed_point.fine, fixed_point.coarse) == (fine.solved, 0)
    assert fixed_point.fine > 4


@pytest.mark.parametrize("fails_at", [1, 2, 5])
def test_a_coarse_mesh_that_fails_is_not_used_any_more(fails_at):
    fine, coarse = Mesh(), Mesh(X + 0.1)

    def failing(x, last):
        if coarse.solved == fails_at - 1:
            raise ConvergenceError("no solution")
        return coarse(x, last)

    fixed_point = solve_fixed_point(fine, failing)
    assert fixed_point.converged
    assert fixed_point.last.results == pytest.approx(results(X), rel=1e-3)
    assert fixed_point.fine == fine.solved


def test_an_iteration_without_a_fixed_point_ends():
    """Results that jump by a tenth from pass to pass."""
    fine = Mesh()

    def jumping(x, last):
        evaluation = fine(x, last)
        return Iteration(0, x, evaluation.value + 0.1 * (-1) ** fine.solved, evaluation.results)

    for coarse in (None, Mesh(X + 0.1)):
        fine.solved = 0
        fixed_point = solve_fixed_point(jumping, coarse)
        assert not fixed_point.converged
        assert fixed_point.fine == fine.solved == MOST_PASSES


def test_a_fine_solution_that_fails_is_the_answer():
    def failed(x, last):
        return Iteration("failed", x, X, results(X), usable=False)

    for coarse in (None, Mesh()):
        fixed_point = solve_fixed_point(failed, coarse)
        assert (fixed_point.last.solution, fixed_point.fine, fixed_point.converged) == (
            "failed",
            1,
            False,
        )
