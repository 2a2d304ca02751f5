"""Strain energies of the permanent network; the temporary networks stay neo-Hookean."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.strain_energy.base import StrainEnergy
from gripscale.rubber.strain_energy.isihara import Isihara
from gripscale.rubber.strain_energy.mooney_rivlin import MooneyRivlin
from gripscale.rubber.strain_energy.neo_hookean import NeoHookean
from gripscale.rubber.strain_energy.yeoh import Yeoh

__all__ = [
    "STRAIN_ENERGIES",
    "Isihara",
    "MooneyRivlin",
    "NeoHookean",
    "StrainEnergy",
    "Yeoh",
    "strain_energy",
    "strain_energy_from_dict",
]

STRAIN_ENERGIES: dict[str, type[StrainEnergy]] = {
    law.kind: law for law in (NeoHookean, MooneyRivlin, Yeoh, Isihara)
}
"""Every strain energy by its kind."""


def strain_energy(kind: str, **parameters: float) -> StrainEnergy:
    """Return the strain energy of a `kind`, such as `strain_energy("yeoh", second=..., third=...)`.

    Raises `InputError` if the kind is unknown, or has other parameters.
    """
    law = STRAIN_ENERGIES[checks.one_of("kind", kind, STRAIN_ENERGIES)]
    wanted = [field.name for field in fields(law)]
    if set(parameters) != set(wanted):
        takes = f"the parameters {', '.join(wanted)}" if wanted else "no parameters"
        raise InputError(f"{kind} takes {takes}; got {', '.join(parameters) or 'none'}")
    return law(**parameters)


def strain_energy_from_dict(values: Mapping[str, Any]) -> StrainEnergy:
    """Return the strain energy of {"kind": "yeoh", "second": ..., "third": ...}.

    Raises `InputError` as `strain_energy` does, or if `values` is no such mapping.
    """
    if not isinstance(values, Mapping):
        raise InputError(
            f"strain_energy must be a mapping with its kind; got {checks.shown(values)}"
        )
    return strain_energy(**{"kind": None, **values})
