"""From the surface, rubber and conditions a case names to what a model needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.case.read import CaseFile
from gripscale.case.rubber_tables import ConditionsTable, RubberSource, StrainSweeps
from gripscale.case.tables import SurfaceTable
from gripscale.chain.chain import Chain, wave_solver
from gripscale.conditions.conditions import Conditions
from gripscale.core.errors import GripscaleError, InputError, about_keys
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
    read_strain_sweep,
    read_sweeps,
    styrene_butadiene,
    superpose_report,
)
from gripscale.rubber.columns import FileLayout
from gripscale.rubber.softening import SofteningLaw, softening_of_sweeps
from gripscale.rubber.sweeps import holds_sweeps
from gripscale.surface import (
    CutOffRule,
    HeightMap,
    Measured,
    Profile,
    SineStack,
    Surface,
    clean,
    clean_map,
    find_cut_off,
    fit_self_affine,
    fit_sines,
    height_difference,
    read_map,
    read_profile,
)

Resolve = Callable[[str], Path]

FIT_KEYS = (
    "scales",
    "smallest_wavelength",
    "cut_off",
    "s_wavelength",
    "s_amplitude",
    "first_wavelength",
    "first_amplitude",
    "single_factor",
    "smallest_lag",
    "largest_lag",
)
"""Keys of the case's [surface] that say how sine waves are fitted."""

COUNTED_KEYS = ("top_height_fraction", "max_lag")
"""Keys of the case's [surface] that say which heights and lags count in the correlation."""


@about_keys("surface")
def prepare_surface(surface: SurfaceTable, resolve: Resolve = Path) -> Surface:
    """Read, clean and describe the profiles or the map of `surface`, or take its waves as stated.

    `resolve` turns the name of a file into its path.

    Raises `FileError` and `InputError` as reading, cleaning and fitting do.
    """
    if surface.sines is not None:
        stack = SineStack(
            wavelength=np.array([wave.wavelength for wave in surface.sines]),
            amplitude=np.array([wave.amplitude for wave in surface.sines]),
        )
        return Surface(stack, "sine waves stated in the case")
    paths = [resolve(name) for name in surface.measured_files]
    measured = _map(surface, paths[0]) if surface.map else _profiles(surface, paths)
    counted = {key: getattr(surface, key) for key in COUNTED_KEYS}
    correlation = height_difference(measured.cleaned, **counted)
    try:
        measured = replace(measured, self_affine=fit_self_affine(correlation))
    except GripscaleError as error:  # the sine waves do not need a self-affine surface
        measured = replace(measured, no_self_affine=str(error))
    fit = {key: getattr(surface, key) for key in FIT_KEYS}
    if surface.cut_off is not None:
        where = str(paths[0]) if len(paths) == 1 else f"{len(paths)} profiles"
        fit["cut_off"] = _cut_off_wavelength(measured, surface.cut_off, where)
    return Surface(
        fit_sines(correlation, **fit),
        ", ".join(str(path) for path in paths),
        correlation,
        fit,
        measured,
        counted,
        surface.cut_off,
    )


def _cut_off_wavelength(measured: Measured, rule: CutOffRule, where: str) -> float:
    """Return where the roughness ends [m]; an error begins with `where`."""
    if isinstance(rule, float):
        return rule
    try:
        return find_cut_off(measured.slopes, rule).wavelength
    except InputError as error:
        raise InputError(f"{where}: {error}") from error


def _profiles(surface: SurfaceTable, paths: list[Path]) -> Measured:
    """Read and clean profiles."""
    profiles, reports = [], []
    for path in paths:
        raw = read_profile(
            path,
            x_unit=surface.x_unit,
            z_unit=surface.z_unit,
            direction=surface.direction,
            channel=surface.channel,
            sheet=surface.sheet,
            reader=surface.reader,
        )
        try:
            cleaned, report = clean(
                raw,
                crop=_pair(surface.crop),
                valid_range=_pair(surface.valid_range),
                remove_spikes=surface.remove_spikes,
                spike_slope=surface.spike_slope,
                across_gaps=surface.across_gaps,
                detrend=surface.detrend,
            )
        except InputError as error:
            raise InputError(f"{path}: {error}") from error
        profiles.append((raw, cleaned))
        reports.append(report)
    return Measured(profiles, reports, None, "")


