"""Every setting of the solver can be seen and changed from Python, and only those."""

import math

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


def block(**settings):
    return FiniteStrainBlock(Mesh(32, 8), settings=settings)


def test_defaults_have_a_name_a_value_and_a_sentence():
    defaults = default_settings()
    assert (defaults["max_iterations"], defaults["residual_tolerance"]) == (40, 1e-8)
    lines = describe_settings().splitlines()
    assert len(lines) == len(defaults)
    assert all(line.partition(" = ")[0] in defaults and line.endswith(".") for line in lines)


def test_a_setting_reaches_the_solver():
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
def test_a_setting_out_of_its_range_is_refused(settings, words):
    with pytest.raises(gs.InputError) as caught:
        block(**settings).solve(PROBLEM)
    assert words in str(caught.value)


def test_every_status_of_the_kernel_is_a_status():
    for word, sentence, advice in _kernel.statuses():
        assert Status(word) == word
        assert sentence.endswith(".")
        assert advice.endswith(".") == (word != Status.CONVERGED)


# Every value `solve_scale` cannot use is refused in a sentence that names it.

GOOD = {"wavelength": 1e-3, "amplitude": 1e-4, "pressure": 1e5, "speed": 0.1}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wavelength": 0.0}, r"wavelength must be greater than zero \[m\]; got 0"),
        ({"wavelength": math.nan}, r"wavelength must be a finite number \[m\]; got nan"),
        ({"amplitude": -1e-4}, r"amplitude must be greater than zero \[m\]; got -0.0001"),
        ({"pressure": 0}, r"pressure must be greater than zero \[Pa\]; got 0"),
        ({"pressure": math.inf}, r"pressure must be a finite number \[Pa\]; got inf"),
        ({"pressure": "3 barrels"}, r"pressure = '3 barrels': unknown unit 'barrels'"),
        ({"speed": -1.0}, r"speed must not be negative \[m/s\]; got -1"),
        ({"load_time": -1.0}, r"load_time must not be negative \[s\]; got -1"),
        ({"load_time": math.nan}, r"load_time must be a finite number \[s\]; got nan"),
        ({"columns": 2}, r"columns must be a whole number from 4 to 4096; got 2"),
        ({"columns": 32.5}, r"columns must be a whole number from 4 to 4096; got 32.5"),
        ({"rows": 1}, r"rows must be a whole number from 2 to 256; got 1"),
        ({"depth": 0.0}, r"depth must be greater than zero; got 0"),
        ({"residual_tolerance": 0.0}, r"residual_tolerance must be from 1e-15 to 1.0; got 0"),
        ({"time_limit": 0.0}, r"time_limit must be greater than zero \[s\]; got 0"),
        ({"workers": 0}, r"workers must be a whole number from 1 to 1024; got 0"),
        ({"workers": 1.5}, r"workers must be a whole number from 1 to 1024; got 1.5"),
        ({"element_order": 3}, r"element_order must be a whole number from 1 to 2; got 3"),
    ],
)
def test_bad_value(change, message):
    with pytest.raises(gs.InputError, match=message):
        gs.solve_scale(gs.Rubber(3e6), **(GOOD | change))


def test_a_wave_that_cannot_be_solved_says_so():
    """One Newton iteration is not enough at large strain: a status, not an exception."""
    steep = GOOD | {"amplitude": 3e-4, "pressure": 3e6}
    result = gs.solve_scale(gs.Rubber(3e6), **steep, columns=32, rows=8, max_iterations=1)
    assert result.status == "iteration limit"
    assert result.why.startswith("iteration limit at ")
    assert not result.converged
