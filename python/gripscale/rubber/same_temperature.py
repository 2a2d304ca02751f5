"""Whether rubbers that stand side by side hold for the same temperature."""

from __future__ import annotations

from collections.abc import Mapping

from gripscale.rubber.material import Rubber
from gripscale.units import ZERO_CELSIUS

_SAME = 0.5
"""Temperatures that differ by less are one [K]: 20 °C and 293 K."""


def temperature_doubts(rubbers: Mapping[str, Rubber]) -> tuple[str, ...]:
    """Return what is doubtful about comparing rubbers, a sentence each; empty if nothing is.

    Parameters
    ----------
    rubbers
        The rubbers by what they are called.

    Returns
    -------
    tuple of str
        That they hold for different temperatures, that some have none stated beside others that
        do, or that a temperature lies beyond those its shift rests on.
    """
    stated = {
        name: rubber.reference_temperature
        for name, rubber in rubbers.items()
        if rubber.reference_temperature is not None
    }
    doubts = []
    if stated and max(stated.values()) - min(stated.values()) > _SAME:
        each = ", ".join(
            f"{name} {kelvin - ZERO_CELSIUS:.1f} °C" for name, kelvin in stated.items()
        )
        doubts.append(f"the rubbers hold for different temperatures: {each}")
    if stated and len(stated) < len(rubbers):
        others = ", ".join(name for name in rubbers if name not in stated)
        doubts.append(
            f"the temperature of {others} is not known beside that of {', '.join(stated)}"
        )
    beyond = [name for name, rubber in rubbers.items() if rubber.shift_extrapolated]
    if beyond:
        doubts.append(f"beyond the temperatures its shift rests on: {', '.join(beyond)}")
    return tuple(doubts)
