"""Surfaces and rubbers that a command names by files, read with the settings of its case."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from gripscale.case_file.prepare import case_surface, prepare_rubber, prepare_surface
from gripscale.case_file.read import CaseFile, read_case_file, validate
from gripscale.case_file.rubber_tables import NAMED_RUBBERS, RubberSource
from gripscale.case_file.tables import SpectrumKeys, SurfaceTable
from gripscale.core import ZERO_CELSIUS, FileError
from gripscale.experiment.design import OF_THE_CASE, named_values
from gripscale.io.text_table import is_excel
from gripscale.rubber import Rubber
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.rubber.sweeps import states_temperature
from gripscale.surface import SineStack, Surface
from gripscale.surface.read_spectrum import holds_spectrum
from gripscale.surface.synthetic import SYNTHETIC_SURFACES

SOURCES_OF_SURFACE = {"files", "map", "spectrum", "sines", "assumed", *SpectrumKeys.model_fields}
# Keys of the case's [surface] that belong to its own files.
OF_ONE_ROAD = ("crop", "crop_across", "z_axis")
_NO_KEYS: Mapping[str, Any] = MappingProxyType({})
# Keys of the case's [rubber] that another file is read with where it does not state them.
OF_A_FILE = (
    *("frequency_unit", "modulus_unit", "temperature_unit"),
    *("modulus", "columns", "reference_temperature"),
)


def read_named_inputs(
    vary: Mapping[str, Any], file: CaseFile, modulus: str | None = None
) -> dict[str, Any]:
    """Return varied inputs with surfaces and rubbers read from the files they name.

    `modulus` is E or G, of files of moduli that do not state it.
    """
    inputs = dict(vary)
    read_moduli = partial(read_rubber, modulus=modulus)
    for axis, read in (("surface", read_surface), ("rubber", read_moduli)):
        if axis in inputs:
            values, labels = named_values(axis, inputs[axis])
            objects = [read(value, file) for value in values]
            inputs[axis] = dict(zip(labels, objects, strict=True))
    return inputs


def read_surface(value: Any, file: CaseFile, options: Mapping[str, Any] = _NO_KEYS) -> Any:
    """Return a surface that a command names, with a note on how it was read.

    `value` is the path of another case (its [surface] is taken), or of a profile or, of a case on a
    map, a map, read with all other settings of the case but the crop, which belongs to its own
    files; `options`, keys of [surface], go before those of the case. "case", synthetic surfaces
    known by name and surfaces are returned as they are.
    """
    if isinstance(value, Surface | SineStack) or value in (OF_THE_CASE, *SYNTHETIC_SURFACES):
        return value
    path = _path("surface", value, file, (OF_THE_CASE, *SYNTHETIC_SURFACES))
    if path.suffix == ".toml":
        return case_surface(read_case_file(path))
    table = file.case.surface
    outside = set() if path.resolve() in map(file.resolve, table.measured_files) else {*OF_ONE_ROAD}
    settings = table.model_dump(exclude_unset=True, exclude=SOURCES_OF_SURFACE | outside)
    if table.sines is not None:
        settings["scales"] = len(table.sines)
    source: dict[str, Any] = {"files": [str(path)]} if table.map is None else {"map": str(path)}
    source = {"spectrum": str(path)} if holds_spectrum(path) else source
    settings |= {**source, **options}
    surface = prepare_surface(
        validate(SurfaceTable, settings, "vary surface"), footprint=file.case.load.footprint
    )
    if not outside:
        return surface
    keys = table.model_fields_set - SOURCES_OF_SURFACE
    applied, without = sorted(keys - outside), sorted(keys & outside)
    note = f"{value}: read with {', '.join(applied) or 'nothing'} of the case"
    if without:
        note += f", but not {' and '.join(without)}, which belongs to the road of the case"
    return replace(surface, note=note)


def read_rubber(value: Any, file: CaseFile, modulus: str | None = None) -> Any:
    """Return a rubber that a command names, with what it comes from and what was assumed.

    `value` is a rubber known by name, the path of another case (its [rubber] is taken), or of a
    file of moduli. A file is read with what the case's [rubber] says of its own file (units, kind
    of modulus, columns, reference temperature) where it does not say so itself; its rubber has the
    bulk modulus, the strain energy and the limit of outliers of the case. "case" and rubbers are
    returned as they are. `modulus` is E or G, of a file that does not state it, in place of what
    the case says.
    """
    if isinstance(value, Rubber | MeasuredRubber) or value == OF_THE_CASE:
        return value
    table = file.case.rubber
    settings: dict[str, Any] = {"strain_energy": table.strain_energy}
    if table.bulk_modulus is not None:
        settings["bulk_modulus"] = table.bulk_modulus
    if value in NAMED_RUBBERS:
        return _rubber({"name": value, **settings})
    path = _path("rubber", value, file, (OF_THE_CASE, *NAMED_RUBBERS))
    if path.suffix == ".toml":
        other = read_case_file(path)
        return prepare_rubber(other.case.rubber, other.resolve)
    if path.suffix.lower() == ".json":  # a Prony series states all of itself
        return _rubber({"file": str(path)})
    names = (*OF_A_FILE, "sheet") if is_excel(path) else OF_A_FILE
    shared = {name: getattr(table, name) for name in names if getattr(table, name) is not None}
    shared |= {} if modulus is None else {"modulus": modulus}
    if "reference_temperature" in shared:
        shared["reference_temperature"] = f"{shared['reference_temperature']!r} K"
    source = f"{path}, read with these settings of the rubber of the case: {', '.join(shared)}"
    origin = {"source": source} if shared else {}
    if table.outlier_threshold is not None:
        settings["outlier_threshold"] = table.outlier_threshold
    rubber = _rubber({"file": str(path), **settings, **shared, **origin}, titles_first=True)
    kelvin = table.reference_temperature
    if kelvin is None or states_temperature(path):
        return rubber
    return replace(
        rubber,
        note=f"{value}: the file states no temperature; its moduli are assumed to be those at "
        f"{kelvin - ZERO_CELSIUS:.4g} °C, the reference temperature of the case.",
    )


def _rubber(settings: dict[str, Any], *, titles_first: bool = False) -> MeasuredRubber:
    source = validate(RubberSource, settings, "vary rubber")
    return prepare_rubber(source, titles_first=titles_first)


def _path(kind: str, value: Any, file: CaseFile, names: tuple[str, ...]) -> Path:
    """Return the file `value`, looked for in the working folder and beside the case."""
    here = Path(str(value)).expanduser()
    for path in (here, file.resolve(str(value))):
        if path.is_file():
            return path
    raise FileError(
        f"{kind} {value} is neither a file here or beside the case nor one of {', '.join(names)}"
    )


def names_of(arguments: Sequence[str]) -> list[str]:
    """Return what files and cases are called, cases by their folder, each name once."""
    names: list[str] = []
    for text in arguments:
        path = Path(text)
        name = path.resolve().parent.name if path.name == "case.toml" else path.stem
        count = sum(other == name or other.startswith(f"{name} ") for other in names)
        names.append(f"{name} {count + 1}" if count else name)
    return names
