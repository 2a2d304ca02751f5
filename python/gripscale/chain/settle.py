"""The chain under conditions that depend on what is solved: passes until nothing changes.

Every pass solves all waves with the rubber that strains and heat of the passes before make of it
(`gripscale.conditions.fixed_point`), first on coarse meshes, where a pass costs little, then on the
meshes asked for, each from the solutions of the last.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from gripscale.chain.prediction import Prediction
from gripscale.chain.rubber_at import RubberAt
from gripscale.conditions.chain_heat import Warming, warming
from gripscale.conditions.conditions import Conditions, RubberState, rubber_under
from gripscale.conditions.fixed_point import MOST_PASSES, FixedPoint
from gripscale.conditions.mixing import mixed, separate
from gripscale.conditions.wave_heat import WaveHeat
from gripscale.conditions.wave_strain import strains
from gripscale.rubber import Rubber
from gripscale.wave.problem import Sine
from gripscale.wave.status import Status

Array = NDArray[np.float64]


class Walk(Protocol):
    """Solves all waves of a chain."""

    def __call__(self, rubber_at: RubberAt | None, start: Prediction | None) -> Prediction:
        """Return the prediction with the rubber of each wave, each from its wave of `start`."""

    def coarser(self) -> Walk | None:
        """Return the same in a fraction of the time, if there is such a way."""

    @property
    def warm(self) -> bool:
        """Whether a wave can be started from its last solution."""


@dataclass(frozen=True)
class _OfLastPass:
    """The rubber of each wave, from what the last pass found there."""

    conditions: Conditions
    rubber: Rubber
    warming: Array
    strain: Array

    def state(self, number: int, omega: float) -> RubberState:
        """Return the rubber on wave `number`, from 0."""
        return rubber_under(
            self.conditions,
            self.rubber,
            warming=float(self.warming[number]),
            strain=float(self.strain[number]),
            omega=omega,
        )

    def __call__(self, wave: Sine, so_far: Prediction) -> Rubber:
        """Return the rubber as it is on `wave`."""
        omega = 2.0 * math.pi * so_far.load.speed / wave.wavelength
        return self.state(len(so_far.scales), omega).rubber


def settle(walk: Walk, rubber: Rubber, conditions: Conditions) -> Prediction:
    """Return the prediction in which rubber, strains and heat agree.

    Parameters
    ----------
    walk
        Solves all waves.
    rubber
        As measured.
    conditions
        What changes it.

    Returns
    -------
    Prediction
        With strain, temperature and what is left of the moduli in the details of each wave. The
        status of the last is `conditions not settled` if passes still changed the result.
    """
    before, coarse = conditions.before(rubber), walk.coarser()
    first = (coarse or walk)(lambda wave, so_far: before, None)
    point = FixedPoint(_found(conditions, first))
    if coarse is None:
        return _passes(walk, rubber, conditions, point, first)
    _passes(coarse, rubber, conditions, point, first)
    return _passes(walk, rubber, conditions, point.anew(), None)


def _passes(
    walk: Walk,
    rubber: Rubber,
    conditions: Conditions,
    point: FixedPoint,
    last: Prediction | None,
) -> Prediction:
    """Return the prediction after passes from `point`, which is moved."""
    for number in range(1, MOST_PASSES + 1):
        given = _OfLastPass(conditions, rubber, *separate(point.assumed))
        now = walk(given, last if walk.warm else None)
        point.found(_found(conditions, now))
        settled = point.settled(_results(now), None if last is None else _results(last))
        if settled or number == MOST_PASSES:
            return _told(now, given, number, settled=settled)
        last = now
    raise AssertionError("unreachable")


def _found(conditions: Conditions, solved: Prediction) -> Array:
    """Return temperatures and strains of the waves of a solved chain, mixed."""
    warm, strain = np.zeros(len(solved.scales)), np.ones(len(solved.scales))
    if conditions.heat is not None:
        warm = np.array([one.total for one in chain_warming(conditions, solved)])
    if conditions.softening is not None:
        strain = np.array(strains(solved.scales, conditions.strain_norm))
    return mixed(warm, strain)


def chain_warming(conditions: Conditions, solved: Prediction) -> list[Warming]:
    """Return how much warmer the rubber is on each wave of a solved chain."""
    assert conditions.heat is not None
    heats = [WaveHeat.of(wave, wave.rubber or solved.rubber) for wave in solved.scales]
    speed = solved.load.speed
    time = solved.load.footprint / speed if speed > 0.0 else 0.0
    return warming(heats, speed=speed, time=time, thermal=conditions.heat)


def _results(now: Prediction) -> list[float]:
    """Return what must not change any more: friction only where it slides."""
    return [now.contact_fraction, *([now.friction] if now.load.speed > 0.0 else [])]


def _told(solved: Prediction, given: _OfLastPass, passes: int, *, settled: bool) -> Prediction:
    """Return `solved` with what became of the rubber in the details of its waves."""
    conditions = given.conditions
    warm = chain_warming(conditions, solved) if conditions.heat is not None else None
    kelvin = conditions.temperature_of(given.rubber)
    scales = []
    for number, wave in enumerate(solved.scales):
        state = given.state(number, wave.angular_frequency)
        told: dict[str, float] = {"passes": passes}
        if conditions.softening is not None:
            told |= {
                "strain": given.strain[number],
                "storage_factor": state.storage_factor,
                "loss_factor_left": state.loss_factor,
                "series_misfit": state.series_misfit,
                "beyond_sweep": float(state.beyond_sweep),
            }
        if warm is not None and kelvin is not None:
            own = warm[number]
            told |= {
                "temperature": kelvin + given.warming[number],
                "warming_uniform": own.uniform,
                "warming_larger_waves": own.larger_waves,
                "warming_own": own.own,
                "contact_temperature": kelvin + own.contact,
                "beyond_shift": float(state.beyond_shift),
            }
        scales.append(replace(wave, details={**wave.details, **told}))
    if not settled:
        scales[-1] = replace(scales[-1], status=Status.CONDITIONS_NOT_SETTLED)
    return replace(solved, scales=scales)
