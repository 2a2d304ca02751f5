"""What temperatures add to a study: which lie beyond the shift, and the friction master curve.

Where temperature does nothing but shift the relaxation times, E*(w, T) = E*(a_T w, T_ref), speed
and temperature are one variable, mu(v, T) = mu(a_T v, T_ref).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.experiment.design import variable_attributes
from gripscale.questions.vary.axis import Axis
from gripscale.rubber import Rubber

if TYPE_CHECKING:
    from gripscale.experiment.task import Task

BEYOND_SHIFT = "rubber_temperature_extrapolated"
REDUCED_SPEED = "reduced_speed"


def beyond_shift(tasks: Sequence[Task], axes: Sequence[Axis]) -> dict[str, xr.DataArray]:
    """Return where the temperature before the contact lies beyond those the shift rests on.

    Of the tasks of all points, last axis fastest. Empty where no temperature is stated.
    """
    pairs = [(task.rubber, task.model.conditions) for task in tasks]
    if all(conditions is None or conditions.temperature is None for _, conditions in pairs):
        return {}
    before = [rubber if c is None else c.before(rubber) for rubber, c in pairs]
    sizes = {axis.name: len(axis.values) for axis in axes}
    flags = np.reshape([rubber.shift_extrapolated for rubber in before], [*sizes.values()])
    text = "whether the temperature lies beyond those the shift of the rubber rests on"
    return {BEYOND_SHIFT: xr.DataArray(flags, dims=[*sizes], attrs=variable_attributes(text))}


def with_master_curve(result: xr.Dataset, rubber: Rubber) -> xr.Dataset:
    """Return a study over speed and temperature with the reduced speed a_T v.

    The shift factors are those to the reference temperature of `rubber`.
    """
    assert rubber.shift is not None
    assert rubber.reference_temperature is not None
    kelvin, reference = result.temperature.values, rubber.reference_temperature
    horizontal = variable_attributes(f"horizontal shift factor a_T to {reference:g} K")
    vertical = variable_attributes(f"vertical factor b_T to {reference:g} K")
    result = result.assign_coords(
        shift_factor=("temperature", rubber.shift.a(kelvin, reference), horizontal),
        vertical_shift_factor=("temperature", rubber.shift.b(kelvin, reference), vertical),
    )
    about = variable_attributes("reduced speed", "m/s") | {"symbol": "a_T v"}
    speed = (result.speed * result.shift_factor).assign_attrs(result.speed.attrs | about)
    return result.assign_coords({REDUCED_SPEED: speed})
