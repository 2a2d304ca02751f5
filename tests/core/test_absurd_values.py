"""Every public function, every argument, every absurd value: an answer or one sentence.

Warnings are errors here. The sentence names an argument of the function, or what follows from it.
"""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from gripscale.core.checks import short_repr
from gripscale.core.errors import ConvergenceError, FileError, InputError
from tests.core.public_functions import public_functions

FOLLOWS = ("omega", "wavelength", "amplitude", "load_time", "profile", "heights", "temperature")
"""What else a sentence may name: it follows from the arguments."""

NEVER = ["3 barrels", b"1", object(), {}, 1 + 1j, float("nan"), -float("inf"), 10**5000, -(10**400)]
"""What no argument takes."""

WORDS = [
    *(None, True, "", abs, [], [None], [1.0], [[1.0], [2.0]], ["1", "2"], [True, False], [10**400]),
    *(np.str_("x"), np.datetime64("2020"), np.complex128(1), np.array([1 + 0j]), np.bool_(True)),
    *(np.array(["1"]), np.array([[[1.0]]]), Decimal("nan"), np.ma.masked, range(3)),
    np.ma.masked_array([1.0, 2.0], [True, False]),
]
NUMBERS = [
    *(float("inf"), 10**400, 1e308, -1e308, 1e-320, 1e-300, 1e155, 1e101, 1e100, 1e60, 1e30),
    *(1e-30, 1e-60, 1e-100, 1e-101, -1.0, -0.0, 0, 7, 2**64, Fraction(1, 3)),
    *(np.float64(1e308), np.float32(1.0), np.int64(7), np.array(1.0), np.array([1.0, 2.0])),
    *(np.array([np.nan, 1.0]), np.array([1e308, 1.0]), np.array([1e-320, 1.0])),
]
LONGEST = 300
COMPLEX = ("plane_strain_modulus", "youngs_modulus")
DOORS = list(public_functions())


def fault(function, argument, value):
    """Return what is wrong with the answer to an absurd value, None if nothing is."""
    try:
        found = function.call(**{**function.good, argument: value})
    except InputError as error:
        said = str(error)
        if not said.isprintable() or len(said) > LONGEST:
            return f"no sentence: {said[:400]!r}"
        names = [name.removesuffix("s") for name in (*function.good, *FOLLOWS)]
        return None if any(name in said for name in names) else f"names nothing: {said}"
    except (FileError, ConvergenceError):
        return None
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    told = getattr(found, "friction", 0.0) if getattr(found, "converged", False) else 0.0
    return None if np.isfinite(told).all() else "converged to NaN"


def faults(function, values):
    """Return what is wrong with any argument at any of the values."""
    return [
        f"{argument} = {short_repr(value)} ({type(value).__name__}): {found}"
        for argument in function.good
        for value in values
        if (found := fault(function, argument, value))
    ]


@pytest.mark.parametrize("function", DOORS, ids=lambda function: function.name)
def test_absurd_values(function):
    found = faults(function, NEVER if function.slow else [*NEVER, *WORDS, *NUMBERS])
    assert not found, f"{len(found)}\n" + "\n".join(found[:12])


@pytest.mark.verification
@pytest.mark.parametrize(
    "function", [d for d in DOORS if d.slow], ids=lambda function: function.name
)
def test_absurd_values_that_may_be_solved(function):
    found = faults(function, [*WORDS, *NUMBERS])
    assert not found, f"{len(found)}\n" + "\n".join(found[:12])


@pytest.mark.parametrize("function", DOORS, ids=lambda function: function.name)
def test_what_nothing_takes_is_refused(function):
    """Not only no other exception: an answer to such a value would be a wrong one."""
    for argument in function.good:
        for value in (object(), 1 + 1j, [object()]):
            if argument in COMPLEX and value == 1 + 1j:
                continue
            with pytest.raises((InputError, FileError)):
                function.call(**{**function.good, argument: value})
