"""What temperatures add to a study: which lie beyond the shift, and the friction master curve.

Where temperature does nothing but shift the relaxation times, E*(w, T) = E*(a_T w, T_ref), speed
and temperature are one variable, mu(v, T) = mu(a_T v, T_ref).
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.core.arrays import Array
from gripscale.experiment.design import variable_attributes
from gripscale.model import TOTALS
from gripscale.questions.vary.axis import Axis
from gripscale.rubber import Rubber
from gripscale.wave.result import harmonics

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

_Curve = tuple[Array, Array]

# Largest e at which two curves are compared, points of a curve in a power of ten of its abscissa
# that this needs, and the least relative error of the interpolation.
PRECISE, ROUGH = (4e-4, 6, 0.0), (0.01, 2, 0.052)
NEAREST, FEWER = 6, 4  # points of the interpolation, and of the one that tells its error
_SAME = 1e-9  # difference of two logarithms that is rounding


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
    usable: list[_Curve] = []
    for x, y in curves:
        both = np.array([np.ravel(x), np.ravel(y)], dtype=float)
        with np.errstate(invalid="ignore"):
            logs = np.log(both[:, ((both > 0.0) & np.isfinite(both)).all(axis=0)])
        abscissas, values = logs[:, np.argsort(logs[0])]
        usable.append((abscissas, values))
    for trusted, per_decade, least in (PRECISE, ROUGH):
        widest = math.log(10.0) / per_decade
        pairs = [point for two in permutations(usable, 2) for point in _apart(*two, widest)]
        counted = [(distance, error) for distance, error in pairs if error <= trusted]
        if counted:
            distances, errors = zip(*counted, strict=True)
            return Collapse(max(distances), max(least, *errors), len(counted), len(pairs))
    return Collapse(math.nan, math.nan, 0, len(pairs))


def _apart(first: _Curve, other: _Curve, widest: float) -> Iterator[tuple[float, float]]:
    """Yield distance and error of the interpolation at the points of `first` along `other`."""
    (x, y), (nodes, values) = first, other
    inside = np.zeros(x.size, dtype=bool)
    if nodes.size:
        inside = (x >= nodes[0] - _SAME) & (x <= nodes[-1] + _SAME)
    for here, value in zip(x[inside], y[inside], strict=True):
        apart = abs(math.expm1(_interpolated(here, nodes, values, NEAREST) - value))
        yield apart, math.expm1(_error(here, nodes, values, widest))


def _error(x: float, nodes: Array, values: Array, widest: float) -> float:
    """Return e(x); infinite where points are too few, or neighbours further apart than `widest`."""
    if np.abs(nodes - x).min() <= _SAME:
        return 0.0
    if nodes.size < NEAREST:
        return math.inf
    at = int(np.searchsorted(nodes, x)) - 1
    low, high = nodes[at : at + 2]
    if high - low > widest + _SAME:
        return math.inf
    middles = (nodes[1:] + nodes[:-1])[max(at - 1, 0) : at + 2] / 2.0
    apart = max(
        abs(_interpolated(m, nodes, values, NEAREST) - _interpolated(m, nodes, values, FEWER))
        for m in middles
    )
    return float(4.0 * (x - low) * (high - x) / (high - low) ** 2 * apart)


def _interpolated(x: float, abscissas: Array, values: Array, count: int) -> float:
    """Return the polynomial through the nearest points at `x` (Lagrange's form)."""
    nearest = np.argsort(np.abs(abscissas - x), kind="stable")[:count]
    u = abscissas[nearest]
    weights = [
        math.prod((x - u[m]) / (u[k] - u[m]) for m in range(u.size) if m != k)
        for k in range(u.size)
    ]
    return float(np.dot(weights, values[nearest]))


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
    asked = [task.model.conditions for task in tasks]
    if all(conditions is None or conditions.temperature is None for conditions in asked):
        return {}
    pairs = [(task.rubber, task.model.conditions) for task in tasks]
    before = [rubber if c is None else c.before(rubber) for rubber, c in pairs]
    flags = [rubber.shift_extrapolated for rubber in before]
    values = np.reshape(flags, [len(axis.values) for axis in axes])
    text = "whether the temperature lies beyond those the shift of the rubber rests on"
    dims = [axis.name for axis in axes]
    return {BEYOND_SHIFT: xr.DataArray(values, dims=dims, attrs=variable_attributes(text))}


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
    product = result.speed * result.shift_factor
    speed = product.assign_attrs(variable_attributes("reduced speed a_T v", "m/s"))
    result = result.assign_coords({REDUCED_SPEED: speed})
    reduced = speed.transpose("speed", "temperature").values
    for name, collapsed in COLLAPSED.items():
        values = result[name].transpose("speed", "temperature").values
        overlap = collapse(list(zip(reduced.T, values.T, strict=True)))
        text = f"largest relative distance of temperatures at the same a_T v, {TOTALS[name]}"
        attrs: dict[str, Any] = {
            **variable_attributes(text),
            "interpolation_error": overlap.interpolation_error,
            "points": overlap.points,
            "overlapping_points": overlap.overlapping,
        }
        result[collapsed] = xr.DataArray(overlap.distance, attrs=attrs)
    return result


# Which relaxation times of the rubber make the friction: an estimate in small-strain terms.
#
# The contact pressure of one wave has harmonics p_k. On a half-plane of modulus E*, harmonic k
# dissipates, per sliding distance and up to factors common to all of them,
#
#     D_k = |p_k|^2 E''(w_k) / |E*(w_k)|^2,       w_k = 2 pi k v / lambda,
#
# and E'' is a sum over the Maxwell elements (Ferry, Viscoelastic Properties of Polymers, 3rd ed.
# (1980), ch. 3), so each D_k splits into their parts. The parts, added by decade of relaxation time
# and scaled to the friction coefficient that was solved, are what is returned: the pressure is the
# solver's, at finite strain; the split is that of small strain.
#
# A series samples a continuous spectrum (Ferry, ch. 4), so an element stands for the times between
# it and half way to its neighbours. Where it only stood for its own, a whole share would jump from
# one decade into the next as a temperature shifts the times.

ON_EDGE = 1e-9  # decades by which rounding may move an end over the edge of a decade
_HARMONICS = 32  # harmonics of the contact pressure that count
# Decades up to which an element is a neighbour: further away is another process of relaxation.
NEAR = 1.0


def friction_by_decade(solved: xr.Dataset, rubber: Rubber) -> dict[int, float]:
    """Return the friction coefficient [-] of all waves by decade of relaxation time.

    From n, for relaxation times of 10^n s up to 10^(n+1) s, to its part. Empty where nothing
    slides, the rubber is elastic, a wave failed or the model has no waves. Of waves that say which
    rubber they met, conditions having made it another one, that one counts.
    """
    needed = {"surface_pressure", "angular_frequency", "friction"}
    if not needed <= set(solved.data_vars) or solved.prediction_status != "converged":
        return {}
    if solved.nominal_speed == 0.0:
        return {}
    parts: dict[int, float] = {}
    for i in range(solved.sizes["scale"]):
        wave = solved.isel(scale=i)
        text = str(wave.rubber_parameters.item()) if "rubber_parameters" in wave else ""
        matching = Rubber.from_dict(json.loads(text)) if text else rubber
        share = _shares(wave, matching) * float(wave.friction)
        for n, part in in_decades(np.log10(matching.relaxation_times), share):
            parts[n] = parts.get(n, 0.0) + part
    return parts


def in_decades(decade: Array, share: Array) -> Iterator[tuple[int, float]]:
    """Yield decades and the part of the shares of elements, at `decade` [decades], in each."""
    order = np.argsort(decade)
    for low, high, part in zip(*_ends(decade[order]), share[order], strict=True):
        first, last = math.floor(low + ON_EDGE), math.floor(high - ON_EDGE)
        for n in range(first, max(first, last) + 1):
            inside = float(min(high, n + 1.0) - max(low, n))
            yield n, float(part * (inside / (high - low) if last > first else 1.0))


def _ends(decade: Array) -> tuple[Array, Array]:
    """Return from where to where each element reaches [decades], places in rising order.

    Without a neighbour on one side it reaches as far there as on the other.
    """
    half = np.diff(decade) / 2.0
    half = np.where(2.0 * half <= NEAR, half, np.nan)
    below, above = np.append(np.nan, half), np.append(half, np.nan)
    lower, upper = (np.where(np.isnan(a), b, a) for a, b in ((below, above), (above, below)))
    return decade - np.nan_to_num(lower), decade + np.nan_to_num(upper)


def _shares(wave: xr.Dataset, rubber: Rubber) -> Array:
    """Return the part of each Maxwell element in the dissipation of one wave, adding to one."""
    order = np.arange(1, _HARMONICS + 1)
    omega = order * float(wave.angular_frequency)
    pressure = harmonics(
        wave.surface_x.values, wave.surface_pressure.values, float(wave.wavelength), order
    )
    weight = pressure**2 / np.abs(rubber.complex_modulus(omega)) ** 2
    phase = omega[:, None] * rubber.relaxation_times
    loss = rubber.moduli * phase / (1.0 + phase**2)
    parts = weight @ loss
    total = float(parts.sum())
    return np.asarray(parts / total if total > 0.0 else parts)
