"""From the surface, rubber and conditions a case names to what a model needs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import MISSING, fields, replace
from inspect import signature
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from gripscale import rubber as rubbers
from gripscale import surface as surfaces
from gripscale.case import BelowMeasurement, Case, NamedFile, Origin, described_surface
from gripscale.case_file.read import CaseFile, read_case_file
from gripscale.case_file.rubber_tables import (
    OF_ANY_RUBBER,
    ConditionsTable,
    RubberSource,
    StrainSweeps,
)
from gripscale.case_file.schema import CaseTable
from gripscale.case_file.tables import SurfaceTable
from gripscale.chain.chain import Chain, wave_solver
from gripscale.conditions.conditions import Conditions
from gripscale.continuation.roughness import FinerMeasurement, HurstExponent, OwnFaces, Roughness
from gripscale.core import CaseKey, FileError, InputError, Words, about_file, about_keys, unstated
from gripscale.core.units import ZERO_CELSIUS
from gripscale.experiment.measured_friction import read_measured_friction
from gripscale.half_space.grid import MOST_POINTS
from gripscale.io.text_table import lines_by_size, read_bytes
from gripscale.model import FOOTPRINT
from gripscale.rubber.columns import FileLayout
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.rubber.prony import holds_prony_table, read_prony_table
from gripscale.rubber.strain_energy import NeoHookean
from gripscale.rubber.sweeps import TEMPERATURE_TOLERANCE, holds_sweeps, read_shift_of_sweeps

Resolve = Callable[[str], Path]
# What the files of a surface hold, before any cleaning.
RawHeights = surfaces.HeightMap | list[surfaces.Profile]


def _options(table: CaseTable, function: Callable[..., Any]) -> dict[str, Any]:
    """Return the keys of a table that are options of a function by the same name."""
    names = [name for name in signature(function).parameters if name in type(table).model_fields]
    values = {name: getattr(table, name) for name in names}
    return {name: tuple(v) if isinstance(v, list) else v for name, v in values.items()}


@about_keys("surface")
def prepare_surface(
    surface: SurfaceTable,
    resolve: Resolve = Path,
    raw: RawHeights | None = None,
    *,
    footprint: float = FOOTPRINT,
) -> surfaces.Surface:
    """Read, clean and describe the profiles or the map of `surface`, or take its waves as stated.

    `resolve` turns the name of a file into its path. `raw` is what `raw_surface` returns, where the
    files are read already; `footprint` [m] holds waves of profiles.

    Raises `FileError` and `InputError` as reading, cleaning and fitting do.
    """
    if surface.sines is not None:
        waves = np.array([(wave.wavelength, wave.amplitude) for wave in surface.sines])
        return surfaces.Surface(surfaces.SineStack(*waves.T), "sine waves stated in the case")
    measured: surfaces.Measured | surfaces.Spectrum
    if surface.spectrum is not None:
        options, longest = _options(surface, surfaces.read_spectrum), surface.longest_wavelength
        spectrum = surfaces.read_spectrum(resolve(surface.spectrum), **options)
        measured = spectrum if longest is None else spectrum.without_long_waves(longest)
    else:
        raw = raw_surface(surface, resolve) if raw is None else raw
        measured = _cleaned(surface, raw, resolve)
    paths = [resolve(name) for name in surface.measured_files]
    where = str(paths[0]) if len(paths) == 1 else f"{len(paths)} profiles"
    by_rule = not (surface.cut_off is None or isinstance(surface.cut_off, float))
    with about_file(where, InputError) if by_rule else nullcontext():
        return described_surface(
            measured,
            counted=_options(surface, surfaces.height_difference),
            fit=_options(surface, surfaces.fit_sines),
            cut_off=surface.cut_off,
            source=", ".join(str(path) for path in paths),
            footprint=footprint if surface.clean else None,
        )


def case_surface(file: CaseFile) -> surfaces.Surface:
    """Return the surface of a case."""
    footprint = file.case.load.footprint
    return prepare_surface(file.case.surface, file.resolve, footprint=footprint)


def _require_few_points(file: CaseFile) -> None:
    """Raise `InputError` for a text of more points than a contact takes, before it is read."""
    table = file.case.surface
    ends = (table.smallest_wavelength, table.crop, table.map, table.spectrum)
    if any(end is not None for end in ends) or table.cut_off not in (None, "instrument"):
        return
    for path in map(file.resolve, table.measured_files):
        points = lines_by_size(path) if path.is_file() else 0.0
        if points > MOST_POINTS:
            words = (
                f" must be a length, at least {points / MOST_POINTS:.2g} times what the "
                f"measurement carries: {path} has some {points / 1e6:.2g} million "
                f"lines, a contact at most {MOST_POINTS} points, four in each wave"
            )
            raise InputError(Words(f"{file.path}: ", CaseKey("cut_off"), words))


@about_keys("surface")
def raw_surface(surface: SurfaceTable, resolve: Resolve = Path) -> RawHeights:
    """Return what the files of `surface` hold before any cleaning; no profile without files.

    Along x of a map is the way of sliding. Raises `FileError` and `InputError` as reading does.
    """
    paths = [resolve(name) for name in surface.measured_files]
    if surface.map is None:
        options = _options(surface, surfaces.read_profile)
        lays = surface.lay or ["along"] * len(paths)
        channels = surface.channel if isinstance(surface.channel, list) else [surface.channel]
        lines = []
        for (path, lay), channel in product(zip(paths, lays, strict=True), channels):
            line = surfaces.read_profile(path, **options | {"channel": channel})
            name = f"{line.name} {channel}" if len(channels) > 1 else line.name
            reliable = surface.reliable or line.reliable
            lines.append(replace(line, lay=lay, name=name, reliable=reliable))
        return lines
    raw = surfaces.read_map(paths[0], **_options(surface, surfaces.read_map))
    if surface.reliable is not None:
        raw = replace(raw, reliable=surface.reliable)
    return raw if surface.direction == "x" else raw.turned()


def _cleaned(surface: SurfaceTable, raw: RawHeights, resolve: Resolve) -> surfaces.Measured:
    """Clean profiles or a map, which `raw_surface` has read, unless taken as they are."""
    if isinstance(raw, surfaces.HeightMap):
        if not surface.clean:
            return surfaces.Measured.of_map(raw, raw)
        options = _options(surface, surfaces.clean_map)
        options["crop"] = (options["crop"], surface.crop_across)
        with about_file(resolve(surface.measured_files[0]), InputError):
            clean_map, report = surfaces.clean_map(raw, **options)
        return surfaces.Measured.of_map(raw, clean_map, [report])
    if not surface.clean:
        return surfaces.Measured.of(raw)
    return surfaces.Measured.of_raw(raw, _options(surface, surfaces.clean))


# Keys of the case's [rubber] that only sweeps at several temperatures have.
OF_SWEEPS = ("temperature_step", "vertical")


@about_keys("rubber")
def prepare_rubber(
    source: RubberSource, resolve: Resolve = Path, *, titles_first: bool = False
) -> MeasuredRubber:
    """Read and fit the file of `source`, or take the rubber it names.

    `resolve` turns the name of a file into its path. What the source states of the file goes before
    what the file says itself, unless its `titles_first` are to be believed.

    Raises `FileError` and `InputError` as reading, superposition and fitting do.
    """
    options = _options(source, rubbers.fit_prony_report)
    options = {name: value for name, value in options.items() if value is not None}
    if source.file is None:
        rubber = replace(rubbers.styrene_butadiene(**options), strain_energy=source.strain_energy)
        return MeasuredRubber(_shifted(rubber, source, resolve), rubber.source)
    paths, layout = [resolve(name) for name in source.measured_files], source.layout()
    path = paths[0]
    if path.suffix.lower() == ".json" or (len(paths) == 1 and holds_prony_table(path)):
        return _stored_rubber(path, source, resolve)
    if path.is_dir():
        raise FileError(
            f"{path}: expected a file or a list of files; got a folder: `gripscale new` writes the "
            "list"
        )
    origin = source.source or ", ".join(map(str, paths))
    reading = layout | {"titles_first": titles_first, "source": origin}
    sweeps, report = None, None
    if len(paths) > 1 or holds_sweeps(path, FileLayout(**layout)):
        sweeps, master, report = _superposed(paths, source, resolve, reading)
    else:
        foreign = [name for name in OF_SWEEPS if name in source.model_fields_set]
        if foreign:
            raise InputError(
                f"{path}: {foreign[0]} is for sweeps at several temperatures; got a master curve"
            )
        reference = source.reference_temperature
        master = rubbers.read_master_curve(path, reference_temperature=reference, **reading)
    with about_file(path, InputError):
        rubber, fit = rubbers.fit_prony_report(master, **options)
    rubber = replace(rubber, strain_energy=source.strain_energy)
    fit = replace(fit, findings=(*(master if sweeps is None else sweeps).notes, *fit.findings))
    if sweeps is not None and sweeps.is_ramp:
        fit = replace(fit, findings=(*fit.findings, OF_A_RAMP))
        sweeps, report = None, None
    elif sweeps is None:
        rubber = _shifted(rubber, source, resolve)
    return MeasuredRubber(rubber, master.source, master, fit, sweeps, report)


# What `Rubber.to_dict` returns of a rubber of which only the moduli are known.
_DEFAULTS = {
    item.name: item.default for item in fields(rubbers.Rubber) if item.default is not MISSING
} | {"strain_energy": {"kind": NeoHookean.kind}}


def _stored_rubber(path: Path, source: RubberSource, resolve: Resolve) -> MeasuredRubber:
    """Return a Prony series from a table, or a file of `Rubber.to_dict` without its defaults."""
    of_table: set[str] = set() if path.suffix.lower() == ".json" else {"modulus", "modulus_unit"}
    try:
        if of_table:
            options = {"modulus": source.modulus, "modulus_unit": source.modulus_unit}
            values: Any = read_prony_table(path, **options)
        else:
            values = json.loads(read_bytes(path))
    except json.JSONDecodeError as error:
        raise FileError(f"{path} cannot be read as a rubber: {error}") from error
    if not isinstance(values, dict):
        raise FileError(f"{path} cannot be read as a rubber: it is no JSON object")
    keys = source.model_fields_set
    foreign = keys - OF_ANY_RUBBER - of_table - {"reference_temperature", "source"}
    if foreign:
        raise InputError(f"{path}: {min(foreign)} is for measured moduli; got a Prony series")
    with about_file(path, InputError):
        if "equilibrium_modulus" not in values:
            raise InputError("equilibrium_modulus must be given [Pa]; got none")
        rubber = rubbers.Rubber.from_dict(_DEFAULTS | values)
    changes = keys & {"bulk_modulus", "strain_energy", "reference_temperature", "source"}
    rubber = replace(rubber, **{name: getattr(source, name) for name in changes})
    return MeasuredRubber(_shifted(rubber, source, resolve), rubber.source)


_SHIFT = 'shift = { kind = "wlf", c1 = 8.86, c2 = "101.6 K" }'
OF_A_RAMP = (
    "a temperature ramp at one frequency becomes a master curve by the stated shift: "
    "nothing in the file checks this shift"
)


def _superposed(
    paths: list[Path], source: RubberSource, resolve: Resolve, reading: dict[str, Any]
) -> tuple[rubbers.Sweeps, rubbers.MasterCurve, rubbers.Superposition]:
    path = paths[0]
    shift = _shift(source, resolve)
    if shift is None and not source.vertical:
        shift = read_shift_of_sweeps(path, source.layout())
    sweeps = rubbers.read_sweeps(
        paths, tolerance=0.0, temperature_step=source.temperature_step, **reading
    )
    if sweeps.is_ramp and shift is None:
        low, high = (sweeps.temperature[at] - ZERO_CELSIUS for at in (0, -1))
        words = (
            f" must be given, such as {_SHIFT}: a temperature ramp at one frequency "
            f"({sweeps.frequency[0]:.3g} Hz, {low:.0f} to {high:.0f} °C) makes no master curve "
            "without it, sweeps at several frequencies do"
        )
        raise unstated(f"{path}: ", "shift", words)
    if not sweeps.is_ramp and source.temperature_step is None:
        with about_file(path, InputError):
            sweeps = replace(sweeps, tolerance=TEMPERATURE_TOLERANCE)
    single = len(sweeps) == 1
    reference = None if single and reading["titles_first"] else source.reference_temperature
    if reference is None and not single:
        words = f' must be given, such as "20 C", for sweeps at {len(sweeps)} temperatures'
        raise unstated(f"{path}: ", "reference_temperature", words)
    try:
        master, report = rubbers.superpose_report(
            sweeps,
            reference_temperature=float(sweeps.temperatures[0]) if reference is None else reference,
            vertical=source.vertical,
            shift=shift,
        )
    except InputError as error:
        if error.missing != "shift":
            raise
        sentence = error.words.with_keys(lambda _: f"the {_SHIFT}")
        raise InputError(f"{path}: {sentence}", missing="shift") from error
    return sweeps, master, report


def _shifted(rubber: rubbers.Rubber, source: RubberSource, resolve: Resolve) -> rubbers.Rubber:
    shift = _shift(source, resolve)
    if shift is None:
        return rubber
    if rubber.reference_temperature is None:
        where = source.name or source.measured_files[0]
        words = ' must be given with shift, such as "20 C": the master curve does not state it'
        raise unstated(f"{where}: ", "reference_temperature", words)
    return replace(rubber, shift=shift)


def _shift(source: RubberSource, resolve: Resolve) -> rubbers.Shift | None:
    shift: rubbers.Shift | str | None = source.shift
    if not isinstance(shift, str):
        return shift
    path = resolve(shift)
    try:
        return rubbers.read_shift_table(path)
    except InputError as error:
        if error.missing != "temperature_unit" or source.temperature_unit is None:
            raise
        return rubbers.read_shift_table(path, temperature_unit=source.temperature_unit)


_EFFECTS = {field.name for field in fields(Conditions)} & ConditionsTable.model_fields.keys()


@about_keys("conditions")
def prepare_conditions(table: ConditionsTable, resolve: Resolve = Path) -> Conditions | None:
    """Return the conditions of a case, or None where it asks for no effect.

    `resolve` turns the name of a file into its path.

    Raises `FileError` and `InputError` for files and numbers that cannot be used.
    """
    if table == ConditionsTable():
        return None
    effects: dict[str, Any] = {
        name: getattr(table, name) for name in _EFFECTS if getattr(table, name) is not None
    }
    if isinstance(table.softening, StrainSweeps):
        effects["softening"] = table.softening.softening(resolve)
    return Conditions(**effects)


@about_keys("below_measurement")
def _below_measurement(file: CaseFile) -> BelowMeasurement:
    table, finer = file.case.below_measurement, file.case.below_measurement.finer
    roughness: Roughness = OwnFaces()
    if table.hurst is not None:
        roughness = HurstExponent(table.hurst)
    elif finer is not None and finer.map is not None:
        face = surfaces.read_map(file.resolve(finer.map), **_options(finer, surfaces.read_map))
        face = face if finer.direction == "x" else face.turned()
        roughness = FinerMeasurement(surfaces.clean_map(face)[0])
    elif finer is not None:
        options = _options(finer, surfaces.read_profile)
        line = surfaces.read_profile(file.resolve(finer.file or ""), **options)
        roughness = FinerMeasurement(surfaces.clean(line)[0])
    return BelowMeasurement(table.down_to, roughness, table.seed)


def case_chain(file: CaseFile, conditions: Conditions | None = None) -> Chain:
    """Return the chain of a case, under its own conditions where they are not given.

    Raises `FileError` and `InputError` for conditions that cannot be used.
    """
    case = file.case
    conditions = conditions or prepare_conditions(case.conditions, file.resolve)
    return Chain(
        wave_solver(case.solver.model, case.solver.options()),
        pressure_classes=case.chain.pressure_classes,
        extrapolate=case.rubber.extrapolate,
        conditions=conditions and conditions.dry,
    )


def named_files(file: CaseFile) -> list[NamedFile]:
    """Return the files that a case names, with their checksums."""
    files = []
    for role, name in file.case.named_files():
        content = read_bytes(file.resolve(name))
        files.append(NamedFile(role, name, len(content), hashlib.sha256(content).hexdigest()))
    return files


def read_case(path: CaseFile | str | Path) -> Case:
    """Read a case file (TOML, `gripscale keys`) with all it names, and fit what it asks for.

    The case keeps its text, the units it states and the checksums of its files. Raises `FileError`
    or `InputError` for what cannot be read or used.

        >>> gs.read_case("case.toml").rubber.name
        'tread'
    """
    file = path if isinstance(path, CaseFile) else read_case_file(path)
    if file.case.below_measurement.down_to is not None and file.case.surface.map is not None:
        raise InputError(f"{file.path}: [below_measurement] needs measured profiles; got a map")
    # measured friction is refused before anything is fitted
    name, friction = file.case.measured.friction, None
    if name is not None:
        with about_keys("measured"):
            friction = read_measured_friction(file.resolve(name))
    conditions = prepare_conditions(file.case.conditions, file.resolve)
    chain = case_chain(file, conditions)
    _require_few_points(file)
    surface = case_surface(file)
    rubber = prepare_rubber(file.case.rubber, file.resolve)
    table, source = file.case.surface, file.case.rubber
    filled = source.filled
    if filled is None and source.name is not None and file.case.conditions.softening is None:
        filled = False  # those known by name, unless they are to soften
    cleaned = table.clean and surface.measured is not None and surface.spectrum is None
    with about_keys("rubber.shift"):
        try:
            return Case(
                surface,
                rubber,
                **file.case.load.model_dump(),
                kind=table.kind,
                thickness=source.thickness,
                chain=chain,
                conditions=conditions,
                filled=filled,
                interface=file.case.conditions.interface,
                below_measurement=_below_measurement(file),
                klueppel_heinrich=file.case.compare,
                friction=friction,
                cleaning=_options(table, surfaces.clean) if cleaned else None,
                options={"uncertainty": file.case.uncertainty.model_dump(exclude_none=True)},
                origin=Origin(
                    str(file.path),
                    file.text,
                    file.units,
                    named_files(file),
                    (*(table.assumed or ()), *(source.assumed or ())),
                ),
            )
        except InputError as error:
            raise InputError(f"{file.path}: [conditions] {error}") from error
