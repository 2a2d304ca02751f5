"""Time-temperature shifts: formulas, tables, and the kind by which files name them."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.shift.base import Shift
from gripscale.rubber.shift.fits import ShiftFit, fit_arrhenius, fit_wlf
from gripscale.rubber.shift.table import ShiftTable
from gripscale.rubber.shift.table_file import read_shift_table, write_shift_table
from gripscale.rubber.shift.wlf import WLF, Arrhenius, WLFArrhenius

__all__ = [
    "SHIFTS",
    "WLF",
    "Arrhenius",
    "Shift",
    "ShiftFit",
    "ShiftTable",
    "WLFArrhenius",
    "fit_arrhenius",
    "fit_wlf",
    "read_shift_table",
    "shift_at",
    "shift_from_dict",
    "write_shift_table",
]

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


def shift_at(shift: Shift | None, reference_temperature: float | None) -> Shift | None:
    """Return the shift of something that holds for a reference temperature [K].

    Raises `InputError` if it is no shift, or the temperature is not known or beyond its limits.
    """
    if shift is None:
        return None
    if not isinstance(shift, Shift):
        raise InputError(f"shift must be a Shift, such as WLF; got {checks.shown(shift)}")
    if reference_temperature is None:
        raise InputError("reference_temperature [K] must be given with a shift; got None")
    bound = shift.bound(reference_temperature)
    bound.log_a(reference_temperature, reference_temperature)
    return bound
