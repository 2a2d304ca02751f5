"""Which measurement would take how much of the interval of an answer, from its parts.

A measurement leaves a share of the standard error of one part: another of the same kind 1/sqrt(2),
one that decides a question nothing. What remains of the parts adds up in squares.
"""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from gripscale.conditions.conditions import TENSION_OR_SHEAR, THERMAL_CONSTANTS, TREADS
from gripscale.core.arrays import Array
from gripscale.io.table import Column, Table, percent
from gripscale.questions.answer.estimate import LINES_TO_SURFACE
from gripscale.questions.answer.variables import SYMBOLS, of_hysteresis
from gripscale.questions.uncertainty.sources import SOURCES

# Share of a standard error that an equal, independent measurement leaves.
AGAIN = 1.0 / math.sqrt(2.0)
# What measures each source or factor, and the share of its standard error that it leaves. Noise of
# heights counts by its square.
_OF_SOURCES = {
    "profile": ("as much of the surface once more", AGAIN),
    "modulus": ("moduli once more", AGAIN),
    "cut_off": ("a finer profile, to where the roughness ends", 0.0),
    "cleaning": ("the profiles once more: spikes do not repeat", 0.0),
    "height_noise": ("each profile twice, averaged", AGAIN**2),
    "bulk_modulus": ("bulk modulus of the compound", 0.0),
    "equilibrium_modulus": ("relaxation, to the equilibrium modulus", 0.0),
    "temperature": ("temperature of the rubber, twice", AGAIN),
    "pressure": ("nominal pressure, twice", AGAIN),
}
_OF_FACTORS = {
    LINES_TO_SURFACE: "a map in place of lines; it shows a direction, too",
    TREADS: "strain sweeps of the compound",
    TENSION_OR_SHEAR: "whether the strain sweeps are in tension or in shear",
    THERMAL_CONSTANTS: "conductivity and heat capacity of the compound",
}
MEASUREMENTS = {SOURCES[name].label: each for name, each in _OF_SOURCES.items()}
MEASUREMENTS |= {f"factor: {label}": (text, 0.0) for label, text in _OF_FACTORS.items()}


def next_measurements(answer: xr.Dataset) -> Table | None:
    """Return measurements by how much of the interval of the friction they would take.

    `answer` is a result of `gripscale.uncertainty` at one load and in motion. None where the parts
    of its interval are not known by source.
    """
    labels = answer.part_label.values.tolist()
    if not {SOURCES[name].label for name in _OF_SOURCES} & set(labels):
        return None
    listed = [at for at, label in enumerate(labels) if label in MEASUREMENTS]
    texts, shares = zip(*(MEASUREMENTS[labels[at]] for at in listed), strict=True)
    both = ("friction", "contact_fraction")
    widths = {name: _widths(answer, name, listed, np.array(shares)) for name in both}
    order = np.argsort(widths["friction"][1:], kind="stable")
    columns = [Column("measurement", ["none", *(texts[k] for k in order)])]
    for name, width in widths.items():
        ranked = [width[0], *width[1:][order]]
        columns.append(Column(f"{name}_width", ranked, f"± of {SYMBOLS[name]}", format=percent))
    takes = 1.0 - widths["friction"][1:][order] / widths["friction"][0]
    columns.append(Column("takes", [0.0, *takes], format="{:.0%}".format))
    notes = ["Half widths of the 90 % interval."]
    return Table("next", columns, "What to measure next", notes, keys=1)


def _widths(answer: xr.Dataset, name: str, listed: list[int], share: Array) -> Array:
    """Return half widths of an interval [-]: as it is, and once each listed part is measured."""
    sigma = answer[f"answer_{name}_part_error"].fillna(0.0).values[listed]
    number = f"answer_{of_hysteresis(answer, name)}"
    total = float(answer[f"{number}_uncertainty"])
    rest = np.sqrt(np.maximum(1.0 - (1.0 - share**2) * (sigma / total) ** 2, 0.0))
    log_width = math.asinh(float(answer[f"{number}_half_width"]))
    return np.asarray(np.sinh(log_width * np.append(1.0, rest)))
