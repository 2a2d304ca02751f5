"""What temperatures add to a study: which lie beyond the shift, and the friction master curve.

Where temperature does nothing but shift the relaxation times, E*(w, T) = E*(a_T w, T_ref), speed
and temperature are one variable, mu(v, T) = mu(a_T v, T_ref).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.core.arrays import Array
from gripscale.experiment.design import variable_attributes
from gripscale.model import TOTALS
from gripscale.questions.vary.axis import Axis
from gripscale.rubber import Rubber

if TYPE_CHECKING:
    from gripscale.experiment.task import Task

# How far curves lie apart that should be one: friction at several temperatures over a_T v.
#
# The curves have points at abscissas of their own. At each point of one, another is interpolated by
# the polynomial through its six nearest points, in the logarithms of both. Its error is taken as
#
#     e(x) = 4 (x - a)(b - x)/(b - a)^2 max |P_6 - P_4|
#
# between the neighbours a and b, with the difference to the polynomial through four points at the
# middle of this interval and the two beside it: that of the coarser one, and no accident of a
# change of sign. At a point the curves share it is nothing. Points count where it is at most 4e-4,
# with six points in a power of ten: friction of a series of one relaxation time a decade may ripple
# by the decade, which coarser points do not show. So curves that are one lie less than 1e-3 apart.
# Where no point counts, those with e up to 1 % count, with two points in a power of ten. Curves
# with such ripples that are one then lie up to 5.2 % apart: that is taken as the error.

# Largest e at which two curves are compared, points of a curve in a power of ten of its abscissa
# that this needs, and the least relative error of the interpolation.
PRECISE, ROUGH = (4e-4, 6, 0.0), (0.01, 2, 0.052)
NEAREST, FEWER = 6, 4  # points of the interpolation, and of the one that tells its error
_SAME = 1e-9  # difference of two logarithms that is rounding


class _Curve(NamedTuple):
    """Logarithms of abscissas, rising, and of values."""

    x: Array
    y: Array

    def covers(self, x: float) -> bool:
        return bool(self.x.size and self.x[0] - _SAME <= x <= self.x[-1] + _SAME)

    def at(self, x: float, count: int = NEAREST) -> float:
        """Return the polynomial through the nearest points at `x` (Lagrange's form)."""
        nearest = np.argsort(np.abs(self.x - x), kind="stable")[:count]
        u = self.x[nearest]
        weights = [
            math.prod((x - u[m]) / (u[k] - u[m]) for m in range(u.size) if m != k)
            for k in range(u.size)
        ]
        return float(np.dot(weights, self.y[nearest]))

    def error(self, x: float, widest: float) -> float:
        """Return e(x); infinite where points are few, or neighbours further apart than `widest`."""
        if np.abs(self.x - x).min() <= _SAME:
            return 0.0
        if self.x.size < NEAREST:
            return math.inf
        at = int(np.searchsorted(self.x, x)) - 1
        low, high = self.x[at : at + 2]
        if high - low > widest + _SAME:
            return math.inf
        middles = (self.x[1:] + self.x[:-1])[max(at - 1, 0) : at + 2] / 2.0
        apart = max(abs(self.at(m) - self.at(m, FEWER)) for m in middles)
        return float(4.0 * (x - low) * (high - x) / (high - low) ** 2 * apart)


@dataclass(frozen=True)
class Collapse:
    """How far curves lie apart where they overlap."""

    # Largest, relative to the curve that has a point there [-]; NaN if nothing can be compared.
    distance: float
    interpolation_error: float  # largest estimated error of what was compared [-]
    points: int  # compared
    overlapping: int  # points at which two curves overlap, those between too coarse points included


def collapse(curves: Sequence[tuple[ArrayLike, ArrayLike]]) -> Collapse:
    """Return how far curves of abscissas and values lie apart; they are above zero and finite."""
    usable = []
    for x, y in curves:
        both = np.array([np.ravel(x), np.ravel(y)], dtype=float)
        with np.errstate(invalid="ignore"):
            logs = np.log(both[:, ((both > 0.0) & np.isfinite(both)).all(axis=0)])
        usable.append(_Curve(*logs[:, np.argsort(logs[0])]))
    overlapping = [
        (abs(math.expm1(other.at(x) - y)), x, other)
        for curve, other in permutations(usable, 2)
        for x, y in zip(*curve, strict=True)
        if other.covers(x)
    ]
    for trusted, per_decade, least in (PRECISE, ROUGH):
        widest = math.log(10.0) / per_decade
        errors = [math.expm1(other.error(x, widest)) for _, x, other in overlapping]
        counted = [at for at, error in enumerate(errors) if error <= trusted]
        if counted:
            distance = max(overlapping[at][0] for at in counted)
            largest = max(least, *(errors[at] for at in counted))
            return Collapse(distance, largest, len(counted), len(overlapping))
    return Collapse(math.nan, math.nan, 0, len(overlapping))


BEYOND_SHIFT = "rubber_temperature_extrapolated"
REDUCED_SPEED = "reduced_speed"
# Names of how far the temperatures lie apart over the reduced speed.
COLLAPSED = {
    "total_friction": "friction_collapse",
    "total_contact_fraction": "contact_fraction_collapse",
}


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
    """Return a study over speed and temperature with a_T v, and how far it makes one curve.

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
    speed = (result.speed * result.shift_factor).assign_attrs(
        variable_attributes("reduced speed a_T v", "m/s")
    )
    result = result.assign_coords({REDUCED_SPEED: speed})
    for name, collapsed in COLLAPSED.items():
        rows = (values.transpose("temperature", "speed").values for values in (speed, result[name]))
        overlap = collapse(list(zip(*rows, strict=True)))
        text = f"largest relative distance of temperatures at the same a_T v, {TOTALS[name]}"
        attrs: dict[str, Any] = {
            **variable_attributes(text),
            "interpolation_error": overlap.interpolation_error,
            "points": overlap.points,
            "overlapping_points": overlap.overlapping,
        }
        result[collapsed] = xr.DataArray(overlap.distance, attrs=attrs)
    return result
