"""Every key of a case file: what it takes, its default, its meaning, where it is explained.

Made from the tables that read the file: what they do not know is not listed, what they know is.
"""

from __future__ import annotations

import ast
import inspect
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from gripscale.case_file import tables
from gripscale.case_file.rubber_tables import SHIFT_LAWS, SOFTENING, ConditionsTable, RubberSource
from gripscale.case_file.schema import CaseTable, KeyQuantity, expected, quantity_of, table_of
from gripscale.conditions.area_term import SHEAR_STRESSES, FittedPoints
from gripscale.conditions.flash_temperature import ThermalProperties
from gripscale.rubber.strain_energy import STRAIN_ENERGIES, StrainEnergy

# The default of a key that must be there, and of one that may be left out for nothing.
NEEDED, NOTHING = "needed", "-"

# Tables of a case by name, those of one kind or another by their kinds, and their chapters.
TABLES: tuple[tuple[str, type | Mapping[str, type], str], ...] = (
    ("surface", tables.SurfaceTable, "inputs.md"),
    ("surface.sines", tables.WaveTable, "method.md"),
    ("rubber", RubberSource, "temperature.md"),
    ("rubber.shift", SHIFT_LAWS, "temperature.md"),
    ("rubber.strain_energy", STRAIN_ENERGIES, "material.md"),
    ("load", tables.LoadTable, "method.md"),
    ("solver", tables.SolverTable, "method.md"),
    ("chain", tables.ChainOptions, "chain-and-direct-contact.md"),
    ("conditions", ConditionsTable, "conditions.md"),
    ("conditions.softening", SOFTENING, "conditions.md"),
    ("conditions.heat", ThermalProperties, "conditions.md"),
    ("conditions.counterface", ThermalProperties, "conditions.md"),
    ("conditions.shear_stress", SHEAR_STRESSES, "conditions.md"),
    ("conditions.shear_stress.fitted_to", FittedPoints, "measured-friction.md"),
    ("below_measurement", tables.BelowMeasurementTable, "below-measurement.md"),
    ("below_measurement.finer", tables.FinerTable, "below-measurement.md"),
    ("measured", tables.MeasuredTable, "direct-contact.md"),
    ("output", tables.OutputTable, "reading-results.md"),
    ("compare", tables.CompareTable, "theories.md"),
    ("uncertainty", tables.UncertaintyTable, "uncertainty.md"),
    ("uncertainty.ranges", tables.RangesTable, "uncertainty.md"),
)

_OF_THE_METHOD = ("scales", "smallest_wavelength", "s_wavelength", "s_amplitude", "single_factor")
# Chapters of keys that are explained elsewhere than their tables.
CHAPTERS = {
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
    quantity: KeyQuantity | None = None
    """The quantity with a unit that it takes; None for anything else."""


@dataclass(frozen=True)
class KeySection:
    """One table of a case; `kind` tells tables of the same name apart."""

    name: str
    kind: str
    law: type
    about: str
    keys: list[Key]

    @property
    def title(self) -> str:
        """How the table begins in a file."""
        return f"[{self.name}]" + (f' kind = "{self.kind}"' if self.kind else "")


@cache
def sections() -> list[KeySection]:
    """Return all tables of a case with their keys, in the order of the documentation."""
    return [
        KeySection(name, kind, law, _about(law), list(table_keys(law, page)))
        for name, table, page in TABLES
        for kind, law in (table.items() if isinstance(table, Mapping) else [("", table)])
    ]


def table_keys(law: type, page: str = "") -> Iterator[Key]:
    """Yield the keys of a table or a law, its own before those it shares with others."""
    table = table_of(law)
    meanings = {"kind": _about(law)}
    for source in [base for base in law.__mro__[:0:-1] if issubclass(base, CaseTable)] + [law]:
        body = ast.parse(inspect.getsource(source)).body[0]
        assert isinstance(body, ast.ClassDef)
        for field, below in pairwise(body.body):
            match field, below:
                case (
                    ast.AnnAssign(target=ast.Name(id=name)),
                    ast.Expr(value=ast.Constant(value=text)),
                ):  # without units: a case states them as it likes
                    meanings[name] = re.sub(r" \[[^\]]*\]", "", " ".join(str(text).split()))
    for name in sorted(table.model_fields, key=lambda name: name not in table.__annotations__):
        item = table.model_fields[name]
        match item.default:
            case _ if item.is_required():
                default = NEEDED
            case None | CaseTable():
                default = NOTHING
            case StrainEnergy(kind=kind):
                default = f'{{ kind = "{kind}" }}'
            case float(value):
                default = f"{value:g}"
            case value:
                default = json.dumps(value)
        meaning, chapter = meanings.get(name, ""), CHAPTERS.get(name, page)
        takes = expected(item.annotation, item.metadata)
        yield Key(name, takes, default, meaning, chapter, quantity_of(item))


def _about(law: type) -> str:
    return (law.__doc__ or "").partition("\n")[0]
