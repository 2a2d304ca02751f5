"""What a key of the case file takes, in words: for complaints and for the list of keys."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

_PLAIN = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
_LIMITS = {
    "ge": "at least {:g}",
    "gt": "above {:g}",
    "le": "at most {:g}",
    "lt": "below {:g}",
    "multiple_of": "a multiple of {:g}",
}
"""What pydantic calls a limit, and what it is called here."""


@dataclass(frozen=True)
class Words:
    """Beside a type whose values Python's names do not tell: what is expected, in words."""

    words: str


def expected(field: FieldInfo) -> str:
    """Return what the value of `field` must be, such as "a whole number, at least 1"."""
    return _of_type(field.annotation, field.metadata)


def _of_type(annotation: Any, metadata: Iterable[Any] = ()) -> str:
    stated = list(metadata)
    for one in stated:
        if isinstance(one, Words):
            return one.words
    if get_origin(annotation) is Annotated:
        inner, *more = get_args(annotation)
        return _of_type(inner, [*more, *_unpacked(more), *stated])
    return ", ".join([_of_plain(annotation, stated), *_limits(stated)])


def _unpacked(metadata: Iterable[Any]) -> list[Any]:
    """Return what pydantic's `Field` inside an annotation states."""
    return [part for one in metadata if isinstance(one, FieldInfo) for part in one.metadata]


def _of_plain(annotation: Any, metadata: list[Any]) -> str:
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        return " or ".join(json.dumps(part) for part in parts)
    if origin is list:
        least = max((getattr(one, "min_length", 1) for one in metadata), default=1)
        count = f" of {least}" if least > 1 else ""
        return f"a list{count}, each {_of_type(parts[0])}"
    if parts:
        return " or ".join(_of_type(part) for part in parts if part is not type(None))
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return f"a table with {', '.join(annotation.model_fields)}"
    return _PLAIN.get(annotation, "a value")


def _limits(metadata: list[Any]) -> list[str]:
    found = (
        (words, getattr(one, name, None)) for one in metadata for name, words in _LIMITS.items()
    )
    return [words.format(value) for words, value in found if value is not None]
