"""The case file: one TOML file that says what a run reads, solves and writes."""

from gripscale.case.models import Case, Load, Output, RubberSource, Solver, Surface
from gripscale.case.read import CaseFile, read_case, validate
from gripscale.units import parse_quantity

__all__ = [
    "Case",
    "CaseFile",
    "Load",
    "Output",
    "RubberSource",
    "Solver",
    "Surface",
    "parse_quantity",
    "read_case",
    "validate",
]
