"""What a design stores: today's compound and each point of the curve, as labelled Datasets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core import ZERO_CELSIUS, Array, provenance
from gripscale.experiment.design import variable_attributes
from gripscale.half_space.result import RoughContact
from gripscale.questions.design.compound_limits import (
    AdmissibleChanges,
    PointLimit,
    changed,
    modulus_parts,
)
from gripscale.questions.design.compound_search import (
    LARGEST_FACTOR,
    PER_DECADE,
    ROLLING_LEVEL,
    DesignProblem,
)
from gripscale.questions.design.rolling import band_in_words
from gripscale.rubber import Rubber

# The loss factor that is the rule of thumb for wet grip.
WET = PointLimit("loss_factor", 0.0, 1.0, 10.0, ZERO_CELSIUS)
FREQUENCIES_PER_DECADE = 8  # frequencies of a stored master curve in a decade


def variable(
    values: Any, text: str, unit: str = "1", dim: str = ""
) -> tuple[tuple[str, ...], Any, dict[str, str]]:
    """Return a variable over `dim`, or without a dimension, as xarray takes it."""
    return (dim,) if dim else (), values, variable_attributes(text, unit)


def of_change(admissible: AdmissibleChanges, ratio: Array) -> dict[str, Any]:
    """Return the change of each modulus, and of what is limited at a point of frequency."""
    today, design = admissible.rubber, changed(admissible.rubber, ratio)
    limited = np.array([point.value(design) / point.value(today) for point in admissible.points])
    return {
        "modulus_ratio": variable(ratio, "modulus over today's, E_inf first", dim="term"),
        "limited_ratio": variable(limited, "limited modulus over today's", dim="limit"),
    }


def of_compound(
    problem: DesignProblem, rubber: Rubber, contacts: Sequence[RoughContact]
) -> dict[str, Any]:
    """Return friction and contact at the goals, moduli and master curve of a compound."""
    omega = 2.0 * math.pi * _frequencies(problem.rubber)
    storage, loss = (parts.sum(axis=-1) for parts in modulus_parts(rubber, omega))
    moduli = np.concatenate([[rubber.equilibrium_modulus], rubber.moduli])
    lost, traction, area = (
        problem.friction.averaged([getattr(contact, name) for contact in contacts])
        for name in ("friction_from_dissipation", "friction", "contact_fraction")
    )
    rolling = problem.rolling[0].value(rubber)
    wet = math.nan if rubber.shift is None else WET.within_shift(rubber).value(rubber)
    text = "E_inf, and moduli of the Prony series"
    return {
        "friction": variable(lost, "friction coefficient from the energy lost", dim="goal"),
        "friction_from_traction": variable(traction, "the same from the traction", dim="goal"),
        "contact_fraction": variable(area, "real over nominal contact area", dim="goal"),
        "modulus": variable(moduli, text, "Pa", "term"),
        "storage": variable(storage, "storage modulus", "Pa", "frequency"),
        "loss": variable(loss, "loss modulus", "Pa", "frequency"),
        "rolling_loss_factor": variable(rolling, "tan(delta) at the first rolling condition"),
        "wet_loss_factor": variable(wet, "tan(delta) of the rule for wet grip"),
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
    low, high = zip(*map(_excited, contacts), strict=True)
    times = np.concatenate([[math.inf], rubber.relaxation_times])
    goals = [str(goal) for goal in friction.goals]
    limits = [str(point) for point in problem.admissible().points]
    widened = [LARGEST_FACTOR, PER_DECADE, *limits, ROLLING_LEVEL]
    data |= {
        "excited_low": variable(min(low), "excited from", "Hz"),
        "excited_high": variable(max(high), "up to", "Hz"),
        "goal_weight": variable(friction.weights, "weight of the goal", dim="goal"),
    }
    names = {"goal": goals, "limit": limits, "widened": widened}
    coordinates = {
        **{dim: (dim, np.array(texts, dtype=object)) for dim, texts in names.items()},
        "relaxation_time": variable(times, "relaxation time", "s", "term"),
        "frequency": variable(_frequencies(rubber), "frequency", "Hz", "frequency"),
    }
    kelvin = rubber.reference_temperature
    about = {
        "title": "Design of a compound: friction against rolling resistance",
        "rubber": f"{rubber.name}; {rubber.source}".strip("; "),
        "rolling_condition": problem.rolling[0].condition,
        "rolling_band": band_in_words(problem.rolling),
        "wet_condition": "" if rubber.shift is None else WET.within_shift(rubber).condition,
        "reference_temperature": math.nan if kelvin is None else kelvin,
        "largest_factor": problem.limits.largest_factor,
        "factor_per_decade": problem.limits.factor_per_decade,
        "tolerance": tolerance,
        **provenance.version_attributes(),
    }
    return xr.Dataset(data, coordinates, about)


EXCITED = 0.01  # share of the friction below and above the frequencies that count as excited


def _excited(contact: RoughContact) -> tuple[float, float]:
    """Return the frequencies between which a contact loses 98 % of its energy [Hz]."""
    lost = np.maximum(contact.lost_by_harmonic(), 0.0)
    omega = np.broadcast_to(np.abs(contact.grid.along) * contact.speed, lost.shape)
    order = np.argsort(omega, axis=None)
    share = np.cumsum(lost.reshape(-1)[order]) / lost.sum()
    ends = np.searchsorted(share, [EXCITED, 1.0 - EXCITED])
    low, high = omega.reshape(-1)[order][ends] / (2.0 * math.pi)
    return float(low), float(high)
