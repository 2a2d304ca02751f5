"""Surfaces and rubbers of a study: read and fitted once, then varied without reading again."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from gripscale.case_file.prepare import (
    PreparedRubber,
    case_chain,
    case_surface,
    prepare_rubber,
    prepare_surface,
)
from gripscale.case_file.read import CaseFile, read_case, validate
from gripscale.case_file.rubber_tables import NAMED_RUBBERS, RubberSource
from gripscale.case_file.tables import SurfaceTable
from gripscale.chain.chain import Chain
from gripscale.conditions import Conditions
from gripscale.core import checks
from gripscale.core.errors import FileError
from gripscale.core.units import ZERO_CELSIUS
from gripscale.experiment.task import canonical_json
from gripscale.half_space.model import DirectContact
from gripscale.io.text_table import is_excel, read_bytes
from gripscale.model import Model
from gripscale.rubber import Rubber
from gripscale.rubber.sweeps import states_temperature
from gripscale.surface import SineStack, Surface
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, synthetic_surface

SOURCES_OF_SURFACE = {"files", "map", "sines"}
OF_ONE_ROAD = ("crop", "crop_across", "z_axis")
"""Keys of the case's [surface] that belong to its own files."""
OF_A_FILE = (
    "frequency_unit",
    "modulus_unit",
    "temperature_unit",
    "modulus",
    "columns",
    "reference_temperature",
)
"""Keys of the case's [rubber] that a varied file is read with where it does not state them."""


def _of_case(file: CaseFile) -> PreparedRubber:
    return prepare_rubber(file.case.rubber, file.resolve)


def surface_of(value: Any, file: CaseFile) -> Surface:
    """Return the surface an axis names.

    `value` is "case" (the case's own), a synthetic surface known by name, another case (its
    [surface] is taken), a profile or, of a case on a map, a map (read with all other settings of
    the case but the crop, which belongs to its own files), a `SineStack` or a `Surface`.
    """
    if isinstance(value, Surface):
        return value
    if isinstance(value, SineStack):
        return Surface(value, "sine waves given by the caller")
    if value == "case":
        return case_surface(file)
    if value in SYNTHETIC_SURFACES:
        return synthetic_surface(value)
    path = _found("surface", value, file, ("case", *SYNTHETIC_SURFACES))
    if path.suffix == ".toml":
        return case_surface(read_case(path))
    outside = set() if _is_named(path, file) else set(OF_ONE_ROAD)
    table = file.case.surface.model_dump(exclude_none=True, exclude=SOURCES_OF_SURFACE | outside)
    if file.case.surface.sines is not None:
        table["scales"] = len(file.case.surface.sines)
    source = {"files": [str(path)]} if file.case.surface.map is None else {"map": str(path)}
    return prepare_surface(validate(SurfaceTable, table | source, "vary surface"))


def surface_note(value: Any, file: CaseFile) -> str:
    """Return which settings of the case a road from another file was read with; empty for none.

    Raises `FileError` if `value` is no surface that `surface_of` takes.
    """
    if not isinstance(value, str | Path) or value in ("case", *SYNTHETIC_SURFACES):
        return ""
    path = _found("surface", value, file, ("case", *SYNTHETIC_SURFACES))
    if path.suffix == ".toml" or _is_named(path, file):
        return ""
    settings = file.case.surface.model_fields_set - SOURCES_OF_SURFACE
    applied = ", ".join(sorted(settings - set(OF_ONE_ROAD))) or "nothing"
    without = sorted(settings & set(OF_ONE_ROAD))
    words = f"{value}: read with {applied} of the case"
    if not without:
        return words
    return f"{words}, but not {' and '.join(without)}, which belongs to the road of the case"


def _is_named(path: Path, file: CaseFile) -> bool:
    """Return whether a file is one of the surface of a case."""
    return path.resolve() in {file.resolve(name) for name in file.case.surface.measured_files}


