"""The JSON Schema of a case file, by which an editor completes keys and marks what is wrong.

    gripscale keys --schema > case.schema.json

It is made from the tables that read a case, with the meanings that `gripscale keys` lists. The
first line of a case that is written refers to a copy beside it, `#:schema ./.case.schema.json`,
which language servers for TOML follow (Taplo, in VS Code: Even Better TOML).
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel

from gripscale.case_file.keys import NEEDED, NOTHING, table_keys
from gripscale.case_file.schema import LIMITS, PLAIN, Reading, table_of, type_and_marks
from gripscale.case_file.tables import CaseTables
from gripscale.io.folders import write_text

SCHEMA_FILE = ".case.schema.json"
# First line of a case file with its schema beside it.
SCHEMA_LINE = f"#:schema ./{SCHEMA_FILE}\n"

_TYPES = {kind: name for kind, (_, name) in PLAIN.items()} | {list: "array"}
_LIMITS = {limit: name for limit, (_, name) in LIMITS.items()}
_LIMITS |= {"min_length": "minItems", "max_length": "maxItems"}


@cache
def case_schema() -> str:
    """Return the JSON Schema of a case file."""
    about = {"$schema": "http://json-schema.org/draft-07/schema#", "title": "Case of gripscale"}
    return json.dumps(about | _table(CaseTables), indent=1, ensure_ascii=False)


def write_schema(case: str, folder: Path) -> None:
    """Write the schema into the folder of a case whose text refers to it."""
    if case.startswith(SCHEMA_LINE):
        write_text(folder / SCHEMA_FILE, case_schema())


def _table(law: type) -> dict[str, Any]:
    """Return the schema of a table of a case, or of all tables."""
    fields, words = table_of(law).model_fields, {}
    for key in table_keys(law):
        default = "" if key.default in (NEEDED, NOTHING) else f"; by default {key.default}"
        words[key.name] = {"description": f"{key.meaning} Takes {key.takes}{default}."}
    return {
        "type": "object",
        "properties": {
            name: _value(field.annotation, *field.metadata) | words[name]
            for name, field in fields.items()
        },
        "required": [name for name, field in fields.items() if field.is_required()],
        "additionalProperties": False,
    }


def _value(annotation: Any, *metadata: Any) -> dict[str, Any]:
    """Return the schema of a value, which allows whatever the case may say."""
    kind, marks = type_and_marks(annotation, metadata)
    reading = next((mark for mark in marks if isinstance(mark, Reading)), None)
    origin, parts = get_origin(kind), get_args(kind)
    if reading is not None and reading.laws:
        tables = [_table(law) for law in reading.laws.values()]
        words = [{"enum": list(get_args(part))} for part in parts if get_origin(part) is Literal]
        return {"anyOf": [*([{"type": "string"}] if str in parts else []), *words, *tables]}
    if origin is Literal:
        return {"enum": list(parts)}
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return _table(kind)
    limits = {
        words: limit
        for mark in marks
        for name, words in _LIMITS.items()
        if (limit := getattr(mark, name, None)) is not None
    }
    if reading is not None and kind is float:
        return {"type": "string" if reading.quantity == "temperature" else ["string", "number"]}
    if reading is None and origin is list:
        limits["items"] = _value(parts[0])
    name = _TYPES.get(origin or kind)
    return limits | ({"type": name} if name else {})
