"""What the numbers of a rubber must be."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.admissible import AdmissibleSeries
from gripscale.rubber.strain_energy import StrainEnergy

Array = NDArray[np.float64]


def read_only(values: Array) -> Array:
    """Return `values`, which nobody can change any more."""
    values.setflags(write=False)
    return values


def finite(name: str, value: ArrayLike, unit: str) -> Array:
    """Return `value` as an array of floats; raise `InputError` unless finite and in reason."""
    return checks.real(name, value, unit=unit)


def modulus(name: str, value: float) -> float:
    """Return one modulus [Pa] within reason."""
    return float(checks.in_reason(name, [checks.number(name, value, unit="Pa")], unit="Pa")[0])


def admissible(value: AdmissibleSeries | None) -> AdmissibleSeries | None:
    """Return `value`; raise `InputError` if it is something else."""
    if not isinstance(value, AdmissibleSeries | None):
        raise InputError(
            f"admissible must be an AdmissibleSeries or None; got {checks.shown(value)}"
        )
    return value


def temperature(value: float | None) -> float | None:
    """Return a reference temperature [K]; raise `InputError` unless above zero or None."""
    return None if value is None else checks.positive("reference_temperature", value, unit="K")


def energy(value: StrainEnergy) -> StrainEnergy:
    """Return `value`; raise `InputError` if it is something else."""
    if not isinstance(value, StrainEnergy):
        raise InputError(
            f"strain_energy must be a StrainEnergy, such as Yeoh; got {checks.shown(value)}"
        )
    return value


def band(value: tuple[float, float] | None) -> tuple[float, float] | None:
    """Return a band of angular frequencies [rad/s]; raise `InputError` if it is none."""
    if value is None:
        return None
    band = checks.in_reason("valid_band", value, unit="rad/s")
    if len(band) != 2 or band[0] >= band[1]:
        raise InputError(
            f"valid_band [rad/s] must be a lower and a higher frequency; got {checks.shown(value)}"
        )
    return float(band[0]), float(band[1])
