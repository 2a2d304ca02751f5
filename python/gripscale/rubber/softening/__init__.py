"""Strain softening of filled rubber (the Payne effect): how E' and E'' fall with the strain."""

from collections.abc import Mapping
from typing import Any

from gripscale import checks
from gripscale.rubber.softening.kraus import Kraus
from gripscale.rubber.softening.law import SofteningFactors, SofteningLaw
from gripscale.rubber.softening.of_sweeps import softening_of_sweeps
from gripscale.rubber.softening.series import SoftenedSeries, softened
from gripscale.rubber.softening.table import SofteningTable

__all__ = [
    "SOFTENING_LAWS",
    "Kraus",
    "SoftenedSeries",
    "SofteningFactors",
    "SofteningLaw",
    "SofteningTable",
    "softened",
    "softening_from_dict",
    "softening_of_sweeps",
]

SOFTENING_LAWS: dict[str, Any] = {law.kind: law for law in (Kraus, SofteningTable)}
"""Every law by its kind."""


def softening_from_dict(values: Mapping[str, Any]) -> SofteningLaw:
    """Return the law of `to_dict`.

    Raises `InputError` if the kind is unknown or a value cannot be used.
    """
    given = dict(values)
    kind = checks.one_of("kind", given.pop("kind", None), SOFTENING_LAWS)
    law: SofteningLaw = checks.made(SOFTENING_LAWS[kind], kind, given)
    return law
