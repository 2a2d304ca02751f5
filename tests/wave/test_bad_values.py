"""Every value `solve_scale` cannot use is refused in a sentence that names it."""

import math

import pytest

import gripscale as gs

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
    result = gs.solve_scale(
        gs.Rubber(3e6),
        **(GOOD | {"amplitude": 3e-4, "pressure": 3e6}),
        columns=32,
        rows=8,
        max_iterations=1,
    )
    assert result.status == "iteration limit"
    assert result.why.startswith("iteration limit at ")
    assert not result.converged
