"""What temperatures add to a study: which lie beyond the shift, and the friction master curve.

Where temperature does nothing but shift the relaxation times, E*(w, T) = E*(a_T w, T_ref), speed
and temperature are one variable, mu(v, T) = mu(a_T v, T_ref).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from gripscale.model import TOTALS
from gripscale.rubber import Rubber
from gripscale.study.axis import Axis
from gripscale.study.collapse import collapse
from gripscale.study.conditioned import rubber_before
from gripscale.study.task import Task

BEYOND_SHIFT = "rubber_beyond_shift"
REDUCED_SPEED = "reduced_speed"
COLLAPSED = {
    "total_friction": "friction_collapse",
    "total_contact_fraction": "contact_fraction_collapse",
}
"""Names of how far the temperatures lie apart over the reduced speed."""


def beyond_shift(tasks: Sequence[Task], axes: Sequence[Axis]) -> dict[str, xr.DataArray]:
    """Return where the temperature before the contact lies beyond those the shift rests on.

    Of the tasks of all points, last axis fastest. Empty where no temperature is stated.
    """
    if not any(_states_temperature(task) for task in tasks):
        return {}
    flags = [rubber_before(task.rubber, task.model).shift_extrapolated for task in tasks]
    values = np.reshape(flags, [len(axis.values) for axis in axes])
    attrs = {
        "units": "1",
        "long_name": "whether the temperature lies beyond those the shift of the rubber rests on",
    }
    return {BEYOND_SHIFT: xr.DataArray(values, dims=[axis.name for axis in axes], attrs=attrs)}


def with_master_curve(result: xr.Dataset, rubber: Rubber) -> xr.Dataset:
    """Return a study over speed and temperature with a_T v, and how far it makes one curve.

    The shift factors are those to the reference temperature of `rubber`.
    """
    assert rubber.shift is not None
    assert rubber.reference_temperature is not None
    kelvin, reference = result.temperature.values, rubber.reference_temperature
    factors = {
        "shift_factor": (rubber.shift.a(kelvin, reference), "horizontal shift factor a_T"),
        "vertical_shift_factor": (rubber.shift.b(kelvin, reference), "vertical factor b_T"),
    }
    result = result.assign_coords(
        {
            name: ("temperature", values, {"units": "1", "long_name": f"{text} to {reference:g} K"})
            for name, (values, text) in factors.items()
        }
    )
    reduced = result.speed * result.shift_factor
    attrs = {"units": "m/s", "long_name": "reduced speed a_T v"}
    result = result.assign_coords({REDUCED_SPEED: reduced.assign_attrs(attrs)})
    return result.assign({COLLAPSED[name]: _collapsed(result, name) for name in COLLAPSED})


def _collapsed(result: xr.Dataset, name: str) -> xr.DataArray:
    """Return how far a total at the temperatures lies apart over the reduced speed."""
    values = result[name].transpose("speed", "temperature").values
    reduced = result[REDUCED_SPEED].transpose("speed", "temperature").values
    found = collapse(list(zip(reduced.T, values.T, strict=True)))
    attrs: dict[str, Any] = {
        "units": "1",
        "long_name": f"largest relative distance of temperatures at the same a_T v, {TOTALS[name]}",
        "interpolation_error": found.interpolation_error,
        "points": found.points,
        "overlapping_points": found.overlapping,
    }
    return xr.DataArray(found.distance, attrs=attrs)


def _states_temperature(task: Task) -> bool:
    conditions = getattr(task.model, "conditions", None)
    return conditions is not None and conditions.temperature is not None
