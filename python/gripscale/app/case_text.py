"""The text of a case edited key by key: comments and everything else in it stay as they are."""

from __future__ import annotations

import tomllib
from collections.abc import MutableMapping, Sequence
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from gripscale.errors import FileError


def stated(text: str, path: Sequence[str]) -> Any:
    """Return what `text` states at a path such as ("load", "speed"), or None."""
    value: Any = tables(text)
    for name in path:
        value = value.get(name) if isinstance(value, dict) else None
    return value


def tables(text: str) -> dict[str, Any]:
    """Return all that `text` states; nothing of a text that is not TOML."""
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError):
        return {}


def with_value(text: str, path: Sequence[str], value: Any) -> str:
    """Return `text` with `value` at a path, or without the key if it is None.

    Raises `FileError` if `text` is not TOML.
    """
    try:
        document = tomlkit.parse(text)
        *parents, key = path
        table: MutableMapping[str, Any] = document
        for name in parents:
            if value is None and name not in table:
                return text
            if not isinstance(table.get(name), MutableMapping):
                table[name] = tomlkit.table()
            table = table[name]
        if value is None:
            table.pop(key, None)
        else:
            table[key] = value
        return tomlkit.dumps(document)
    except (TOMLKitError, RecursionError) as error:
        raise FileError(f"the text of the case is not valid TOML: {error}") from error


def value_of(words: str) -> Any:
    """Return what is written into a field: a value of TOML, else the words as a text.

    `0.3` is a number, `["1 mm", "2 mm"]` a list, `3 bar` a text; nothing is None.
    """
    plain = words.strip()
    if not plain:
        return None
    try:
        return tomllib.loads(f"value = {plain}")["value"] if "\n" not in plain else plain
    except (ValueError, RecursionError):
        return plain


def words_of(value: Any) -> str:
    """Return how a field shows a value: texts without quotes, all else as TOML writes it."""
    if value is None:
        return ""
    if not isinstance(value, str):
        return _inline(value)
    return value if value_of(value) == value else _inline(value)


def _inline(value: Any) -> str:
    """Return `value` as TOML on one line."""
    if isinstance(value, dict):
        pairs = ", ".join(f"{tomlkit.key(k).as_string()} = {_inline(v)}" for k, v in value.items())
        return f"{{ {pairs} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    return str(tomlkit.item(value).as_string())
