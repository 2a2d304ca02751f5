"""One answer of one model, as the comparison takes it from the Dataset the model gave."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr

from gripscale.comparison.curve import Curve, curve_of
from gripscale.conditions.conditions import Conditions
from gripscale.cut_off_exponents import NOT_TOLD, CutOffExponents
from gripscale.model import ADHESIVE_FRICTION, cut_off_exponents_of, extrapolation_of
from gripscale.rubber.extrapolation import UNKNOWN, Extrapolation

CONVERGED = "converged"
QUANTITIES = ("contact_fraction", "friction", "friction_from_dissipation")
"""Totals every sample has, as `gripscale.model.TOTALS` without `total_`."""


@dataclass(frozen=True, eq=False)
class Sample:
    """One solution of a rung: its totals with their estimated errors, or why there are none."""

    contact_fraction: float
    friction: float
    """From the contact traction."""
    friction_from_dissipation: float
    status: str
    of: str = ""
    """What it is a sample of."""
    contact_fraction_error: float = math.nan
    """Estimated by the model [-], absolute; NaN if it gives none."""
    friction_error: float = math.nan
    """The same of the friction coefficient."""
    adhesive_friction: float = math.nan
    """Of the area term [-]; NaN where none was asked for or the model knows none."""
    extrapolation: Extrapolation = UNKNOWN
    """What of it rests on the rubber beyond its measured frequencies."""
    cut_off_exponents: CutOffExponents = NOT_TOLD
    """How it changes with the smallest wavelength."""
    curve: Curve | None = None
    """Down to each wavelength, where the model tells it."""
    seconds: float = 0.0

    @property
    def converged(self) -> bool:
        """Whether the numbers may be used."""
        return self.status == CONVERGED


def sample_of(
    answer: xr.Dataset,
    of: str = "",
    conditions: Conditions | None = None,
    temperature: float | None = None,
) -> Sample:
    """Return the sample in the `answer` of a model.

    Where the model does not know the area term of `conditions`, it is that of its contact area at
    the `temperature` before the contact [K].
    At rest there is no friction: what rounding leaves of it becomes zero.
    """
    rest = float(answer["nominal_speed"]) == 0.0
    totals = {name: float(answer[f"total_{name}"]) for name in QUANTITIES}
    if rest:
        totals |= {name: 0.0 * value for name, value in totals.items() if "friction" in name}
    return Sample(
        **totals,
        status=str(answer["prediction_status"].item()),
        of=of,
        contact_fraction_error=_error(answer, "contact_fraction"),
        friction_error=math.nan if rest else _error(answer, "friction"),
        adhesive_friction=_adhesive(answer, conditions, temperature),
        extrapolation=extrapolation_of(answer),
        cut_off_exponents=cut_off_exponents_of(answer),
        curve=curve_of(answer),
        seconds=float(answer.attrs.get("seconds", 0.0)),
    )


def _adhesive(
    answer: xr.Dataset, conditions: Conditions | None, temperature: float | None
) -> float:
    if ADHESIVE_FRICTION in answer or conditions is None:
        return float(answer.get(ADHESIVE_FRICTION, math.nan))
    names = ("total_contact_fraction", "nominal_pressure", "nominal_speed")
    area, pressure, speed = (float(answer[name]) for name in names)
    return conditions.adhesive_friction(area, pressure, speed, temperature)


def _error(answer: xr.Dataset, name: str) -> float:
    """Return the estimated error of a total: of profiles by weight, of waves added up.

    Waves: their relative errors add up in the product of areas, their errors in the sum of
    frictions; all in the same direction, because the same mesh makes them.
    """
    errors = answer.get(f"{name}_error")
    if errors is None:
        return math.nan
    values = np.abs(errors.values)
    if errors.dims == ("profile",):
        return float(answer["weight"].values @ values)
    if errors.dims == ("scale",):
        relative = name == "contact_fraction"
        each = values / answer[name].values if relative else values
        return float(each.sum() * (answer[f"total_{name}"] if relative else 1.0))
    return float(values)
