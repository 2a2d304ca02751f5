"""What the errors of the inputs carry to the results, and which measurement would take how much.

The interval is that of the answer with the errors of its inputs by first order. A measurement
leaves a share of the standard error of one source: another of the same kind 1/sqrt(2), one that
decides it nothing.
"""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from gripscale.conditions.alternatives import TENSION_OR_SHEAR, THERMAL_CONSTANTS, TREADS
from gripscale.conditions.strain_rule import LOG_AREA, LOG_FRICTION
from gripscale.core.arrays import Array
from gripscale.half_space import line_to_map
from gripscale.half_space.large_strain import finite_over_small
from gripscale.io.table import Column, Table, percent
from gripscale.model import LINE_UNDER_LOAD, PRESSURE_OVER_MODULUS, SAMPLING_FREEDOM
from gripscale.questions.answer.estimate import LARGE_STRAIN_LABEL, LINES_TO_SURFACE
from gripscale.questions.answer.intervals import LogError, combined, half_width
from gripscale.questions.sensitivity.friction_sensitivity import CARRIED, LOSS, STORAGE
from gripscale.questions.uncertainty.first_order import CARRIED_QUANTITIES
from gripscale.questions.uncertainty.page import not_stated
from gripscale.questions.uncertainty.sampled_answer import ROAD
from gripscale.questions.words import SYMBOLS

# Share of a standard error that an equal, independent measurement leaves.
AGAIN = 1.0 / math.sqrt(2.0)
# What measures each source, and the share of its standard error that it leaves. Noise of heights
# counts by its square.
MEASUREMENTS = {
    ROAD: ("as much of the surface once more", AGAIN),
    "modulus": ("moduli once more, {}", AGAIN),
    "cut_off": ("a finer profile, to where the roughness ends", 0.0),
    "cleaning": ("the profiles once more: spikes do not repeat", 0.0),
    "height_noise": ("each profile twice, averaged", AGAIN**2),
    "bulk_modulus": ("bulk modulus of the compound", 0.0),
    "equilibrium_modulus": ("relaxation, to the equilibrium modulus", 0.0),
    "temperature": ("temperature of the rubber, twice", AGAIN),
    "pressure": ("nominal pressure, twice", AGAIN),
    LINES_TO_SURFACE: ("a map in place of lines; it shows a direction, too", 0.0),
    TREADS: ("strain sweeps of the compound", 0.0),
    TENSION_OR_SHEAR: ("whether the strain sweeps are in tension or in shear", 0.0),
    THERMAL_CONSTANTS: ("conductivity and heat capacity of the compound", 0.0),
}


def carried_table(data: xr.Dataset) -> Table:
    """Return what is not known of the inputs, and what it carries to the results, most first."""
    errors = {name: data[CARRIED.format(name)].values for name in CARRIED_QUANTITIES}
    ranked = np.argsort(-np.nan_to_num(errors["friction"]), kind="stable")
    ranked = ranked[np.isfinite(errors["friction"][ranked])]
    columns = [Column("source", [*data.label.values[ranked].tolist(), "together"], "not known")]
    for name, error in errors.items():
        values = [*error[ranked].tolist(), float(np.sqrt(np.sum(error[ranked] ** 2)))]
        columns.append(Column(f"{name}_error", values, f"± of {SYMBOLS[name]}", format=percent))
    notes = ["Standard errors, to first order; `gripscale uncertainty` samples them."]
    if missing := not_stated(data):
        notes.append(f"Not included, as the case states no standard error: {', '.join(missing)}.")
    return Table("carried", columns, "Effect of the errors of the inputs", notes, keys=1)


def next_measurements(data: xr.Dataset) -> Table | None:
    """Return measurements by how much of the interval of the friction they would take.

    `data` is a result of `gripscale.sensitivity` at one point; None without an interval.
    """
    point = data.isel(dict.fromkeys(data["total_friction"].dims, 0))
    if not math.isfinite(float(point.get(SAMPLING_FREEDOM, math.nan))):
        return None
    sources = [*map(str, point.source.values), *_factor_errors(point, "friction")]
    listed = ["", *(name for name in sources if name in MEASUREMENTS)]
    widths = {of: [_width(point, of, name) for name in listed] for of in CARRIED_QUANTITIES}
    order = np.argsort([0.0, *widths["friction"][1:]], kind="stable")  # without any comes first
    now = widths["friction"][0]
    texts = [MEASUREMENTS[name][0] if name else "none" for name in listed]
    low, high = frequencies_of((abs(point[LOSS]) + abs(point[STORAGE])).fillna(0.0), 0.9)
    band = f"{low:.1g} to {high:.1g} rad/s"
    columns = [
        Column("measurement", [texts[i].format(band) for i in order]),
        *(
            Column(f"{of}_width", [width[i] for i in order], f"± of {SYMBOLS[of]}", format=percent)
            for of, width in widths.items()
        ),
        Column("takes", [1.0 - widths["friction"][i] / now for i in order], format="{:.0%}".format),
    ]
    notes = ["Half widths of the 90 % interval with the errors of the inputs, by first order."]
    return Table("next", columns, "What to measure next", notes, keys=1)


def _width(point: xr.Dataset, quantity: str, measured: str) -> float:
    """Return the half width of an interval once a source is measured again [-]."""
    carried = point[CARRIED.format(quantity)].fillna(0.0).values
    sigmas = dict(zip(map(str, point.source.values), carried, strict=True))
    errors = []
    for name, sigma in (sigmas | _factor_errors(point, quantity)).items():
        share = MEASUREMENTS[name][1] if name == measured else 1.0
        road = float(point[SAMPLING_FREEDOM]) / share**2 if name == ROAD else math.inf
        errors.append(LogError(xr.DataArray(share * sigma), xr.DataArray(road)))
    return float(half_width(combined(errors)))


def _factor_errors(point: xr.Dataset, quantity: str) -> dict[str, float]:
    """Return the relative standard errors of the factors of the answer, by label."""
    area, pressed = point["total_contact_fraction"].values, point[PRESSURE_OVER_MODULUS].values
    errors = {LARGE_STRAIN_LABEL: float(finite_over_small(quantity, pressed, area)[1])}
    line = line_to_map.LineUnderLoad(*(point[name].values for name in LINE_UNDER_LOAD))
    if math.isfinite(float(line.upper_height)):  # lines
        law = line_to_map.SURFACE_OVER_LINES[quantity]
        errors[LINES_TO_SURFACE] = float(law(line, area).uncertainty)
    if point.attrs.get("softens"):
        errors["strain rule"] = {"contact_fraction": LOG_AREA, "friction": LOG_FRICTION}[quantity]
    if f"{quantity}_condition_error" in point:
        changes = zip(point.condition.values, point[f"{quantity}_condition_error"], strict=True)
        errors |= {str(label): abs(float(change)) for label, change in changes}
    return errors


def frequencies_of(effect: xr.DataArray, share: float) -> Array:
    """Return the frequencies between which a share of an effect lies, in its middle [rad/s]."""
    within = (np.cumsum(effect.values) - 0.5 * effect.values) / effect.values.sum()
    ends = np.interp([0.5 - 0.5 * share, 0.5 + 0.5 * share], within, np.log(effect.frequency))
    return np.asarray(np.exp(ends))
