"""Whether a rubber's moduli level off within the data: only there is a modulus relaxed or glassy.

A plateau counts as measured where no admissible series leaves the modulus of the end of the data by
more than a fifth within the two decades beyond it.
"""

from __future__ import annotations

from dataclasses import dataclass

from gripscale.rubber.material import Rubber

BEYOND = 100.0
"""How far beyond the data uncertainty is stated: a factor of frequency, two decades."""
_CHANGE = 1.25


@dataclass(frozen=True)
class End:
    """One end of what is known of a rubber."""

    modulus: float
    """Storage modulus [Pa]: of the plateau, or at the last frequency measured."""
    plateau: bool
    """Whether it is the relaxed, or the glassy, modulus."""


def slow_end(rubber: Rubber) -> End:
    """Return the relaxed modulus, or what was measured last on the way to it.

    A rubber without a measured band is what its series says it is.
    """
    if rubber.valid_band is None:
        return End(rubber.equilibrium_modulus, True)
    omega = rubber.valid_band[0]
    modulus = float(rubber.complex_modulus(omega).real)
    if rubber.admissible is None:
        return End(modulus, False)
    least = float(rubber.complex_modulus_band(omega / BEYOND)[0].real)
    plateau = least * _CHANGE >= modulus
    return End(rubber.equilibrium_modulus if plateau else modulus, plateau)


def fast_end(rubber: Rubber) -> End:
    """Return the glassy modulus, or what was measured last on the way to it, likewise."""
    if rubber.valid_band is None:
        return End(rubber.glassy_modulus, True)
    omega = rubber.valid_band[1]
    modulus = float(rubber.complex_modulus(omega).real)
    if rubber.admissible is None:
        return End(modulus, False)
    most = float(rubber.complex_modulus_band(omega * BEYOND)[1].real)
    plateau = most <= _CHANGE * modulus
    return End(rubber.glassy_modulus if plateau else modulus, plateau)
