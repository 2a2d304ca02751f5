"""Time-temperature shifts: formulas, tables, and the kind by which files name them."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.shift.base import Shift
from gripscale.rubber.shift.table import ShiftTable
from gripscale.rubber.shift.wlf import WLF, Arrhenius, WLFArrhenius

__all__ = ["SHIFTS", "WLF", "Arrhenius", "Shift", "ShiftTable", "WLFArrhenius", "shift_from_dict"]

SHIFTS: dict[str, type[Shift]] = {
    law.kind: law for law in (WLF, Arrhenius, WLFArrhenius, ShiftTable)
}
"""Every shift by its kind."""


def shift_from_dict(values: Mapping[str, Any]) -> Shift:
    """Return the shift of `Shift.to_dict`, such as {"kind": "wlf", "c1": 8.0, "c2": 120.0}.

    Raises `InputError` if the kind is unknown, a setting is unknown or one that is needed is not
    there.
    """
    if not isinstance(values, Mapping):
        raise InputError(f"shift must be a mapping with its kind; got {checks.shown(values)}")
    settings = dict(values)
    law = SHIFTS[checks.one_of("kind", settings.pop("kind", None), SHIFTS)]
    checks.known(f"setting of the shift {law.kind}", settings, [one.name for one in fields(law)])
    try:
        return law(**settings)
    except TypeError as error:
        raise InputError(f"the shift {law.kind} lacks a setting ({error})") from error