def _map(surface: SurfaceTable, path: Path) -> Measured:
    """Read and clean a map, turned so that its x is the way of sliding."""
    raw = read_map(
        path,
        x_unit=surface.x_unit,
        z_unit=surface.z_unit,
        step=_pair(surface.step),
        channel=surface.channel,
        reader=surface.reader,
    )
    raw = raw if surface.direction == "x" else raw.turned()
    try:
        cleaned, report = clean_map(
            raw,
            crop=(_pair(surface.crop), _pair(surface.crop_across)),
            valid_range=_pair(surface.valid_range),
            trim=surface.trim,
            remove_spikes=surface.remove_spikes,
            spike_slope=surface.spike_slope,
            form=surface.form,
        )
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    return Measured([_middle(raw, cleaned)], [report], None, "", cleaned)


def _middle(raw: HeightMap, cleaned: HeightMap) -> tuple[Profile, Profile]:
    """Return a line as read and as cleaned: the fullest, nearest to the middle."""
    away = np.abs(np.arange(cleaned.y.size) - cleaned.y.size // 2)
    fullest = np.lexsort((away, np.isnan(cleaned.z).sum(axis=0)))[0]
    before, after = (
        surface.line(int(np.argmin(np.abs(surface.y - cleaned.y[fullest]))))
        for surface in (raw, cleaned)
    )
    return before, replace(after, name=before.name, source=before.source)


def _pair(limits: list[float] | None) -> tuple[float, float] | None:
    return None if limits is None else (limits[0], limits[1])


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
            reference = self.master.reference_temperature
            return [fit_wlf(self.master.shift, reference_temperature=reference)]
        except InputError:
            return []


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
    path, layout = resolve(source.file), source.layout()
    reading = layout | {"titles_first": titles_first, "source": source.source or str(path)}
    if holds_sweeps(path, FileLayout(**layout)):
        sweeps, master, report = _superposed(path, source, resolve, reading)
    else:
        foreign = [name for name in OF_SWEEPS if name in source.model_fields_set]
        if foreign:
            raise InputError(
                f"{path}: {foreign[0]} is for sweeps at several temperatures; got a master curve"
            )
        reference = source.reference_temperature
        master = read_master_curve(path, reference_temperature=reference, **reading)
        sweeps, report = None, None
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


def _superposed(
    path: Path, source: RubberSource, resolve: Resolve, reading: dict[str, Any]
) -> tuple[Sweeps, MasterCurve, Superposition]:
    """Return sweeps, the master curve they make, and how they meet."""
    sweeps = read_sweeps(path, temperature_step=source.temperature_step, **reading)
    single = len(sweeps) == 1
    reference = None if single and reading["titles_first"] else source.reference_temperature
    if reference is None and not single:
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
    return source.shift


@about_keys("conditions")
def prepare_conditions(table: ConditionsTable, resolve: Resolve = Path) -> Conditions | None:
    """Return the conditions of a case, or None where it asks for no effect.

    `resolve` turns the name of a file into its path.

    Raises `FileError` and `InputError` for files and numbers that cannot be used.
    """
    if table == ConditionsTable():
        return None
    softening: SofteningLaw | None = None
    if isinstance(table.softening, StrainSweeps):
        source = table.softening
        layout = source.layout() | {"strain_unit": source.strain_unit}
        sweeps = [
            read_strain_sweep(resolve(name), amplitude=source.amplitude, **layout)
            for name in source.files
        ]
        softening = softening_of_sweeps(sweeps, measured_at=source.measured_at)
    else:
        softening = table.softening
    return Conditions(
        temperature=table.temperature,
        softening=softening,
        strain_norm=table.strain_norm or "slope",
        heat=table.heat,
        shear_stress=table.shear_stress,
    )


def case_chain(file: CaseFile) -> Chain:
    """Return the chain of a case.

    Raises `FileError` and `InputError` for conditions that cannot be used.
    """
    case = file.case
    solver = wave_solver(case.solver.model, case.solver.options())
    return Chain(
        solver,
        pressure_classes=case.chain.pressure_classes,
        extrapolate=case.rubber.extrapolate,
        conditions=prepare_conditions(case.conditions, file.resolve),
    )