def rubber_notes(values: Iterable[Any], file: CaseFile) -> tuple[str, ...]:
    """Return a sentence for each rubber file without a temperature, which takes that of the case.

    Raises `FileError` if a value is no rubber that `rubber_of` takes, or cannot be read.
    """
    return tuple(filter(None, (_rubber_note(value, file) for value in values)))


def _rubber_note(value: Any, file: CaseFile) -> str:
    if not isinstance(value, str | Path) or value in ("case", *NAMED_RUBBERS):
        return ""
    path = _found("rubber", value, file, ("case", *NAMED_RUBBERS))
    kelvin = file.case.rubber.reference_temperature
    if path.suffix == ".toml" or kelvin is None or states_temperature(path):
        return ""
    return (
        f"{value}: the file states no temperature; its moduli are assumed to be those at "
        f"{kelvin - ZERO_CELSIUS:.4g} °C, the reference temperature of the case."
    )


def rubber_of(value: Any, file: CaseFile) -> Rubber:
    """Return the rubber an axis names, as `prepared_rubber_of`."""
    return prepared_rubber_of(value, file).rubber


def prepared_rubber_of(value: Any, file: CaseFile) -> PreparedRubber:
    """Return the rubber an axis names, with what it comes from and what is doubtful of it.

    `value` is "case", a rubber known by name, another case (its [rubber] is taken), a file of
    moduli, or a `Rubber`. A file is read with what the case's [rubber] says of its own file (units,
    kind of modulus, columns, reference temperature) where it does not say so itself; its rubber has
    the bulk modulus, the strain energy and the limit of outliers of the case.
    """
    if isinstance(value, Rubber):
        return PreparedRubber(value, value.source)
    if value == "case":
        return _of_case(file)
    case = file.case.rubber
    settings: dict[str, Any] = {"strain_energy": case.strain_energy}
    if case.bulk_modulus is not None:
        settings["bulk_modulus"] = case.bulk_modulus
    if value in NAMED_RUBBERS:
        return _rubber({"name": value, **settings})
    path = _found("rubber", value, file, ("case", *NAMED_RUBBERS))
    if path.suffix == ".toml":
        return _of_case(read_case(path))
    names = (*OF_A_FILE, "sheet") if is_excel(path) else OF_A_FILE
    taken = {name: getattr(case, name) for name in names if getattr(case, name) is not None}
    if "reference_temperature" in taken:
        taken["reference_temperature"] = f"{taken['reference_temperature']!r} K"
    source = f"{path}, read with these settings of the rubber of the case: {', '.join(taken)}"
    said = {"source": source} if taken else {}
    if case.outlier_threshold is not None:
        settings["outlier_threshold"] = case.outlier_threshold
    return _rubber({"file": str(path), **settings, **taken, **said}, titles_first=True)


def stated_by(value: Any, file: CaseFile) -> Any:
    """Return what decides a varied surface or rubber: its name, the bytes behind it, itself."""
    if not isinstance(value, str | Path):
        return canonical_json(value)
    if value in ("case", *SYNTHETIC_SURFACES, *NAMED_RUBBERS):
        return str(value)
    path = _found("input", value, file, ())
    return contents(read_case(path)) if path.suffix == ".toml" else [str(path), digest(path)]


def contents(file: CaseFile) -> list[str]:
    """Return the text of a case and the digests of the files it names.

    Raises `FileError` if one cannot be read.
    """
    named = file.case.named_files()
    return [str(file.path), file.text, *(digest(file.resolve(name)) for _, name in named)]


def digest(path: Path) -> str:
    """Return the SHA-256 of a file; raise `FileError` if it cannot be read."""
    return hashlib.sha256(read_bytes(path)).hexdigest()


def _found(name: str, value: Any, file: CaseFile, names: tuple[str, ...]) -> Path:
    """Return the file `value`, looked for here and beside the case."""
    here = Path(str(value)).expanduser()
    for path in (here, file.resolve(str(value))):
        if path.is_file():
            return path
    raise FileError(
        f"{name} {value} is neither a file here or beside the case nor one of {', '.join(names)}"
    )


