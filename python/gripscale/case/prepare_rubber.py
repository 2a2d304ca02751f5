"""From the rubber a case names to what a model needs: a fitted series, and its shift."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from gripscale.case.rubber_table import RubberSource
from gripscale.errors import InputError, about_keys
from gripscale.rubber import (
    MasterCurve,
    PronyFit,
    Rubber,
    Shift,
    ShiftFit,
    ShiftTable,
    Superposition,
    Sweeps,
    fit_prony_report,
    fit_wlf,
    read_master_curve,
    read_shift_table,
    read_sweeps,
    styrene_butadiene,
    superpose_report,
)
from gripscale.rubber.sweeps_found import holds_sweeps

Resolve = Callable[[str], Path]

_LAYOUT = ("columns", "sheet", "header")
_UNITS = ("temperature_unit", "frequency_unit", "modulus_unit", "modulus")
"""Keys of the case's [rubber] that say where in a file the numbers are, and what they are."""

OF_SWEEPS = ("temperature_step", "vertical")
"""Keys of the case's [rubber] that only sweeps at several temperatures have."""


@dataclass(frozen=True)
class PreparedRubber:
    """A rubber and what it comes from.

    Of a master curve the curve and the report on its fit; of sweeps at several temperatures those,
    too, and how they meet.
    """

    rubber: Rubber
    source: str
    master: MasterCurve | None = None
    fit: PronyFit | None = None
    sweeps: Sweeps | None = None
    superposition: Superposition | None = None

    def shift_fits(self) -> list[ShiftFit]:
        """Return the WLF law of the shift that was found, where it follows one."""
        if self.master is None or not isinstance(self.master.shift, ShiftTable):
            return []
        try:
            found = fit_wlf(
                self.master.shift, reference_temperature=self.master.reference_temperature
            )
        except InputError:
            return []
        return [found]


@about_keys("rubber")
def prepare_rubber(
    source: RubberSource, resolve: Resolve = Path, *, titles_first: bool = False
) -> PreparedRubber:
    """Read and fit the file of `source`, or take the rubber it names.

    `resolve` turns the name of a file into its path. What the source states of the file goes before
    what the file says itself, unless its `titles_first` are to be believed.

    Raises `FileError` and `InputError` as reading, superposition and fitting do.
    """
    bulk: dict[str, Any] = (
        {} if source.bulk_modulus is None else {"bulk_modulus": source.bulk_modulus}
    )
    if source.file is None:
        rubber = replace(styrene_butadiene(**bulk), strain_energy=source.strain_energy)
        return PreparedRubber(_shifted(rubber, source, resolve), rubber.source)
    path = resolve(source.file)
    layout = {name: getattr(source, name) for name in _LAYOUT}
    stated = {name: getattr(source, name) for name in _UNITS}
    told = layout | stated | {"titles_first": titles_first, "source": source.source or str(path)}
    if holds_sweeps(path, **layout):
        sweeps, master, report = _superposed(path, source, resolve, told)
    else:
        sweeps, master, report = None, _master_curve(path, source, told), None
    choice = (
        {} if source.outlier_threshold is None else {"outlier_threshold": source.outlier_threshold}
    )
    try:
        rubber, fit = fit_prony_report(master, terms=source.terms, **bulk, **choice)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    rubber = replace(rubber, strain_energy=source.strain_energy)
    if sweeps is None:
        rubber = _shifted(rubber, source, resolve)
    return PreparedRubber(rubber, master.source, master, fit, sweeps, report)


def _master_curve(path: Path, source: RubberSource, told: dict[str, Any]) -> MasterCurve:
    foreign = [name for name in OF_SWEEPS if name in source.model_fields_set]
    if foreign:
        raise InputError(
            f"{path}: {foreign[0]} is for sweeps at several temperatures; got a master curve"
        )
    return read_master_curve(path, reference_temperature=source.reference_temperature, **told)


def _superposed(
    path: Path, source: RubberSource, resolve: Resolve, told: dict[str, Any]
) -> tuple[Sweeps, MasterCurve, Superposition]:
    """Return sweeps, the master curve they make, and how they meet."""
    sweeps = read_sweeps(path, temperature_step=source.temperature_step, **told)
    alone = len(sweeps) == 1
    reference = None if alone and told["titles_first"] else source.reference_temperature
    if reference is None and not alone:
        raise InputError(
            f'{path}: reference_temperature must be given, such as "20 C", for sweeps at '
            f"{len(sweeps)} temperatures to be shifted to"
        )
    master, report = superpose_report(
        sweeps,
        reference_temperature=float(sweeps.temperatures[0]) if reference is None else reference,
        vertical=source.vertical,
        shift=_shift(source, resolve),
    )
    return sweeps, master, report


def _shifted(rubber: Rubber, source: RubberSource, resolve: Resolve) -> Rubber:
    """Return a rubber of one master curve with the shift that is stated, if one is."""
    shift = _shift(source, resolve)
    if shift is None:
        return rubber
    if rubber.reference_temperature is None:
        raise InputError(
            f"{source.file or source.name}: reference_temperature must be given with shift, such "
            'as "20 C": the master curve does not state what it holds for'
        )
    return replace(rubber, shift=shift)


def _shift(source: RubberSource, resolve: Resolve) -> Shift | None:
    if source.shift is None:
        return None
    if isinstance(source.shift, str):
        return read_shift_table(resolve(source.shift))
    return source.shift.law()
