"""Water under a block: squeeze-out while it passes.

A block of length L, wide across it, sinks into water of viscosity eta by the mean pressure p_0,
with the contact pressure p_c and flow factor phi of a `gap_curve` (docs/wet-roads.md):

    -dh/dt = (p_0 - p_c(h)) phi(h) h^3 / (eta L^2)
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
import xarray as xr

from gripscale.core import Array, InputError, checks, labelled
from gripscale.flow.gap_flow import gap_flow
from gripscale.half_space.solve import solve_rough_contact
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap
from gripscale.theory.layers import Layers

WATER, WATER_DENSITY = 1e-3, 1e3  # viscosity [Pa s] and density [kg/m^3] at 20 C
# Least pressure of a curve over the pressure, and its contacts.
LOWEST_PRESSURE, CURVE_CONTACTS = 0.01, 8
DECAY = 0.56  # of 1 - phi with the gap over the rms height, beyond contact (Patir and Cheng)
INSTANTS = 4000
NEARLY = 1e-7  # gap over the final one, at which the film counts as gone
FLOATING = 0.01  # share of the load on asperities below which the block floats
_SOURCE = "gripscale lubrication"
_OVER_SPEED = (
    ("friction", "1", "friction coefficient on the wet surface"),
    ("dry_friction", "1", "friction coefficient of the dry contact"),
    ("viscous_friction", "1", "share of the shear of the water in the friction coefficient"),
    ("asperity_share", "1", "share of the load on asperities, mean of the passage"),
    ("film", "m", "mean gap at the end of the passage"),
    ("reduced_reynolds", "1", "inertia over viscous forces, mean of the passage"),
)


@dataclass(frozen=True)
class GapCurve:
    """A contact under rising pressures [Pa]: what it carries and lets through at its mean gap [m].

    The flow factor is that along the sliding direction, the friction that of dissipation.
    """

    pressure: Array
    mean_gap: Array
    flow_factor: Array
    friction: Array
    rms_height: float
    """Of the surface [m]; infinite: the flow factor stays as it is beyond the first contact."""

    def contact_pressure(self, gap: Array) -> Array:
        """Return p_c [Pa] at mean gaps [m]; its logarithm is linear beyond the contacts."""
        log_gap, log_pressure = np.log(self.mean_gap[::-1]), np.log(self.pressure[::-1])
        curve = scipy.interpolate.PchipInterpolator(log_gap, log_pressure)
        slope = (log_pressure[-1] - log_pressure[-2]) / (self.mean_gap[0] - self.mean_gap[1])
        beyond = np.maximum(gap - self.mean_gap[0], 0.0)
        inside = np.clip(np.log(gap), log_gap[0], log_gap[-1])
        return np.asarray(np.exp(curve(inside) + slope * beyond))

    def flow_factors(self, gap: Array) -> Array:
        """Return phi [-] at mean gaps [m]; it tends to 1 beyond the contacts."""
        inside = np.interp(gap, self.mean_gap[::-1], self.flow_factor[::-1])
        beyond = np.maximum(gap - self.mean_gap[0], 0.0) / self.rms_height
        return np.asarray(1.0 - (1.0 - inside) * np.exp(-DECAY * beyond))

    def friction_stress(self, pressure: Array) -> Array:
        """Return the friction per nominal area [Pa] of the contact under pressures [Pa]."""
        return np.asarray(np.interp(pressure, self.pressure, self.friction) * pressure)


def gap_curve(
    rubber: Rubber | Layers, surface: HeightMap, *, pressure: float, speed: float, **options: Any
) -> GapCurve:
    """Return the contact of a map under pressures up to `pressure` [Pa] at a speed [m/s].

    `options` are those of `solve_rough_contact`. Raises `InputError` for a profile.
    """
    highest = checks.positive("pressure", pressure, unit="Pa")
    loads = highest * np.geomspace(LOWEST_PRESSURE, 1.0, CURVE_CONTACTS)
    contacts, flows = [], []
    for load in map(float, loads):
        contacts.append(solve_rough_contact(rubber, surface, pressure=load, speed=speed, **options))
        flows.append(gap_flow(contacts[-1]))
    if not flows[-1].mean_gap > 0.0:
        raise InputError(f"pressure must leave a gap; got {highest:g} Pa, which closes it")
    return GapCurve(
        pressure=loads,
        mean_gap=np.array([flow.mean_gap for flow in flows]),
        flow_factor=np.array([flow.flow_factor[0] for flow in flows]),
        friction=np.array([contact.friction_from_dissipation for contact in contacts]),
        rms_height=float(np.sqrt(np.mean(contacts[-1].height ** 2))),
    )


@dataclass(frozen=True)
class SqueezeOut:
    """Mean gap [m] under a block and share of the load on asperities [-] over the time [s]."""

    time: Array
    mean_gap: Array
    asperity_share: Array

    def until(self, time: float, values: Array) -> float:
        """Return the mean of values of the film until a time [s]."""
        inner = self.time < time
        instants = np.append(self.time[inner], time)
        kept = np.append(values[inner], np.interp(time, self.time, values))
        return float(np.trapezoid(kept, instants) / time)


def squeeze_out(
    curve: GapCurve, *, film: float, length: float, pressure: float, viscosity: float = WATER
) -> SqueezeOut:
    """Return how water leaves from under a block.

    `film` is the mean gap at the beginning [m], full of water; `length` that of the block between
    the edges where water leaves [m]; `pressure` the mean pressure on it [Pa], within the curve;
    `viscosity` that of the fluid [Pa s].
    """
    first = checks.positive("film", film, unit="m")
    load = checks.positive("pressure", pressure, unit="Pa")
    size = checks.positive("length", length, unit="m") ** 2
    thickness = checks.positive("viscosity", viscosity, unit="Pa s")
    last_log = np.interp(math.log(load), np.log(curve.pressure), np.log(curve.mean_gap))
    last = float(np.exp(last_log))
    if first <= last:
        return SqueezeOut(np.zeros(1), np.array([first]), np.ones(1))
    gap = last + (first - last) * np.geomspace(1.0, NEARLY, INSTANTS)
    carried = np.minimum(curve.contact_pressure(gap), load * (1.0 - 0.1 * NEARLY))
    speed = (load - carried) * curve.flow_factors(gap) * gap**3 / (thickness * size)
    # the logarithm of the distance to the end has equal steps, and the integrand is smooth in it
    pace = (gap - last) / np.maximum(speed, 1e-300)
    steps = -np.diff(np.log(gap - last)) * 0.5 * (pace[1:] + pace[:-1])
    return SqueezeOut(np.append(0.0, np.cumsum(steps)), gap, carried / load)


def wet_friction(
    rubber: Rubber | Layers,
    surface: HeightMap,
    *,
    pressure: float,
    speeds: Sequence[float],
    film: float,
    length: float,
    viscosity: float = WATER,
    density: float = WATER_DENSITY,
    **options: Any,
) -> xr.Dataset:
    """Return friction of a block on a wet map over its speed [m/s].

    `film`, `length` and `viscosity` are those of `squeeze_out`, `density` is that of the fluid
    [kg/m^3]; `options` are further arguments of `gripscale.solve_rough_contact`. The Dataset has
    `friction`, `dry_friction`, `viscous_friction`, `asperity_share` [-] in the mean of the passage,
    `film` at its end [m] and `reduced_reynolds` [-]; its attribute `notes` says where the model
    ends.
    """
    load = checks.positive("pressure", pressure, unit="Pa")
    sliding, rows = checks.positive_vector("speeds", speeds, unit="m/s"), []
    for speed in map(float, sliding):
        curve = gap_curve(rubber, surface, pressure=load, speed=speed, **options)
        water = squeeze_out(curve, film=film, length=length, pressure=load, viscosity=viscosity)
        passage, share = length / speed, water.asperity_share
        viscous = water.until(passage, viscosity * speed / water.mean_gap * (1.0 - share)) / load
        hysteresis = water.until(passage, curve.friction_stress(share * load)) / load
        last = float(np.interp(passage, water.time, water.mean_gap))
        inertia = density * speed * water.until(passage, water.mean_gap**2)
        reynolds = inertia / (viscosity * length)
        dry, carried = float(curve.friction[-1]), water.until(passage, share)
        rows.append((hysteresis + viscous, dry, viscous, carried, last, reynolds))
    data = {
        name: labelled("speed", values, unit, text, _SOURCE)
        for (name, unit, text), values in zip(_OVER_SPEED, np.transpose(rows), strict=True)
    }
    notes = []
    if (floating := sliding[data["asperity_share"].values < FLOATING]).size:
        notes.append(f"The block floats on the water from {floating.min():.3g} m/s.")
    if (fast := sliding[data["reduced_reynolds"].values > 1.0]).size:
        notes.append(
            f"Inertia of the water, which is left out, counts from {fast.min():.3g} m/s: there the "
            "water carries more."
        )
    data["speed"] = labelled("speed", sliding, "m/s", "sliding speed", "input")
    return xr.Dataset(data, attrs={"notes": " ".join(notes)})
