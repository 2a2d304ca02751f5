"""From the conditions a case names to what a model needs: laws with their numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from gripscale.case.conditions_table import ConditionsTable, StrainSweeps
from gripscale.conditions.conditions import Conditions
from gripscale.errors import about_keys
from gripscale.interface.thermal import ThermalProperties
from gripscale.rubber import read_strain_sweep
from gripscale.rubber.softening import SofteningLaw, SofteningTable, softening_of_sweeps

Resolve = Callable[[str], Path]


@about_keys("conditions")
def prepare_conditions(table: ConditionsTable, resolve: Resolve = Path) -> Conditions | None:
    """Return the conditions of a case, or None where it asks for no effect.

    `resolve` turns the name of a file into its path.

    Raises `FileError` and `InputError` for files and numbers that cannot be used.
    """
    if table == ConditionsTable():
        return None
    norm = {} if table.strain_norm is None else {"strain_norm": table.strain_norm}
    return Conditions(
        temperature=table.temperature,
        softening=None if table.softening is None else _softening(table.softening, resolve),
        heat=None if table.heat is None else ThermalProperties(**table.heat.model_dump()),
        shear_stress=None if table.shear_stress is None else table.shear_stress.law(),
        **norm,
    )


def _softening(stated: object, resolve: Resolve) -> SofteningLaw:
    if not isinstance(stated, StrainSweeps):
        law: SofteningLaw = stated.law()  # type: ignore[attr-defined]
        return law
    return _of_sweeps(stated, resolve)


def _of_sweeps(stated: StrainSweeps, resolve: Resolve) -> SofteningTable:
    given = stated.model_dump(exclude={"kind", "files", "measured_at"})
    sweeps = [read_strain_sweep(resolve(name), **given) for name in stated.files]
    return softening_of_sweeps(sweeps, measured_at=stated.measured_at)
