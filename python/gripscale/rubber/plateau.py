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
    return _end(rubber, rubber.equilibrium_modulus, 0, 1.0 / BEYOND)


def fast_end(rubber: Rubber) -> End:
    """Return the glassy modulus, or what was measured last on the way to it, likewise."""
    return _end(rubber, rubber.glassy_modulus, 1, BEYOND)


def _end(rubber: Rubber, limit: float, side: int, factor: float) -> End:
    """Return the `limit` of the series where the admissible ones hardly leave the last modulus.

    `side` is 0 for the low end of the band and of the envelope, 1 for the high end.
    """
    if rubber.valid_band is None:
        return End(limit, True)
    omega = rubber.valid_band[side]
    last = float(rubber.complex_modulus(omega).real)
    if rubber.admissible is None:
        return End(last, False)
    furthest = float(rubber.complex_modulus_band(omega * factor)[side].real)
    plateau = max(furthest / last, last / furthest) <= _CHANGE
    return End(limit if plateau else last, plateau)
