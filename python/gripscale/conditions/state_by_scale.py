"""Temperature and strain at every scale of a direct contact, and the rubber they make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.conditions.by_scale import RubberByScale, ScaleFactors
from gripscale.conditions.conditions import Conditions
from gripscale.rubber import Rubber

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StateByScale:
    """What the rubber has become at some wavenumbers, arrays of shape (scales,)."""

    wavenumber: Array
    """Rising [rad/m]."""
    warming: Array
    """Above the temperature before the contact [K]."""
    strain: Array
    """Uniaxial amplitude of the waves up to the wavenumber [-]."""
    storage_factor: Array
    """f, what is left of E' by strain [-]."""
    loss_factor: Array
    """g, what is left of E'' by strain [-]."""
    beyond_sweep: NDArray[np.bool_]
    """Where the strain lies beyond what the softening was measured for."""
    beyond_shift: NDArray[np.bool_]
    """Where the temperature lies beyond those the shift rests on."""
    rubber: RubberByScale
    """The rubber that is solved with."""


def state_by_scale(
    conditions: Conditions, rubber: Rubber, *, wavenumber: Array, warming: Array, strain: Array
) -> StateByScale:
    """Return the rubber under `conditions` with its temperature and strain at every scale.

    Parameters
    ----------
    conditions : Conditions
        What changes it.
    rubber : Rubber
        As measured.
    wavenumber : array, shape (scales,)
        Rising [rad/m].
    warming, strain : array, shape (scales,)
        Above the temperature before the contact [K], and uniaxial amplitude [-].
    """
    before, kelvin = conditions.before(rubber), conditions.temperature_of(rubber)
    one = np.ones(wavenumber.size)
    shift, stiffening = one, one
    storage, loss = one, one
    beyond = warm_beyond = np.zeros(wavenumber.size, dtype=bool)
    if conditions.heat is not None and kelvin is not None and before.shift is not None:
        warm = conditions.within_shift(before, kelvin + warming)
        shift = before.shift.a(warm, kelvin)
        stiffening = 1.0 / before.shift.b(warm, kelvin)
        warm_beyond = np.array([not before.shift.within(t) for t in kelvin + warming])
    if conditions.softening is not None:
        at = [kelvin] * wavenumber.size if kelvin is None else list(kelvin + warming)
        left = [conditions.softening.factors(float(e), t) for e, t in zip(strain, at, strict=True)]
        storage = np.array([float(one.storage) for one in left])
        loss = np.array([float(one.loss) for one in left])
        beyond = np.array([bool(one.outside) for one in left])
    factors = ScaleFactors(wavenumber, shift, stiffening, storage, loss)
    return StateByScale(
        wavenumber,
        warming,
        strain,
        storage,
        loss,
        beyond,
        warm_beyond,
        RubberByScale(before, factors),
    )
