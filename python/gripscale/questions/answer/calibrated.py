"""How much of the error of an answer is left where its area term was fitted to measured friction.

An error of contact area or hysteresis that is the same here and at a measured point cancels. The
share w of its variance that is left, and the standard error s of the total friction, are

    w = min(1, |ln(A/A_i)|/ln 5 + |log10(v/v_i)| + |T - T_i|/10 K),    s^2 = w s_answer^2 + s_fit^2

at the nearest measured point i (docs/derivations.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from gripscale.case import BelowMeasurement
from gripscale.conditions.conditions import Conditions
from gripscale.experiment.task import content_hash
from gripscale.model import Load
from gripscale.rubber import Rubber
from gripscale.surface import Surface

AREA_FACTOR, SPEED_FACTOR, WARMER = 5.0, 10.0, 10.0  # where nothing cancels; the last in K


class Contact(NamedTuple):
    """What slides on what, under which load and conditions."""

    rubber: Rubber
    surface: Surface
    load: Load
    conditions: Conditions | None
    below_measurement: BelowMeasurement

    @property
    def key(self) -> str:
        """Hash of all that its errors depend on but for pressure, speed and temperature."""
        effects = replace(self.conditions or Conditions(), temperature=None, shear_stress=None)
        surface = self.surface.only({"waves", "measurement", "cut_off"})
        load = replace(self.load, pressure=1.0, speed=1.0)
        parts = self.rubber, surface, load, replace(effects, off=()), self.below_measurement
        return content_hash(parts)[:32]

    def remaining_error(self, contact_fraction: float) -> tuple[float, float]:
        """Return w and the half width of the friction by the fit; 1 and 0 without a fit."""
        points = getattr(self.conditions and self.conditions.shear_stress, "fitted_to", None)
        if points is None or points.contact != self.key or not contact_fraction > 0.0:
            return 1.0, 0.0
        away = np.abs(np.log(contact_fraction / np.array(points.contact_fraction)))
        away /= math.log(AREA_FACTOR)
        with np.errstate(divide="ignore"):
            decades = np.log(self.load.speed / np.array(points.speed)) / math.log(SPEED_FACTOR)
        away += np.abs(decades)
        kelvin = (self.conditions or Conditions()).temperature_of(self.rubber)
        if points.temperature is not None and kelvin is not None:
            away += np.abs(kelvin - np.array(points.temperature)) / WARMER
        nearest = int(np.argmin(away))
        return min(float(away[nearest]), 1.0), points.half_width[nearest]


def errors_left(
    contacts: Sequence[Contact], contact_fraction: xr.DataArray
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return w and the half width of the fit for answers of contacts, one each or one in all."""
    pairs = zip(contacts, np.atleast_1d(contact_fraction.values), strict=True)
    rows = np.array([contact.remaining_error(float(area)) for contact, area in pairs])
    shape = contact_fraction.shape
    share, width = (contact_fraction.copy(data=column.reshape(shape)) for column in rows.T)
    return share, width
