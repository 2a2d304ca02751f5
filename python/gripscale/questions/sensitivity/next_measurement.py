"""What to measure next: how much of the interval of the answer each measurement would take.

The interval is that of the answer with the errors of its inputs by first order. A measurement
leaves a share of the standard error of one source: another of the same kind 1/sqrt(2), one that
decides it nothing.
"""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from gripscale.io.table import Column, Table, percent
from gripscale.model import SAMPLING_FREEDOM
from gripscale.questions.answer.best_estimate import LINES_TO_SURFACE, with_best_estimate
from gripscale.questions.answer.intervals import LogError, combined, half_width
from gripscale.questions.sensitivity.friction_sensitivity import CARRIED, LOSS, STORAGE
from gripscale.questions.uncertainty.first_order import CARRIED_QUANTITIES
from gripscale.questions.uncertainty.sampled_answer import ROAD
from gripscale.questions.words import SYMBOLS

AGAIN = 1.0 / math.sqrt(2.0)
"""Share of a standard error that an equal, independent measurement leaves."""
MEASUREMENTS = {
    ROAD: ("as much of the road once more", AGAIN),
    "modulus": ("moduli once more, {}", AGAIN),
    "cut_off": ("a finer profile, to where the roughness ends", 0.0),
    "cleaning": ("the profiles once more: spikes do not repeat", 0.0),
    "height_noise": ("each profile twice, averaged", AGAIN**2),
    "bulk_modulus": ("bulk modulus of the compound", 0.0),
    "equilibrium_modulus": ("relaxation, to the equilibrium modulus", 0.0),
    "temperature": ("temperature of the rubber, twice", AGAIN),
    "pressure": ("nominal pressure, twice", AGAIN),
    LINES_TO_SURFACE: ("a map in place of lines; it shows a direction, too", 0.0),
}
"""What measures each source, and the share of its standard error that it leaves. Noise of heights
counts by its square."""


def next_measurements(data: xr.Dataset) -> Table | None:
    """Return measurements by how much of the interval of the friction they would take.

    `data` is a result of `gripscale.sensitivity` at one point; None without an interval.
    """
    best = with_best_estimate(data.assign_attrs(nominal_speed=math.nan))
    if not np.isfinite(best.get("best_friction_sampling_error", np.nan)).all():
        return None
    point = best.isel(dict.fromkeys(data["total_friction"].dims, 0))
    listed = ["", *(name for name in _names(point) if name in MEASUREMENTS)]
    widths = {of: [_width(point, of, name) for name in listed] for of in CARRIED_QUANTITIES}
    order = np.argsort([0.0, *widths["friction"][1:]], kind="stable")  # without any comes first
    now = widths["friction"][0]
    texts = [MEASUREMENTS[name][0] if name else "none" for name in listed]
    columns = [
        Column("measurement", [texts[i].format(_frequencies(point)) for i in order]),
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
    factors = point[f"best_{quantity}_factor_uncertainty"].fillna(0.0).values
    sigmas = point[CARRIED.format(quantity)].fillna(0.0).values
    errors = []
    for name, sigma in zip(_names(point), [*sigmas, *factors], strict=True):
        share = MEASUREMENTS[name][1] if name == measured else 1.0
        road = float(point[SAMPLING_FREEDOM]) / share**2 if name == ROAD else math.inf
        errors.append(LogError(xr.DataArray(share * sigma), xr.DataArray(road)))
    return float(half_width(combined(errors)))


def _names(point: xr.Dataset) -> list[str]:
    """Return the names of sources and the labels of factors."""
    return [*map(str, point.source.values), *map(str, point.factor_label.values)]


def _frequencies(point: xr.Dataset) -> str:
    """Return where nine tenths of the effect of the moduli lie."""
    effect = (abs(point[LOSS]) + abs(point[STORAGE])).fillna(0.0).values
    within = (np.cumsum(effect) - 0.5 * effect) / effect.sum()
    low, high = np.exp(np.interp([0.05, 0.95], within, np.log(point.frequency.values)))
    return f"{low:.1g} to {high:.1g} rad/s"
