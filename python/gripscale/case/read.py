"""Reading a case file; what is wrong becomes one sentence: file, key, value, expectation."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from gripscale.case.models import Case
from gripscale.errors import FileError, InputError

M = TypeVar("M", bound=BaseModel)

_EXPECTED = {
    "bool_type": "true or false",
    "finite_number": "a finite number",
    "float_type": "a number",
    "greater_than": "greater than {gt:g}",
    "greater_than_equal": "at least {ge:g}",
    "int_parsing_size": "a whole number of fewer digits",
    "int_type": "a whole number",
    "less_than": "less than {lt:g}",
    "less_than_equal": "at most {le:g}",
    "list_type": "a list",
    "literal_error": "{expected}",
    "model_type": "a table",
    "multiple_of": "a multiple of {multiple_of:g}",
    "string_type": "a string",
    "too_long": "at most {max_length} items",
    "too_short": "at least {min_length} items",
}
"""What was expected instead of a value that pydantic refused with an error of this type."""


@dataclass(frozen=True)
class CaseFile:
    """A case with the file it came from: `text` is kept word for word for the results folder."""

    case: Case
    path: Path
    text: str

    def resolve(self, name: str) -> Path:
        """Return the path of a file named in the case, relative to the case file."""
        return (self.path.parent / Path(name).expanduser()).resolve()


def read_case(path: str | Path) -> CaseFile:
    """Read and validate the case file at `path`.

    Raises `FileError` if it cannot be read or is not TOML, `InputError` if it says something
    unusable.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise FileError(f"case file {path} does not exist") from error
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"case file {path} cannot be read: {_reason(error)}") from error
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise FileError(f"case file {path} is not valid TOML: {error}") from error
    except (ValueError, RecursionError) as error:  # numbers of 4300 digits, a thousand brackets
        raise FileError(f"case file {path} is beyond reading: {error}") from error
    return CaseFile(validate(Case, tables, str(path)), path, text)


def validate(model: type[M], values: Mapping[str, Any], where: str) -> M:
    """Return `values` as a `model`; an `InputError` begins with `where` and says why not."""
    try:
        return model.model_validate(dict(values))
    except ValidationError as error:
        raise InputError(f"{where}: {_sentence(error, model)}") from error


def _reason(error: OSError | UnicodeDecodeError) -> str:
    if isinstance(error, UnicodeDecodeError):
        return "it is not UTF-8 text"
    return error.strerror or str(error)


def _sentence(error: ValidationError, model: type[BaseModel]) -> str:
    """Return the first complaint as one sentence; an unknown key goes before its consequences."""
    complaints = error.errors(include_url=False)
    unknown = [c for c in complaints if c["type"] == "extra_forbidden"]
    first = (unknown or complaints)[0]
    owner = _model_at(model, first["loc"])
    where = _place(first["loc"], in_table=model is Case)
    kind, given = first["type"], first["input"]
    if kind == "extra_forbidden":
        return f"unknown key {where}; {_suggestion(owner, first['loc'])}"
    if kind == "missing":
        return f"{where} is missing; expected {_wanted(owner, first['loc'])}"
    expected = _expected(first)
    if isinstance(given, dict):
        return f"{where}: {expected}" if where else expected
    return f"{where} = {_short(given)}: {expected}"


def _place(loc: tuple[int | str, ...], *, in_table: bool) -> str:
    """Return `[table] key[index]` for pydantic's location."""
    words = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in loc)
    words = words.removeprefix(".")
    if not (in_table and words):
        return words
    table, _, key = words.partition(".")
    return f"[{table}] {key}".strip()


def _model_at(model: type[BaseModel], loc: tuple[int | str, ...]) -> type[BaseModel]:
    """Return the model inside `model` that owns the last part of `loc`."""
    for part in loc[:-1]:
        if isinstance(part, str):
            model = _model_in(model.model_fields[part].annotation) or model
    return model


def _wanted(owner: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """Return what a missing key should have held: a table with its keys, or its description."""
    field = owner.model_fields[str(loc[-1])]
    inner = _model_in(field.annotation)
    if inner is not None:
        return f"a table with {', '.join(inner.model_fields)}"
    return field.description or "a value"


def _suggestion(owner: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """Return the nearest valid name to the last part of `loc`, or all of them."""
    names = list(owner.model_fields)
    near = difflib.get_close_matches(str(loc[-1]), names, n=1)
    return f"did you mean {near[0]}?" if near else f"expected one of {', '.join(names)}"


def _model_in(annotation: Any) -> type[BaseModel] | None:
    """Return the model inside `annotation`, such as Wave in `list[Wave] | None`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((m for part in get_args(annotation) if (m := _model_in(part))), None)


def _expected(complaint: Any) -> str:
    """Return what was expected instead, in the words of this package."""
    context = complaint.get("ctx", {})
    if complaint["type"] == "value_error":
        return str(context["error"])
    words = _EXPECTED[complaint["type"]].format(**context)
    return f"expected {words.removesuffix('s') if words.endswith(' 1 items') else words}"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
