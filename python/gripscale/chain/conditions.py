"""The chain under conditions that depend on what is solved: passes until nothing changes.

Every pass solves all waves with the rubber that assumed strains and temperatures make of it, most
of them on coarse meshes (`gripscale.conditions.fixed_point`), each from the solutions of the last.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from gripscale.chain.heat import Warming, WaveHeat, strains, warming
from gripscale.chain.prediction import Prediction, RubberAt
from gripscale.conditions.conditions import Conditions, RubberState, rubber_under
from gripscale.conditions.fixed_point import Iteration, Passes, mixed, separate
from gripscale.conditions.fixed_point import solve_coupled as settle_passes
from gripscale.rubber import Rubber
from gripscale.wave.problem import Sine, Status

Array = NDArray[np.float64]


class ChainSolver(Protocol):
    """Solves all waves of a chain."""

    def __call__(self, rubber_at: RubberAt | None, start: Prediction | None) -> Prediction:
        """Return the prediction with the rubber of each wave, each from its wave of `start`."""

    def coarser(self) -> ChainSolver | None:
        """Return the same in a fraction of the time, if there is such a way."""

    @property
    def warm(self) -> bool:
        """Whether a wave can be started from its last solution."""


@dataclass(frozen=True)
class _Assumed:
    """The rubber of each wave, from the temperature and strain assumed there."""

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

    def told(self, number: int, omega: float) -> dict[str, float]:
        """Return strain and what it leaves of the moduli of wave `number`."""
        if self.conditions.softening is None:
            return {}
        state = self.state(number, omega)
        return {
            "strain": self.strain[number],
            "storage_factor": state.storage_factor,
            "loss_factor_left": state.loss_factor,
            "series_misfit": state.series_misfit,
            "beyond_sweep": float(state.beyond_sweep),
        }

    def heat_told(self, number: int, omega: float, own: Warming) -> dict[str, float]:
        """Return the temperature of wave `number` and where it comes from."""
        kelvin = self.conditions.temperature_of(self.rubber)
        assert kelvin is not None
        return {
            "temperature": kelvin + self.warming[number],
            "warming_uniform": own.uniform,
            "warming_larger_waves": own.larger_waves,
            "warming_own": own.own,
            "contact_temperature": kelvin + own.contact,
            "beyond_shift": float(self.state(number, omega).beyond_shift),
        }


def solve_coupled_chain(walk: ChainSolver, rubber: Rubber, conditions: Conditions) -> Prediction:
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
        With strain, temperature and what is left of the moduli in the details of each wave, and the
        Newton iterations of all passes. The status of the last wave is `conditions not settled` if
        passes still changed the result.
    """
    spent, coarse = _Spent(), walk.coarser()
    fine = _Waves(walk, rubber, conditions, spent)
    quick = None if coarse is None else _Waves(coarse, rubber, conditions, spent)
    return _told(settle_passes(fine, quick), fine)


def unsettled(so_far: Prediction) -> Prediction:
    """Return waves of a pass on the way as what they are: not to be used."""
    *others, last = so_far.scales
    if not last.converged:
        return so_far
    return replace(so_far, scales=[*others, replace(last, status=Status.CONDITIONS_NOT_SETTLED)])


class _Spent:
    """Newton iterations and load steps of each wave in all passes."""

    def __init__(self) -> None:
        self.iterations: Counter[int] = Counter()
        self.load_steps: Counter[int] = Counter()

    def add(self, solved: Prediction) -> None:
        """Count a pass."""
        for number, wave in enumerate(solved.scales):
            self.iterations[number] += wave.newton_iterations
            self.load_steps[number] += int(wave.details.get("load_steps", 0))


@dataclass(frozen=True)
class _Waves:
    """Solves all waves with the rubber that assumed temperatures and strains make."""

    walk: ChainSolver
    rubber: Rubber
    conditions: Conditions
    spent: _Spent

    def __call__(self, assumed: Array | None, last: Prediction | None) -> Iteration[Prediction]:
        """Return the pass for what is assumed, each wave from its last solution."""
        now = self.walk(self.rubber_at(assumed), last if self.walk.warm else None)
        self.spent.add(now)
        return Iteration(now, assumed, _found(self.conditions, now), _results(now))

    def rubber_at(self, assumed: Array | None) -> RubberAt:
        """Return the rubber of each wave; with nothing assumed as it is before the contact."""
        if assumed is None:
            before = self.conditions.before(self.rubber)
            return lambda wave, so_far: before
        return self.given(assumed)

    def given(self, assumed: Array) -> _Assumed:
        """Return the rubber of each wave."""
        return _Assumed(self.conditions, self.rubber, *separate(assumed))


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


def _told(passes: Passes[Prediction], waves: _Waves) -> Prediction:
    """Return the last pass with what became of the rubber in the details of its waves."""
    solved, conditions, spent = passes.last.solved, waves.conditions, waves.spent
    assert passes.last.assumed is not None
    given = waves.given(passes.last.assumed)
    warm = chain_warming(conditions, solved) if conditions.heat is not None else None
    scales = []
    for number, wave in enumerate(solved.scales):
        told: dict[str, float] = {"passes": passes.fine, "coarse_passes": passes.coarse}
        if "load_steps" in wave.details:
            told["load_steps"] = spent.load_steps[number]
        told |= given.told(number, wave.angular_frequency)
        if warm is not None:
            told |= given.heat_told(number, wave.angular_frequency, warm[number])
        scales.append(
            replace(
                wave,
                newton_iterations=spent.iterations[number],
                details={**wave.details, **told},
            )
        )
    if not passes.settled:
        scales[-1] = replace(scales[-1], status=Status.CONDITIONS_NOT_SETTLED)
    return replace(solved, scales=scales)
