"""A model in other conditions: at another temperature, or without some of what was asked for."""

from __future__ import annotations

from dataclasses import is_dataclass, replace
from typing import Any, TypeVar

from gripscale.conditions import Conditions
from gripscale.errors import InputError
from gripscale.model import Model
from gripscale.rubber import Rubber

M = TypeVar("M", bound=Model)

EFFECTS = ("temperature", "softening", "heat")
"""What conditions do to the rubber; the area term does nothing to it."""

ALL, NONE = "all", "none"
WITHOUT = {f"no {effect}": effect for effect in EFFECTS}
"""Words for everything but one effect."""
SELECTIONS = (ALL, *WITHOUT, NONE)


def conditions_of(model: Model) -> Conditions:
    """Return the conditions of a model, empty ones if it has none.

    Raises `InputError` if the model does not know conditions.
    """
    if not (is_dataclass(model) and hasattr(model, "conditions")):
        raise InputError(
            f"temperature and effects belong to a model with conditions, such as chain and direct; "
            f"got the model {model.name}"
        )
    return model.conditions or Conditions()


def at_temperature(model: M, kelvin: float) -> M:
    """Return `model` with another temperature before the contact [K]."""
    return _with(model, replace(conditions_of(model), temperature=kelvin))


def effects_asked(model: Model) -> list[str]:
    """Return which of `EFFECTS` the conditions of a model have."""
    conditions = conditions_of(model)
    return [effect for effect in EFFECTS if getattr(conditions, effect) is not None]


def with_effects(model: M, selection: str) -> M:
    """Return `model` with one of `SELECTIONS` of its effects; its area term stays.

    Raises `InputError` if the effect to be left out is not one that the model has.
    """
    left_out = effects_asked(model) if selection == NONE else []
    if selection in WITHOUT:
        left_out = [WITHOUT[selection]]
        asked = effects_asked(model)
        if left_out[0] not in asked:
            raise InputError(
                f"effects must be left out of those the conditions have, "
                f"{', '.join(asked) or 'none'}; got {selection!r}"
            )
    nothing: dict[str, Any] = dict.fromkeys(left_out)
    return _with(model, replace(conditions_of(model), **nothing))


def rubber_before(rubber: Rubber, model: Model) -> Rubber:
    """Return `rubber` at the temperature it has before the contact of `model`.

    Raises `InputError` if it has no shift, or none to this temperature.
    """
    conditions: Conditions | None = getattr(model, "conditions", None)
    return rubber if conditions is None else conditions.before(rubber)


def _with(model: M, conditions: Conditions) -> M:
    changed: Any = replace(model, conditions=conditions)  # type: ignore[type-var]
    return changed  # type: ignore[no-any-return]
