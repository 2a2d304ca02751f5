"""What a case has without a word about it: softening, heat and the interface of a dry road.

Every tread is filled, and softens; a rubber with a temperature shift warms by its friction; a dry
road shears the real contact area. A case states whether its rubber is filled and its road dry, and
has typical laws where it states none of its own. `gripscale.conditions.conditions` says how far
these laws may be off.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, get_args

from gripscale.conditions.area_term import DRY_TREAD
from gripscale.conditions.conditions import Conditions
from gripscale.conditions.flash_temperature import COUNTERFACE_BY_KIND, ThermalProperties
from gripscale.core import InputError
from gripscale.rubber import Rubber
from gripscale.rubber.softening import TYPICAL_TREAD
from gripscale.surface.surface import SurfaceKind

Interface = Literal["dry"]
DRY = get_args(Interface)


def with_defaults(
    conditions: Conditions | None,
    rubber: Rubber,
    *,
    filled: bool | None,
    interface: Interface | None,
    kind: SurfaceKind,
) -> Conditions | None:
    """Return conditions with what they leave open, or None if nothing changes rubber and contact.

    Raises `InputError` if an unfilled rubber is to soften.
    """
    effects = conditions or Conditions()
    if filled is False and effects.softening is not None:
        raise InputError("filled must be true with softening, which unfilled rubber has none of")
    if effects.water is None:
        if filled and effects.softening is None and "softening" not in effects.off:
            effects = replace(effects, softening=TYPICAL_TREAD)
        warms = rubber.shift is not None and effects.temperature_of(rubber) is not None
        if warms and effects.heat is None and "heat" not in effects.off:
            effects = replace(effects, heat=ThermalProperties())
        if effects.heat is not None and effects.counterface is None:
            effects = replace(effects, counterface=COUNTERFACE_BY_KIND[kind])
    if interface == "dry" and effects.shear_stress is None:
        effects = replace(effects, shear_stress=DRY_TREAD)
    return None if effects == Conditions() else effects
