"""What every table of a case file is, and tables that a `kind` tells apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from gripscale.case.reading import Reading
from gripscale.case.sentence import sentence
from gripscale.checks import shown


class Table(BaseModel):
    """One table of the case file: unknown keys are refused, values are not bent into shape.

    The text below a key is its description, in the list of keys and in the documentation.
    """

    model_config = ConfigDict(
        extra="forbid", strict=True, frozen=True, use_attribute_docstrings=True
    )


@dataclass(frozen=True)
class ByKind(Reading):
    """Reads tables such as { kind = "wlf", c1 = 8.0, c2 = "120 K" }."""

    tables: Mapping[str, type[Table]] = field(hash=False)

    def read(self, value: Any) -> Any:
        """Return the table of the kind that `value` names."""
        kinds = ", ".join(self.tables)
        if isinstance(value, Table):
            return value
        if not isinstance(value, Mapping):
            raise ValueError(f"expected {self.words}")
        if "kind" not in value:
            raise ValueError(f"kind is missing; expected one of {kinds}")
        kind = value["kind"]
        if not isinstance(kind, str) or kind not in self.tables:
            raise ValueError(f"kind = {shown(kind)}: expected one of {kinds}")
        return checked(self.tables[kind], value)


def by_kind(tables: Mapping[str, type[Table]]) -> ByKind:
    """Return what reads one of `tables` by its kind."""
    return ByKind(a_table(tables), tables)


def a_table(tables: Mapping[str, type[Table]]) -> str:
    """Return what is expected where one of `tables` is to be stated."""
    return f"a table with kind (one of {', '.join(tables)}) and its keys"


def checked(table: type[Table], value: Any) -> Table:
    """Return `value` as a `table`; a `ValueError` is one sentence."""
    try:
        return table.model_validate(dict(value))
    except ValidationError as error:
        raise ValueError(sentence(error, table)) from error
