"""What every table of a case file is, and tables that a `kind` tells apart."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationError

from gripscale.case.sentence import sentence
from gripscale.checks import shown


class Table(BaseModel):
    """One table of the case file: unknown keys are refused, values are not bent into shape."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


def by_kind(tables: Mapping[str, type[Table]], key: str = "kind") -> BeforeValidator:
    """Return a validator of tables such as { kind = "wlf", c1 = 8.0, c2 = "120 K" }."""
    kinds = ", ".join(tables)

    def read(value: Any) -> Any:
        if isinstance(value, Table):
            return value
        if not isinstance(value, Mapping):
            raise ValueError(f"expected a table with {key} (one of {kinds}) and its keys")
        if key not in value:
            raise ValueError(f"{key} is missing; expected one of {kinds}")
        kind = value[key]
        if not isinstance(kind, str) or kind not in tables:
            raise ValueError(f"{key} = {shown(kind)}: expected one of {kinds}")
        return checked(tables[kind], value)

    return BeforeValidator(read)


def checked(table: type[Table], value: Any) -> Table:
    """Return `value` as a `table`; a `ValueError` is one sentence."""
    try:
        return table.model_validate(dict(value))
    except ValidationError as error:
        raise ValueError(sentence(error, table)) from error
