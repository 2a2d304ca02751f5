"""Compounds brought to one temperature, as far as their shifts are known."""

from __future__ import annotations

from collections.abc import Mapping

from gripscale.errors import InputError
from gripscale.rubber import Rubber, temperature_doubts
from gripscale.units import ZERO_CELSIUS

_SAME = 0.5
"""Temperatures that differ by less are one [K]: 20 °C and 293 K."""


def at_one_temperature(
    rubbers: Mapping[str, Rubber], temperature: float | None = None
) -> tuple[dict[str, Rubber], tuple[str, ...]]:
    """Return rubbers that hold for one temperature, and what is to be said of that.

    Without a `temperature` it is that of the rubbers which cannot be shifted, or else of the first
    that states one. A rubber whose temperature is not known stays as it is, which is said.

    Parameters
    ----------
    rubbers
        The rubbers by what they are called.
    temperature : float, optional
        Where they are wanted [K].

    Returns
    -------
    tuple
        The rubbers, and a sentence for each that was shifted and for what is doubtful (see
        `gripscale.rubber.temperature_doubts`).

    Raises
    ------
    InputError
        If a rubber would have to be shifted and has no shift.
    """
    stated = {
        name: rubber.reference_temperature
        for name, rubber in rubbers.items()
        if rubber.reference_temperature is not None
    }
    wanted = _common(rubbers, stated) if temperature is None else temperature
    if wanted is None:
        return dict(rubbers), temperature_doubts(rubbers)
    together, shifted = {}, []
    for name, rubber in rubbers.items():
        own = stated.get(name)
        if own is None or abs(own - wanted) <= _SAME:
            together[name] = rubber
            continue
        if rubber.shift is None:
            raise InputError(
                f"{name} holds for {_celsius(own)} and cannot be brought to {_celsius(wanted)}: "
                "give it a shift, or leave it out"
            )
        together[name] = rubber.at(wanted)
        shifted.append(f"{name} shifted from {_celsius(own)} to {_celsius(wanted)}")
    return together, (*shifted, *temperature_doubts(together))


def _common(rubbers: Mapping[str, Rubber], stated: Mapping[str, float]) -> float | None:
    """Return the temperature all can be brought to [K], or None where none is stated."""
    fixed = {name: kelvin for name, kelvin in stated.items() if rubbers[name].shift is None}
    if fixed and max(fixed.values()) - min(fixed.values()) > _SAME:
        each = ", ".join(f"{name} for {_celsius(kelvin)}" for name, kelvin in fixed.items())
        raise InputError(
            "compounds must hold for one temperature, or have a shift to it; got "
            f"{each} without one"
        )
    return next(iter((fixed or stated).values()), None)


def _celsius(kelvin: float) -> str:
    return f"{kelvin - ZERO_CELSIUS:.1f} °C"
