"""Whether a rubber is still solid after a load has lasted: its relaxation modulus against pressure.

A block under a mean pressure of many times its modulus is squeezed into full contact and beyond
what a solid can be: there is no partial contact to solve for, and no solution is found.
"""

from __future__ import annotations

import math

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.material import Rubber

MOST_PRESSURE = 10.0
"""Mean pressure over relaxation modulus that is let through; at slopes near one, three is full."""


def require_solid(rubber: Rubber, pressure: float, load_time: float) -> None:
    """Raise `InputError` unless E(t) after `load_time` [s] can carry `pressure` [Pa].

    At rest the time is infinite and E(t) the equilibrium modulus.
    """
    checks.instance("rubber", rubber, Rubber)
    modulus = float(rubber.relaxation_modulus(load_time))
    if pressure <= MOST_PRESSURE * modulus:
        return
    at_rest = math.isinf(load_time)
    name = "equilibrium_modulus" if at_rest else f"the relaxation modulus after {load_time:.3g} s"
    flows = (
        "; leave out the static contact of a melt, in a case by static = false" if at_rest else ""
    )
    raise InputError(
        f"{name} [Pa] must be at least 1/{MOST_PRESSURE:g} of the pressure, "
        f"{pressure / MOST_PRESSURE:.3g}, for a contact that is not squeezed flat{flows}; "
        f"got {modulus:.3g}"
    )
