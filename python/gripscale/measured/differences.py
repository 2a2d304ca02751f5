"""How far predictions are from measured friction, point by point and as a root mean square."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.interface.area_term import InterfacialShearStress
from gripscale.measured.friction import MeasuredFriction
from gripscale.measured.predicted import Predicted
from gripscale.wave.dataset import labelled

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

SOURCE = "gripscale residuals"

MEASURED = {
    "speed": ("m/s", "speed of the measurement"),
    "friction": ("1", "measured friction coefficient"),
    "spread": ("1", "its standard deviation"),
    "temperature": ("K", "temperature of the rubber before the contact"),
    "pressure": ("Pa", "nominal pressure"),
}
"""Columns of a measurement as result files hold them, with unit and meaning."""


def residuals(
    measured: MeasuredFriction,
    predicted: Mapping[str, Predicted],
    shear_stress: InterfacialShearStress | None = None,
) -> xr.Dataset:
    """Return predicted friction beside measured friction, over `model` and `measurement`.

    Parameters
    ----------
    measured : MeasuredFriction
        What was measured.
    predicted : mapping of str to Predicted
        What each model says at its points, by the model's name.
    shear_stress : InterfacialShearStress, optional
        Law of an area term that the total friction has beside the hysteresis.

    Returns
    -------
    xarray.Dataset
        `hysteresis`, `area_term` where there is a law, `friction` (their sum), `difference`
        (predicted less measured) and `difference_in_spread` (NaN where no spread is known) over
        `model` and `measurement`; `rms_difference` and `rms_difference_in_spread` over `model`,
        of the points that have an answer; and what was measured.

    Raises
    ------
    InputError
        If a prediction has another number of points, there is none, or the law needs a temperature
        that is not known.
    """
    import xarray as xr

    checks.instance("measured", measured, MeasuredFriction)
    if not isinstance(predicted, Mapping) or not predicted:
        found = checks.shown(predicted)
        raise InputError(f"predicted must hold the prediction of at least one model; got {found}")
    if shear_stress is not None and not isinstance(shear_stress, InterfacialShearStress):
        raise InputError(
            f"shear_stress must be a law of gripscale.interface; got {checks.shown(shear_stress)}"
        )
    for name, one in predicted.items():
        checks.instance("each of predicted", one, Predicted)
        if one.friction.size != measured.speed.size:
            raise InputError(
                f"{name} must be predicted at the {measured.speed.size} points measured; "
                f"got {one.friction.size}"
            )
    grid = ("model", "measurement")
    hysteresis = np.array([one.friction for one in predicted.values()])
    data = {"hysteresis": labelled(grid, hysteresis, "1", "friction of the hysteresis", SOURCE)}
    total = hysteresis
    if shear_stress is not None:
        terms = [one.area_term(shear_stress, measured.speed) for one in predicted.values()]
        data["area_term"] = labelled(grid, terms, "1", "friction of the area term", SOURCE)
        total = hysteresis + np.array(terms)
    difference = total - measured.friction
    relative = in_spread(difference, measured.spread)
    about = "predicted less measured friction"
    data |= {
        "friction": labelled(grid, total, "1", "predicted friction coefficient", SOURCE),
        "difference": labelled(grid, difference, "1", about, SOURCE),
        "difference_in_spread": labelled(grid, relative, "1", f"{about}, over its spread", SOURCE),
        "rms_difference": labelled("model", rms(difference), "1", f"rms of {about}", SOURCE),
        "rms_difference_in_spread": labelled(
            "model", rms(relative), "1", f"rms of {about}, over its spread", SOURCE
        ),
    }
    data |= measured_variables(measured)
    return xr.Dataset(data, coords={"model": list(predicted)})


def measured_variables(measured: MeasuredFriction) -> dict[str, xr.Variable]:
    """Return the columns of a measurement as variables over `measurement`."""
    return {
        f"measured_{name}": labelled(
            "measurement", getattr(measured, name), unit, text, measured.source
        )
        for name, (unit, text) in MEASURED.items()
    }


def in_spread(difference: Array, spread: Array) -> Array:
    """Return differences over the spread [-]; NaN where it is not known or zero."""
    return difference / np.where(spread > 0.0, spread, np.nan)


def rms(values: Array) -> Array:
    """Return the root mean square over the last axis of what is known, NaN where nothing is."""
    known = np.isfinite(values)
    count = known.sum(axis=-1)
    squares = np.where(known, values, 0.0) ** 2
    return np.asarray(np.sqrt(squares.sum(axis=-1) / np.where(count > 0, count, np.nan)))
