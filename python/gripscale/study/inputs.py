"""Surfaces and rubbers of a study: read and fitted once, then varied without reading again."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from gripscale.case.prepare import prepare_surface
from gripscale.case.prepare_rubber import prepare_rubber
from gripscale.case.read import CaseFile, read_case, validate
from gripscale.case.rubber_table import NAMED_RUBBERS, RubberSource
from gripscale.case.surface_table import Surface
from gripscale.errors import FileError
from gripscale.excel import is_excel
from gripscale.rubber import Rubber
from gripscale.study.task import exact
from gripscale.surface import PreparedSurface, SineStack
from gripscale.surface.named import SYNTHETIC_SURFACES, synthetic_surface
from gripscale.textfile import read_bytes

OF_A_FILE = (
    "frequency_unit",
    "modulus_unit",
    "temperature_unit",
    "modulus",
    "columns",
    "reference_temperature",
)
"""Keys of the case's [rubber] that a varied file is read with where it does not state them."""


def case_surface(file: CaseFile) -> PreparedSurface:
    """Return the surface of a case."""
    return prepare_surface(file.case.surface, file.resolve)


def case_rubber(file: CaseFile) -> Rubber:
    """Return the rubber of a case."""
    return prepare_rubber(file.case.rubber, file.resolve).rubber


def surface_of(value: Any, file: CaseFile) -> PreparedSurface:
    """Return the surface an axis names.

    `value` is "case" (the case's own), a synthetic surface known by name, another case (its
    [surface] is taken), a profile or, of a case on a map, a map (read with all other settings of
    the case), a `SineStack` or a `PreparedSurface`.
    """
    if isinstance(value, PreparedSurface):
        return value
    if isinstance(value, SineStack):
        return PreparedSurface(value, "sine waves given by the caller")
    if value == "case":
        return case_surface(file)
    if value in SYNTHETIC_SURFACES:
        return synthetic_surface(value)
    path = _found("surface", value, file, ("case", *SYNTHETIC_SURFACES))
    if path.suffix == ".toml":
        return case_surface(read_case(path))
    own = file.case.surface.model_dump(exclude_none=True, exclude={"files", "map", "sines"})
    if file.case.surface.sines is not None:
        own["scales"] = len(file.case.surface.sines)
    source = {"files": [str(path)]} if file.case.surface.map is None else {"map": str(path)}
    return prepare_surface(validate(Surface, own | source, "vary surface"))


def rubber_of(value: Any, file: CaseFile) -> Rubber:
    """Return the rubber an axis names.

    `value` is "case", a rubber known by name, another case (its [rubber] is taken), a file of
    moduli, or a `Rubber`. A file is read with what the case's [rubber] says of its own file (units,
    kind of modulus, columns, reference temperature) where it does not say so itself; its rubber has
    the bulk modulus, the strain energy and the limit of outliers of the case.
    """
    if isinstance(value, Rubber):
        return value
    if value == "case":
        return case_rubber(file)
    case = file.case.rubber
    own: dict[str, Any] = {"strain_energy": case.strain_energy}
    if case.bulk_modulus is not None:
        own["bulk_modulus"] = case.bulk_modulus
    if value in NAMED_RUBBERS:
        return _rubber({"name": value, **own})
    path = _found("rubber", value, file, ("case", *NAMED_RUBBERS))
    if path.suffix == ".toml":
        return case_rubber(read_case(path))
    taken = _taken(case, path)
    source = f"{path}, read like the rubber of the case where it does not say: {', '.join(taken)}"
    said = {"source": source} if taken else {}
    if case.outlier_threshold is not None:
        own["outlier_threshold"] = case.outlier_threshold
    return _rubber({"file": str(path), **own, **taken, **said}, titles_first=True)


def _taken(case: RubberSource, path: Path) -> dict[str, Any]:
    """Return what the case says of its own file that may hold for the file `path`, too."""
    names = (*OF_A_FILE, "sheet") if is_excel(path) else OF_A_FILE
    stated = {name: getattr(case, name) for name in names}
    kelvin = stated["reference_temperature"]
    if kelvin is not None:
        stated["reference_temperature"] = f"{kelvin!r} K"
    return {name: value for name, value in stated.items() if value is not None}


def stated_by(value: Any, file: CaseFile) -> Any:
    """Return what decides a varied surface or rubber: its name, the bytes behind it, itself."""
    if not isinstance(value, str | Path):
        return exact(value)
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


def _found(name: str, value: Any, file: CaseFile, known: tuple[str, ...]) -> Path:
    """Return the file `value`, looked for here and beside the case."""
    here = Path(str(value)).expanduser()
    for path in (here, file.resolve(str(value))):
        if path.is_file():
            return path
    raise FileError(
        f"{name} {value} is neither a file here or beside the case nor one of {', '.join(known)}"
    )


def _rubber(stated: dict[str, Any], *, titles_first: bool = False) -> Rubber:
    source = validate(RubberSource, stated, "vary rubber")
    return prepare_rubber(source, titles_first=titles_first).rubber
