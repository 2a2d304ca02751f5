"""Reading a value of the case file as a person writes it, before pydantic looks at its type."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler
from pydantic_core import core_schema

from gripscale.case.expected import Words


@dataclass(frozen=True)
class Reading(Words, ABC):
    """Beside a type: reads its value, and says in words what is expected."""

    @abstractmethod
    def read(self, value: Any) -> Any:
        """Return what the type asks for; raise `ValueError` with one sentence."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Read the value before pydantic looks at it."""
        return core_schema.no_info_before_validator_function(self.read, handler(source))
