"""Formulas of vehicle models through a slip curve.

M. Burckhardt, Fahrwerktechnik: Radschlupf-Regelsysteme (1993); H. B. Pacejka, Tire and Vehicle
Dynamics, 3rd ed. (2012), eq. 4.49, the Magic Formula without shifts.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gripscale.core.arrays import Array


def burckhardt(slip: Array, c1: float, c2: float, c3: float) -> Array:
    """Return mu(s) of Burckhardt's parameters [-]."""
    return np.asarray(c1 * (1.0 - np.exp(-c2 * slip)) - c3 * slip)


def magic_formula(slip: Array, b: float, c: float, d: float, e: float) -> Array:
    """Return mu(s) of the parameters B, C, D and E of the Magic Formula [-]."""
    bs = b * slip
    return np.asarray(d * np.sin(c * np.arctan(bs - e * (bs - np.arctan(bs)))))


class VehicleFormula(NamedTuple):
    """A formula, its parameters with their bounds, and how it is written."""

    function: Callable[..., Array]
    parameters: tuple[str, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    text: str

    def fit(self, slip: Array, force: Array) -> Array:
        """Return the parameters through a slip curve, then the rms misfit over its peak."""
        from scipy.optimize import least_squares  # slow to import

        peak, slope = float(force.max()), float(force[0] / slip[0])
        start = {3: (peak, slope / peak, 0.2), 4: (slope / (1.5 * peak), 1.5, peak, 0.0)}
        guess = np.clip(start[len(self.low)], np.array(self.low) + 1e-9, np.array(self.high) - 1e-9)

        def misfit(values: Array) -> Array:
            return self.function(slip, *values) - force

        fit = least_squares(misfit, guess, bounds=(self.low, self.high))
        return np.append(fit.x, np.sqrt(np.mean(fit.fun**2)) / peak)


MISFIT = "rms"  # what the misfit is called among the parameters
FORMULAS = {
    "burckhardt": VehicleFormula(
        burckhardt, ("c1", "c2", "c3"), (0, 0.1, -2), (5, 500, 5), "c1 (1 - exp(-c2 s)) - c3 s"
    ),
    "magic_formula": VehicleFormula(
        magic_formula,
        ("B", "C", "D", "E"),
        (0.1, 0.5, 0, -20),
        (200, 2.5, 5, 1),
        "D sin(C atan(B s - E (B s - atan(B s))))",
    ),
}


def fitted_formulas(force: xr.DataArray) -> dict[str, Any]:
    """Return the parameters of the formulas through curves over `slip`, and their misfits."""
    curves, slip = force.transpose(..., "slip"), force.slip.values
    variables: dict[str, Any] = {}
    for name, formula in FORMULAS.items():
        along = f"{name}_parameter"
        fits = [formula.fit(slip, curve) for curve in curves.values.reshape(-1, slip.size)]
        variables[along] = (along, [*formula.parameters, MISFIT])
        values = np.reshape(fits, (*curves.shape[:-1], -1))
        variables[name] = ((*curves.dims[:-1], along), values, {"units": "1"})
    return variables
