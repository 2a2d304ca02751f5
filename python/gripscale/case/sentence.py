"""What pydantic finds wrong with a table, as one sentence: key, value, expectation."""

from __future__ import annotations

import difflib
from typing import Any, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from gripscale.case.expected import expected

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


def sentence(error: ValidationError, model: type[BaseModel], *, in_table: bool = False) -> str:
    """Return the first complaint as one sentence; an unknown key goes before its consequences.

    `in_table`: the model is a whole file, whose first names are those of tables.
    """
    first = first_complaint(error)
    owner = _model_at(model, first["loc"])
    where = _place(first["loc"], in_table=in_table)
    kind, given = first["type"], first["input"]
    if kind == "extra_forbidden":
        return f"unknown key {where}; {_suggestion(owner, first['loc'])}"
    if kind == "missing":
        return f"{where} is missing; expected {_wanted(owner, first['loc'])}"
    expected = _expected(first)
    if isinstance(given, dict):
        return f"{where}: {expected}" if where else expected
    return f"{where} = {_short(given)}: {expected}"


def first_complaint(error: ValidationError) -> ErrorDetails:
    """Return what is said of a table: an unknown key before the rest."""
    complaints = error.errors(include_url=False)
    unknown = [c for c in complaints if c["type"] == "extra_forbidden"]
    return (unknown or complaints)[0]


def _place(loc: tuple[int | str, ...], *, in_table: bool) -> str:
    """Return `[table] key[index]` or `[table.table] key` for pydantic's location."""
    if in_table and loc and all(isinstance(part, str) for part in loc):
        *tables, key = map(str, loc) if len(loc) > 1 else (*loc, "")
        return f"[{'.'.join(map(str, tables))}] {key}".strip()
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
    """Return what a missing key should have held."""
    field = owner.model_fields[str(loc[-1])]
    return expected(field)


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
