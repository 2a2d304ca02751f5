"""Every key of a case file: what it takes, its default, its meaning, where it is explained.

Made from the tables that read the file: what they do not know is not listed, what they know is.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any

from pydantic.fields import FieldInfo

from gripscale.case.rubber_tables import (
    LAWS,
    SHEAR_STRESS,
    SOFTENING,
    ConditionsTable,
    Heat,
    RubberSource,
)
from gripscale.case.schema import Table, expected
from gripscale.case.tables import (
    ChainOptions,
    Compare,
    Given,
    Load,
    MeasuredTable,
    Output,
    Solver,
    Surface,
    UncertaintyTable,
    Wave,
)
from gripscale.rubber.strain_energy import STRAIN_ENERGIES, StrainEnergy

Laws = Mapping[str, type[Table]] | Mapping[str, type[StrainEnergy]]

NEEDED, NOTHING = "needed", "-"
"""The default of a key that must be there, and of one that may be left out for nothing."""

TABLES: tuple[tuple[str, type[Table] | Laws, str], ...] = (
    ("surface", Surface, "inputs.md"),
    ("surface.sines", Wave, "method.md"),
    ("rubber", RubberSource, "temperature.md"),
    ("rubber.shift", LAWS, "temperature.md"),
    ("rubber.strain_energy", STRAIN_ENERGIES, "material.md"),
    ("load", Load, "method.md"),
    ("solver", Solver, "method.md"),
    ("chain", ChainOptions, "chain-and-direct-contact.md"),
    ("conditions", ConditionsTable, "conditions.md"),
    ("conditions.softening", SOFTENING, "conditions.md"),
    ("conditions.heat", Heat, "conditions.md"),
    ("conditions.shear_stress", SHEAR_STRESS, "conditions.md"),
    ("measured", MeasuredTable, "direct-contact.md"),
    ("output", Output, "reading-results.md"),
    ("compare", Compare, "theories.md"),
    ("uncertainty", UncertaintyTable, "uncertainty.md"),
    ("uncertainty.given", Given, "uncertainty.md"),
)
"""Tables of a case by name, those of one kind or another by their kinds, and their chapters."""

CHAPTERS = {
    "upper_share": "chain-and-direct-contact.md",
    "cut_off": "chain-and-direct-contact.md",
    "scales": "method.md",
    "smallest_wavelength": "method.md",
    "s_wavelength": "method.md",
    "s_amplitude": "method.md",
    "single_factor": "method.md",
    "strain_energy": "material.md",
    "terms": "material.md",
    "extrapolate": "inputs.md",
    "time_limit": "inputs.md",
}
"""Chapters of keys that are explained elsewhere than their tables."""

PARAMETERS = {
    "share": "Share of the second invariant in the shear modulus, 0 to 1.",
    "second": "Coefficient of (I1 - 3)^2 over G/2.",
    "third": "Coefficient of (I1 - 3)^3 over G/2.",
}
"""Meaning of the parameters of strain energies."""


@dataclass(frozen=True)
class Key:
    """One key: its name, what it takes, its default, its meaning, the page that explains it."""

    name: str
    takes: str
    default: str
    meaning: str
    chapter: str


@dataclass(frozen=True)
class Section:
    """One table of a case; `kind` tells tables of the same name apart."""

    name: str
    kind: str
    about: str
    keys: list[Key]

    @property
    def title(self) -> str:
        """How the table begins in a file."""
        return f"[{self.name}]" + (f' kind = "{self.kind}"' if self.kind else "")


def sections() -> list[Section]:
    """Return all tables of a case with their keys, in the order of the documentation."""
    return [section for name, table, page in TABLES for section in _sections(name, table, page)]


def _sections(name: str, table: type[Table] | Laws, page: str) -> Iterator[Section]:
    laws = table.items() if isinstance(table, Mapping) else [("", table)]
    for kind, law in laws:
        yield Section(name, kind, _about(law), list(_keys(kind, law, page)))


def _keys(kind: str, law: type[Table] | type[StrainEnergy], page: str) -> Iterator[Key]:
    if issubclass(law, Table):
        for name, field in law.model_fields.items():
            meaning = field.description or ""
            yield Key(name, expected(field), _default(field), meaning, CHAPTERS.get(name, page))
        return
    yield Key("kind", json.dumps(kind), NEEDED, _about(law), page)
    for parameter in fields(law):
        yield Key(parameter.name, "a number", NEEDED, PARAMETERS.get(parameter.name, ""), page)


def _about(law: type) -> str:
    return (law.__doc__ or "").partition("\n")[0]


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return NEEDED
    return _written(field.default)


def _written(value: Any) -> str:
    """Return `value` as a case file writes it."""
    if value is None:
        return NOTHING
    if isinstance(value, StrainEnergy):
        return f'{{ kind = "{value.kind}" }}'
    return f"{value:g}" if isinstance(value, float) else json.dumps(value)
