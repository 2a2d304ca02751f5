"""A calibration as a labelled Dataset: over measured points, parameters and what is left out.

- over `measurement`: what was measured, the hysteresis, the area term, their sum and its band;
- over `parameter`: estimate, standard error, interval (NaN where not determined), profile;
- over `left_out`: the errors of the law fitted to the other points.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from gripscale import versions
from gripscale.calibration.profile import LEVEL
from gripscale.interface.area_term import shear_stress_to_dict
from gripscale.measured.differences import in_spread, measured_variables
from gripscale.wave.dataset import labelled

if TYPE_CHECKING:
    from gripscale.calibration.fitted import FittedLaw

SOURCE = "gripscale calibrate"

HELD_OUT = {
    "points": "measured points left out",
    "rms_inside": "rms residual of the points that were fitted",
    "rms_outside": "rms error at the points left out",
    "rms_outside_in_spread": "the same, over the spread",
    "why_not": "why the other points cannot predict them, empty where they can",
}
"""Numbers of what was left out, with their meaning."""


def to_dataset(calibration: FittedLaw) -> xr.Dataset:
    """Return `calibration` as a Dataset."""
    data = {
        **measured_variables(calibration.measured),
        **_at_points(calibration),
        **_of_parameters(calibration),
        **_left_out(calibration),
    }
    words = {
        "parameter": [one.name for one in calibration.estimates],
        "other_parameter": [one.name for one in calibration.estimates],
    }
    return xr.Dataset(
        data,
        coords=words,
        attrs={
            "title": "Area term fitted to measured friction",
            "law": json.dumps(shear_stress_to_dict(calibration.law)),
            "held": json.dumps(dict(calibration.problem.family.held)),
            "measured_source": calibration.measured.source,
            "level": LEVEL,
            "threshold": calibration.threshold,
            "held_out_by": calibration.held_out_by,
            "spread_known": int(calibration.spread_known),
            "sum_of_squares": calibration.optimum.sum_of_squares,
            "degrees_of_freedom": calibration.freedom,
            "scatter": calibration.scatter,
            **versions.attributes(),
        },
    )


def _at_points(calibration: FittedLaw) -> dict[str, Any]:
    predicted, measured = calibration.predicted, calibration.measured
    apart = calibration.friction - measured.friction
    columns = {
        "nominal_pressure": (predicted.pressure, "Pa", "nominal pressure of the prediction"),
        "contact_temperature": (predicted.temperature, "K", "temperature in the contact"),
        "contact_fraction": (predicted.contact_fraction, "1", "real over nominal contact area"),
        "hysteresis": (predicted.friction, "1", "friction of the hysteresis"),
        "friction_outside_band": (
            predicted.outside_band,
            "1",
            "share of it that rests on the rubber outside the measured frequencies",
        ),
        "prediction_status": (np.array(predicted.status, dtype=object), "1", "converged, or why"),
        "area_term": (calibration.area_term, "1", "friction of the area term"),
        "friction": (calibration.friction, "1", "hysteresis and area term"),
        "friction_band": (calibration.band, "1", "half of its interval by the fit"),
        "difference": (apart, "1", "predicted less measured friction"),
        "difference_in_spread": (
            in_spread(apart, measured.spread),
            "1",
            "the same over the spread",
        ),
    }
    return {
        name: labelled("measurement", values, unit, text, SOURCE)
        for name, (values, unit, text) in columns.items()
    }


def _of_parameters(calibration: FittedLaw) -> dict[str, Any]:
    estimates, profiles = calibration.estimates, calibration.profiles
    columns = {
        "estimate": "best value of the parameter, in its unit",
        "standard_error": "its standard error by the Jacobian",
        "low": "lower end of its interval by profile likelihood, NaN where not determined",
        "high": "upper end of it, NaN where not determined",
    }
    values = {
        name: [getattr(one, "value" if name == "estimate" else name) for one in estimates]
        for name in columns
    }
    data = {
        name: labelled("parameter", values[name], "1", columns[name], SOURCE) for name in values
    }
    units = [one.unit or "1" for one in estimates]
    data["unit"] = labelled("parameter", np.array(units, dtype=object), "1", "its unit", SOURCE)
    data["correlation"] = labelled(
        ("parameter", "other_parameter"), calibration.correlation, "1", "of the estimates", SOURCE
    )
    for at, (name, text) in enumerate(
        {
            "profile_value": "value at which the parameter is held",
            "profile_excess": "rise of the sum of squares, NaN where another parameter has no room",
        }.items()
    ):
        rows = [profiles[one.name][at] for one in estimates]
        data[name] = labelled(("parameter", "step"), rows, "1", text, SOURCE)
    return data


def _left_out(calibration: FittedLaw) -> dict[str, Any]:
    groups = calibration.held_out
    if not groups:
        return {}
    data = {
        name: labelled("left_out", [getattr(one, name) for one in groups], "1", text, SOURCE)
        for name, text in HELD_OUT.items()
    }
    data["left_out"] = labelled(
        "left_out", [one.value for one in groups], "1", "temperature [K] or decade [m/s]", SOURCE
    )
    return data
