"""What a design stores: today's compound and each point of the curve, as labelled Datasets."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core import provenance
from gripscale.core.arrays import Array
from gripscale.core.units import ZERO_CELSIUS
from gripscale.experiment.design import variable_attributes
from gripscale.half_space.result import RoughContact
from gripscale.questions.design.compound_limits import (
    AdmissibleChanges,
    PointLimit,
    changed,
    modulus_parts,
    rubber_at,
)
from gripscale.questions.design.compound_search import (
    FREQUENCY,
    LARGEST_FACTOR,
    PER_DECADE,
    ROLLING_LEVEL,
    DesignProblem,
)
from gripscale.rubber import Rubber

WET = PointLimit("loss_factor", 0.0, 1.0, FREQUENCY, ZERO_CELSIUS)
"""The loss factor that is the rule of thumb for wet grip."""
FREQUENCIES_PER_DECADE = 8
"""Frequencies of a stored master curve in a decade."""


def scalars(values: Mapping[str, tuple[float, str]]) -> xr.Dataset:
    """Return numbers with what they are as variables without a dimension."""
    return xr.Dataset(
        {name: ((), value, variable_attributes(text)) for name, (value, text) in values.items()}
    )


def of_change(admissible: AdmissibleChanges, ratio: Array) -> dict[str, Any]:
    """Return the change of each modulus, and of what is limited at a point of frequency."""
    points = admissible.points[:-1]  # the last is the rolling condition
    values = []
    for point in points:
        today, design = (
            _point_value(point, rubber)
            for rubber in (admissible.rubber, changed(admissible.rubber, ratio))
        )
        values.append(design / today)
    return {
        "modulus_ratio": ("term", ratio, variable_attributes("modulus over today's, E_inf first")),
        "limited_ratio": (
            "limit",
            np.array(values),
            variable_attributes("limited modulus over today's"),
        ),
    }


def _point_value(point: PointLimit, rubber: Rubber) -> float:
    body, omega = rubber_at(rubber, point.temperature), 2.0 * math.pi * point.frequency
    modulus = complex(body.complex_modulus(omega))
    return modulus.real if point.quantity == "storage_modulus" else modulus.imag / modulus.real


def of_compound(
    problem: DesignProblem, rubber: Rubber, contacts: Sequence[RoughContact]
) -> dict[str, Any]:
    """Return friction and contact at the goals, moduli and master curve of a compound."""
    friction = problem.friction
    omega = 2.0 * math.pi * _frequencies(problem.rubber)
    storage, loss = (parts.sum(axis=-1) for parts in modulus_parts(rubber, omega))
    moduli = np.concatenate([[rubber.equilibrium_modulus], rubber.moduli])
    lost, traction, area = (
        friction.averaged([getattr(contact, name) for contact in contacts])
        for name in ("friction_from_dissipation", "friction", "contact_fraction")
    )
    wet = math.nan
    if rubber.shift is not None:
        body = rubber_at(rubber, WET.within_shift(rubber).temperature)
        wet = float(body.loss_factor(2.0 * math.pi * WET.frequency))
    rolling = problem.rolling_loss_factor(rubber)
    return {
        "friction": (
            "goal",
            lost,
            variable_attributes("friction coefficient from the energy lost"),
        ),
        "friction_from_traction": (
            "goal",
            traction,
            variable_attributes("the same from the traction"),
        ),
        "contact_fraction": ("goal", area, variable_attributes("real over nominal contact area")),
        "modulus": (
            "term",
            moduli,
            variable_attributes("E_inf, and moduli of the Prony series", "Pa"),
        ),
        "storage": ("frequency", storage, variable_attributes("storage modulus", "Pa")),
        "loss": ("frequency", loss, variable_attributes("loss modulus", "Pa")),
        "rolling_loss_factor": (
            (),
            rolling,
            variable_attributes("tan(delta) at the rolling condition"),
        ),
        "wet_loss_factor": ((), wet, variable_attributes("tan(delta) of the rule for wet grip")),
    }


def _frequencies(rubber: Rubber) -> Array:
    """Return the frequencies of a stored master curve [Hz]: its measured band, or its times."""
    times = rubber.relaxation_times
    low, high = rubber.valid_band or (0.1 / times.max(initial=1.0), 10.0 / times.min(initial=1.0))
    count = max(2, math.ceil(FREQUENCIES_PER_DECADE * math.log10(high / low)) + 1)
    return np.asarray(np.geomspace(low, high, count) / (2.0 * math.pi))


def today(problem: DesignProblem, contacts: Sequence[RoughContact], tolerance: float) -> xr.Dataset:
    """Return today's compound, goals and limits: what no point changes."""
    friction, rubber = problem.friction, problem.rubber
    data = {
        f"today_{name}": values for name, values in of_compound(problem, rubber, contacts).items()
    }
    excited = [_excited(contact) for contact in contacts]
    times = np.concatenate([[math.inf], rubber.relaxation_times])
    goals = [str(goal) for goal in friction.goals]
    limits = [str(point) for point in problem.admissible().points[:-1]]
    widened = [LARGEST_FACTOR, PER_DECADE, *limits, ROLLING_LEVEL]
    data |= {
        "excited_low": (
            (),
            min(low for low, _ in excited),
            variable_attributes("excited from", "Hz"),
        ),
        "excited_high": ((), max(high for _, high in excited), variable_attributes("up to", "Hz")),
        "goal_weight": ("goal", friction.weights, variable_attributes("weight of the goal")),
    }
    coordinates = {
        "goal": ("goal", np.array(goals, dtype=object)),
        "limit": ("limit", np.array(limits, dtype=object)),
        "widened": ("widened", np.array(widened, dtype=object)),
        "relaxation_time": ("term", times, variable_attributes("relaxation time", "s")),
        "frequency": ("frequency", _frequencies(rubber), variable_attributes("frequency", "Hz")),
    }
    kelvin = rubber.reference_temperature
    about = {
        "title": "Design of a compound: friction against rolling resistance",
        "rubber": f"{rubber.name}; {rubber.source}".strip("; "),
        "rolling_condition": problem.rolling.condition,
        "wet_condition": "" if rubber.shift is None else WET.within_shift(rubber).condition,
        "reference_temperature": math.nan if kelvin is None else kelvin,
        "largest_factor": problem.limits.largest_factor,
        "factor_per_decade": problem.limits.factor_per_decade,
        "tolerance": tolerance,
        **provenance.version_attributes(),
    }
    return xr.Dataset(data, coordinates, about)


EXCITED = 0.01
"""Share of the friction below and above the frequencies that count as excited."""


def _excited(contact: RoughContact) -> tuple[float, float]:
    """Return the frequencies between which a contact loses 98 % of its energy [Hz]."""
    lost = np.maximum(contact.lost_by_harmonic(), 0.0)
    omega = np.broadcast_to(np.abs(contact.grid.along) * contact.speed, lost.shape)
    order = np.argsort(omega, axis=None)
    share = np.cumsum(lost.reshape(-1)[order]) / lost.sum()
    ends = np.searchsorted(share, [EXCITED, 1.0 - EXCITED])
    low, high = omega.reshape(-1)[order][ends] / (2.0 * math.pi)
    return float(low), float(high)
