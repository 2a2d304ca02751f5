"""Every setting of the solver can be seen and changed from Python, and only those."""

from __future__ import annotations

import pytest

import gripscale as gs
from gripscale import _kernel
from gripscale.core.status import Status
from gripscale.wave import (
    FiniteStrainBlock,
    Mesh,
    Sine,
    WaveLoad,
    WaveProblem,
    WaveSolver,
    default_settings,
    describe_settings,
)

PROBLEM = WaveProblem(gs.Rubber(3e6), Sine(1e-3, 1e-4), WaveLoad(5e5))


def block(**settings: float) -> FiniteStrainBlock:
    return FiniteStrainBlock(Mesh(32, 8), settings=settings)


def test_defaults_have_a_name_a_value_and_a_sentence() -> None:
    defaults = default_settings()
    assert (defaults["max_iterations"], defaults["residual_tolerance"]) == (40, 1e-8)
    lines = describe_settings().splitlines()
    assert len(lines) == len(defaults)
    assert all(line.partition(" = ")[0] in defaults and line.endswith(".") for line in lines)


def test_a_setting_reaches_the_solver() -> None:
    assert isinstance(block(), WaveSolver)
    assert block().solve(PROBLEM).converged
    few = block(max_iterations=1, iteration_budget=3).solve(PROBLEM)
    assert few.status == Status.ITERATION_LIMIT
    assert block(residual_tolerance=1e-12).solve(PROBLEM).residual < 1e-12


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"max_iteration": 3}, "unknown setting max_iteration; did you mean max_iterations?"),
        ({"max_iterations": 0}, "max_iterations must be a whole number from 1 to 1000; got 0"),
        ({"largest_step": "big"}, "largest_step must be a finite number; got 'big'"),
        ({"largest_step": -1.0}, "largest_step must be from 1e-6 to 100"),
    ],
)
def test_a_setting_out_of_its_range_is_refused(settings: dict[str, float], words: str) -> None:
    with pytest.raises(gs.InputError) as caught:
        block(**settings).solve(PROBLEM)
    assert words in str(caught.value)


def test_every_status_of_the_kernel_is_a_status() -> None:
    for word, sentence, advice in _kernel.statuses():
        assert Status(word) == word
        assert sentence.endswith(".")
        assert advice.endswith(".") == (word != Status.CONVERGED)
