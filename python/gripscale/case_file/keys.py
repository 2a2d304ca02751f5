"""Every key of a case file: what it takes, its default, its meaning, where it is explained.

Made from the JSON Schema of the tables that read the file. `case_schema` is that schema for an
editor, to which the first line of a case that is written refers, `#:schema ./.case.schema.json`:
language servers for TOML follow it (Taplo, in VS Code: Even Better TOML).
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from gripscale.case_file.schema import expected, table_schema, toml_text
from gripscale.case_file.tables import CaseTables
from gripscale.io.folders import write_text

SCHEMA_FILE = ".case.schema.json"
# First line of a case file with its schema beside it.
SCHEMA_LINE = f"#:schema ./{SCHEMA_FILE}\n"
# The default of a key that must be there, and of one that may be left out for nothing.
NEEDED, NOTHING = "needed", "-"
# Chapters of tables, with those inside them where these have none of their own.
_CHAPTERS = {
    "surface": "inputs.md",
    "surface.sines": "method.md",
    "rubber": "temperature.md",
    "rubber.strain_energy": "material.md",
    "load": "method.md",
    "solver": "method.md",
    "chain": "chain-and-direct-contact.md",
    "conditions": "conditions.md",
    "conditions.shear_stress.fitted_to": "measured-friction.md",
    "below_measurement": "below-measurement.md",
    "measured": "direct-contact.md",
    "output": "reading-results.md",
    "compare": "theories.md",
    "uncertainty": "uncertainty.md",
}
_OF_THE_METHOD = ("scales", "smallest_wavelength", "s_wavelength", "s_amplitude", "single_factor")
# Chapters of keys that are explained elsewhere than their tables.
_CHAPTERS_OF_KEYS = {
    **dict.fromkeys(("top_height_fraction", "cut_off"), "chain-and-direct-contact.md"),
    **dict.fromkeys(_OF_THE_METHOD, "method.md"),
    **dict.fromkeys(("strain_energy", "terms"), "material.md"),
    **dict.fromkeys(("extrapolate", "time_limit"), "inputs.md"),
}


@dataclass(frozen=True)
class Key:
    """One key: its name, what it takes, its default, its meaning, the page that explains it."""

    name: str
    takes: str
    default: str
    meaning: str
    chapter: str
    schema: Mapping[str, Any] = field(repr=False)
    """JSON Schema of what it takes."""


@dataclass(frozen=True)
class KeySection:
    """One table of a case; `kind` tells tables of the same name apart."""

    name: str
    kind: str
    about: str
    keys: list[Key]

    @property
    def title(self) -> str:
        """How the table begins in a file."""
        return f"[{self.name}]" + (f' kind = "{self.kind}"' if self.kind else "")


@cache
def sections() -> list[KeySection]:
    """Return all tables of a case with their keys, in the order of the documentation."""
    tables = table_schema(CaseTables)["properties"]
    return [section for name, table in tables.items() for section in _sections(name, table)]


def _sections(name: str, schema: Mapping[str, Any]) -> Iterator[KeySection]:
    """Yield the tables that a key takes, then those inside them."""
    value = schema.get("items", schema)
    tables = [table for table in value.get("anyOf", [value]) if "properties" in table]
    for table in tables:
        kind = table["properties"].get("kind", {}).get("const", "")
        yield KeySection(name, kind, table["about"], list(_keys(name, table)))
    for key, inner in {k: v for table in tables for k, v in table["properties"].items()}.items():
        yield from _sections(f"{name}.{key}", inner)


def _keys(table: str, schema: Mapping[str, Any]) -> Iterator[Key]:
    chapter = table
    while chapter not in _CHAPTERS:
        chapter = chapter.rpartition(".")[0]
    for name, key in schema["properties"].items():
        default = NEEDED if name in schema.get("required", ()) else NOTHING
        if key.get("default") is not None and "properties" not in key:
            value = key["default"]
            default = f"{value:g}" if isinstance(value, float) else toml_text(value)
        # without units: a case states them as it likes
        meaning = re.sub(r" \[[^\]]*\]", "", " ".join(key.get("description", "").split()))
        page = _CHAPTERS_OF_KEYS.get(name, _CHAPTERS[chapter])
        yield Key(name, expected(key), default, meaning, page, key)


@cache
def case_schema() -> str:
    """Return the JSON Schema of a case file."""
    about = {"$schema": "http://json-schema.org/draft-07/schema#", "title": "Case of gripscale"}
    return json.dumps(about | _for_editors(table_schema(CaseTables)), indent=1, ensure_ascii=False)


def _for_editors(schema: Any) -> Any:
    """Return a JSON Schema with the keywords of editors alone, and with all words of `sections`."""
    if not isinstance(schema, dict):
        return [_for_editors(part) for part in schema] if isinstance(schema, list) else schema
    parts = {key: _for_editors(part) for key, part in schema.items() if key not in _OURS}
    for key in _keys("surface", schema) if "properties" in schema else ():
        default = "" if key.default in (NEEDED, NOTHING) else f"; by default {key.default}"
        words = f"{key.meaning} Takes {key.takes}{default}."
        parts["properties"][key.name]["description"] = words
    return parts


_OURS = ("expected", "quantity", "about", "gone", "default")


def write_schema(case: str, folder: Path) -> None:
    """Write the schema into the folder of a case whose text refers to it."""
    if case.startswith(SCHEMA_LINE):
        write_text(folder / SCHEMA_FILE, case_schema())
