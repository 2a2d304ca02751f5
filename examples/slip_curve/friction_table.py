"""Friction of a case over sliding speed, temperature and pressure, with the interval of its answer.

The contacts are solved on their first full grid under the conditions of the case, but for heat: how
the rubber warms depends on its way through the patch. Between points friction is linear in ln v, T
and ln p; beyond them it is that of the last point.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.conditions.conditions import Conditions
from gripscale.core import ZERO_CELSIUS, Array, InputError
from gripscale.experiment.design import Design, Point, solve_design, variable_attributes
from gripscale.experiment.solve import Bench
from gripscale.questions.answer.variables import of_hysteresis
from gripscale.questions.vary.inputs import AnswerModel
from gripscale.questions.vary.study import study_numbers

# Name of the friction over `kind`, `bound` and the three axes of the table.
TABLE = "table_friction"
AXES = ("sliding_speed", "rubber_temperature", "local_pressure")
KINDS_OF_FRICTION = "hysteresis", "with area term"
BOUNDS = ("low", "value", "high")  # ends of the 90 % interval, and the value between
_SLOWEST = 0.01  # lowest sliding speed of the table [m/s]
_SPEEDS = 6
# Pressures over the mean one: the highest of a parabola, and a quarter of it.
_PRESSURES = 0.375, 1.5
_WARMEST = 80.0  # rise of the temperature up to which friction is solved where the rubber warms [K]
_WARMER = 47.0  # largest step of the temperatures [K]


def friction_table(
    case: Case, temperatures: Sequence[float], fastest: float, bench: Bench
) -> xr.Dataset:
    """Return the friction of a case up to a sliding speed [m/s], at temperatures [K] and above.

    `TABLE` over `kind` (hysteresis, and with the area term of the case), `bound` and `AXES`. The
    store of the bench keeps what is solved. Raises `InputError` if no surface was measured, or a
    contact has no result.
    """
    if case.surface.measured is None:
        raise InputError("a slip curve needs a measured surface; got sine waves")
    conditions, rubber = (case.conditions or Conditions()).without("heat"), case.rubber
    kelvins = np.array([math.nan])  # of a rubber without a temperature
    if temperatures:
        warms = case.conditions is not None and case.conditions.heat is not None
        low, high = min(temperatures), max(temperatures) + (_WARMEST if warms else 0.0)
        if rubber.shift is not None:
            high = max(min(high, rubber.shift.limits[1]), low)
        kelvins = np.linspace(low, high, 1 + math.ceil((high - low) / _WARMER - 1e-9))
    values = {
        "speed": np.geomspace(_SLOWEST, max(fastest, 10.0 * _SLOWEST), _SPEEDS),
        "temperature": kelvins,
        "pressure": case.load.pressure * np.array(_PRESSURES),
    }
    points = []
    for index in np.ndindex(*(axis.size for axis in values.values())):
        speed, kelvin, pressure = (
            float(axis[i]) for axis, i in zip(values.values(), index, strict=True)
        )
        shifted = math.isfinite(kelvin)
        there = replace(conditions, temperature=kelvin) if shifted else conditions
        point = case.replace(speed=speed, pressure=pressure, conditions=there)
        model = AnswerModel(None, there, case.below_measurement)
        label = f"{speed:.3g} m/s, {pressure:.3g} Pa"
        label += f", {kelvin - ZERO_CELSIUS:.3g} C" if shifted else ""
        points.append(Point(index, label, point.task(model)))
    design = Design({name: axis.size for name, axis in values.items()}, points)
    data = solve_design(design, bench, study_numbers).assign_coords(values)
    failed = [str(word) for word in data.prediction_status.values.flat if word != "converged"]
    if failed:
        raise InputError(f"the friction of the case has no result at every speed: {failed[0]}")
    if not np.isfinite(data["answer_friction"]).all():
        raise InputError("the direct contact of the case has no friction for a slip curve")
    # the hysteresis, and with it the interface where there is one
    names = dict.fromkeys([f"answer_{of_hysteresis(data, 'friction')}", "answer_friction"])
    ends = "_low", "", "_high"
    kinds = [xr.concat([data[f"{name}{end}"] for end in ends], "bound") for name in names]
    table = xr.concat(kinds, "kind").transpose("kind", "bound", *values)
    coords = {"kind": list(KINDS_OF_FRICTION[: len(kinds)]), "bound": list(BOUNDS)}
    text = variable_attributes("sliding friction with the interval of the answer")
    data = xr.Dataset({TABLE: table.assign_coords(coords).assign_attrs(text)})
    return data.rename(dict(zip(values, AXES, strict=True)))


class TableFriction:
    """The friction of a table as a brush asks for it, a row for each kind, bound and temperature.

    Called with sliding speed, pressure and temperature rise over the temperature of the row.
    """

    def __init__(self, table: xr.DataArray, temperatures: Array) -> None:
        speed, kelvin, pressure = (table[axis].values for axis in AXES)
        self._axes = np.log(speed), np.nan_to_num(kelvin), np.log(pressure)
        flat = table.values.reshape(-1, *table.shape[2:])
        # rows are neighbours of one another to `map_coordinates`: none may hold NaN
        values = np.repeat(flat, temperatures.size, axis=0)
        self._values = np.nan_to_num(values)
        self._unknown = np.isnan(values).any(axis=(1, 2, 3))
        self._before = np.tile(temperatures, flat.shape[0])
        self.rows = (*table.shape[:2], temperatures.size)

    def __call__(self, speed: Array, pressure: Array, warming: Array) -> Array:
        """Return friction [-] of the shape (rows, ...) of arguments with or without rows."""
        from scipy.ndimage import map_coordinates  # slow to import

        # behind the rows: speeds of the road, slips, points along the patch
        row = np.arange(self._before.size).reshape(-1, 1, 1, 1)
        kelvin = self._before[row] + warming
        values = np.log(speed), kelvin, np.log(np.maximum(pressure, 1.0))
        at = [
            np.interp(value, axis, np.arange(axis.size))  # kept beyond the ends
            for value, axis in zip(values, self._axes, strict=True)
        ]
        points = np.stack(np.broadcast_arrays(row, *at))
        friction = np.asarray(map_coordinates(self._values, points, order=1, mode="nearest"))
        friction[np.broadcast_to(self._unknown.reshape(row.shape), friction.shape)] = math.nan
        return friction


# Formulas of vehicle models: M. Burckhardt, Fahrwerktechnik: Radschlupf-Regelsysteme (1993); H. B.
# Pacejka, Tire and Vehicle Dynamics, 3rd ed. (2012), eq. 4.49, without shifts.


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