def _rubber(settings: dict[str, Any], *, titles_first: bool = False) -> PreparedRubber:
    source = validate(RubberSource, settings, "vary rubber")
    return prepare_rubber(source, titles_first=titles_first)


EFFECTS = ("temperature", "softening", "heat")
"""What conditions do to the rubber; the area term does nothing to it."""

ALL, NONE = "all", "none"


def conditions_of(model: Model) -> Conditions:
    """Return the conditions of a model, empty ones if it has none.

    Raises `InputError` if the model takes none.
    """
    return model.with_conditions(model.conditions).conditions or Conditions()


def at_temperature(model: Model, kelvin: float) -> Model:
    """Return `model` with another temperature before the contact [K]."""
    return model.with_conditions(replace(conditions_of(model), temperature=kelvin))


def effects_asked(model: Model) -> list[str]:
    """Return which of `EFFECTS` the conditions of a model have."""
    conditions = conditions_of(model)
    return [effect for effect in EFFECTS if getattr(conditions, effect) is not None]


def with_effects(model: Model, selection: str) -> Model:
    """Return `model` with all of its effects, without one or with none; its area term stays.

    Raises `InputError` if `selection` is neither "all", "no" one that the model has, nor "none".
    """
    asked = effects_asked(model)
    without = {ALL: [], **{f"no {effect}": [effect] for effect in asked}, NONE: asked}
    nothing: dict[str, Any] = dict.fromkeys(without[checks.one_of("effects", selection, without)])
    return model.with_conditions(replace(conditions_of(model), **nothing))


def rubber_before(rubber: Rubber, model: Model) -> Rubber:
    """Return `rubber` at the temperature it has before the contact of `model`.

    Raises `InputError` if it has no shift, or none to this temperature.
    """
    return rubber if model.conditions is None else model.conditions.before(rubber)


NAMED_MODELS = (Chain.name, DirectContact.name)
OF_THE_CHAIN = ("factors", "waves", "pressure_classes")
"""Inputs that no other model of a case depends on."""


def default_model(file: CaseFile, varied: Mapping[str, Sequence[Any]] | None = None) -> str:
    """Return the name of what predicts a case by default, whose inputs take the `varied` values.

    The direct contact where every surface was measured and no input of the chain alone is varied,
    else the chain. Raises `FileError` if a surface is none that `surface_of` takes.
    """
    values = varied or {}
    measured = all(is_measured(surface, file) for surface in values.get("surface", ("case",)))
    return DirectContact.name if measured and not {*OF_THE_CHAIN} & {*values} else Chain.name


def model_of(
    model: Model | str, file: CaseFile, tolerance: float | None = DirectContact().tolerance
) -> Model:
    """Return a model, or the one of this name with the conditions of the case.

    `tolerance` is the estimated relative error of a direct contact chosen by name; None for its
    first full grid. Raises `InputError` if the name is another, or the tolerance out of range.
    """
    if not isinstance(model, str):
        return model
    chain = case_chain(file)
    if checks.one_of("model", model, NAMED_MODELS) == Chain.name:
        return chain
    return DirectContact(tolerance=tolerance, conditions=chain.conditions)


def is_measured(value: Any, file: CaseFile) -> bool:
    """Return whether a surface, as `surface_of` takes it, was measured; no file is read.

    Raises `FileError` if a case cannot be read.
    """
    if isinstance(value, Surface):
        return value.measured is not None
    if isinstance(value, SineStack) or value in SYNTHETIC_SURFACES:
        return False
    if value != "case":
        path = _found("surface", value, file, ("case", *SYNTHETIC_SURFACES))
        if path.suffix != ".toml":
            return True
        file = read_case(path)
    return file.case.surface.sines is None
