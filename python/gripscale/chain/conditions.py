"""The chain under conditions that depend on its solution: softening by strain, and friction heat.

An evaluation of the fixed point (`gripscale.conditions.fixed_point`) solves all waves with the
rubber that a temperature and a strain of each make of it, which gives new ones.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np

from gripscale.chain.heat import Warming, WaveHeat, strains, warming
from gripscale.chain.prediction import ChainResult, ChainSolve
from gripscale.conditions.conditions import SLOPE_FACTOR, Conditions, RubberState, rubber_under
from gripscale.conditions.fixed_point import Iteration, pack_state, solve_fixed_point, unpack_state
from gripscale.core import Array, Status
from gripscale.rubber import Rubber
from gripscale.wave.kernel import RefinableSolver
from gripscale.wave.problem import Sine


def solve_coupled_chain(solver: ChainSolve, rubber: Rubber, conditions: Conditions) -> ChainResult:
    """Return the prediction whose strains and temperatures, among its details, are of its rubber.

    Newton iterations are those of all evaluations. The status of the last wave is `conditions not
    settled` if the iteration did not converge.
    """
    before = conditions.before(rubber)
    fine, quick = _ChainEvaluation(solver, before, conditions), None
    if isinstance(solver.solver, RefinableSolver):
        coarse = replace(solver, solver=solver.solver.coarser(), on_scale=None)
        quick = replace(fine, solver=coarse)
    fixed_point = solve_fixed_point(fine, quick)
    solved, x = fixed_point.last.solution, fixed_point.last.x
    assert x is not None
    state = WaveStates(conditions, rubber, *unpack_state(x))
    rises = None if conditions.heat is None else chain_warming(conditions, solved)
    scales = []
    passes = {"passes": fixed_point.fine, "coarse_passes": fixed_point.coarse}
    for number, wave in enumerate(solved.scales):
        details = {**wave.details, **passes}
        if "load_steps" in wave.details:
            details["load_steps"] = fine.load_steps[number]
        rise = None if rises is None else rises[number]
        details |= state.details(number, wave.angular_frequency, rise)
        iterations = fine.newton_iterations[number]
        scales.append(replace(wave, newton_iterations=iterations, details=details))
    if not fixed_point.converged:
        scales[-1] = replace(scales[-1], status=Status.CONDITIONS_NOT_SETTLED)
    return replace(solved, scales=scales)


@dataclass(frozen=True)
class WaveStates:
    """Temperature rise [K] and strain [-] of each wave, and the rubber they make."""

    conditions: Conditions
    rubber: Rubber
    warming: Array
    strain: Array

    def at(self, number: int, omega: float) -> RubberState:
        """Return the rubber on wave `number`, from 0, at its angular frequency [rad/s]."""
        return rubber_under(
            self.conditions,
            self.rubber,
            warming=float(self.warming[number]),
            strain=float(self.strain[number]),
            omega=omega,
        )

    def __call__(self, wave: Sine, so_far: ChainResult) -> Rubber:
        """Return the rubber on `wave`, next after those of `so_far`."""
        omega = 2.0 * math.pi * so_far.load.speed / wave.wavelength
        return self.at(len(so_far.scales), omega).rubber

    def details(self, number: int, omega: float, rise: Warming | None) -> dict[str, float]:
        """Return what the results of a wave hold about its strain and temperature."""
        state, out = self.at(number, omega), dict[str, float]()
        if self.conditions.softening is not None:
            out |= {
                "strain": self.strain[number],
                "storage_modulus_ratio": state.storage_modulus_ratio,
                "loss_modulus_ratio": state.loss_modulus_ratio,
                "series_misfit": state.series_misfit,
                "strain_extrapolated": float(state.strain_extrapolated),
            }
        kelvin = self.conditions.temperature_of(self.rubber)
        if rise is not None and kelvin is not None:
            out |= {
                "temperature": kelvin + self.warming[number],
                "flash_temperature_rise_uniform": rise.uniform,
                "flash_temperature_rise_larger_waves": rise.larger_waves,
                "flash_temperature_rise_own": rise.own_pattern,
                "contact_temperature": kelvin + rise.contact,
                "temperature_extrapolated": float(state.temperature_extrapolated),
            }
        return out


@dataclass(frozen=True)
class _ChainEvaluation:
    """Evaluates a state: solves all waves with the rubber it makes, and counts the work."""

    solver: ChainSolve
    rubber: Rubber
    conditions: Conditions
    # Of each wave in all evaluations, on the coarse mesh too.
    newton_iterations: Counter[int] = field(default_factory=Counter)
    load_steps: Counter[int] = field(default_factory=Counter)

    def __call__(self, x: Array | None, last: ChainResult | None) -> Iteration[ChainResult]:
        """Return the evaluation of `x`; without it waves in full contact soften the cold rubber."""
        start = last if isinstance(self.solver.solver, RefinableSolver) else None
        if x is None and self.conditions.softening is not None:
            slopes = [2.0 * math.pi * w.amplitude / w.wavelength for w in self.solver.waves]
            strain = SLOPE_FACTOR * np.sqrt(0.5 * np.cumsum(np.square(slopes)))
            x = pack_state(np.zeros_like(strain), strain)
        if x is None:
            before = self.conditions.before(self.rubber)
            solved = self.solver(lambda wave, so_far: before, start)
        else:
            states = WaveStates(self.conditions, self.rubber, *unpack_state(x))
            solved = self.solver(states, start)
        for number, wave in enumerate(solved.scales):
            self.newton_iterations[number] += wave.newton_iterations
            self.load_steps[number] += int(wave.details.get("load_steps", 0))
        rise, strain = np.zeros(len(solved.scales)), np.ones(len(solved.scales))
        if self.conditions.heat is not None:
            rise = np.array([wave.total for wave in chain_warming(self.conditions, solved)])
        if self.conditions.softening is not None:
            strain = strains(solved.scales, self.conditions.strain_norm)
        friction = [solved.friction] if solved.load.speed > 0.0 else []  # none at rest
        return Iteration(solved, x, pack_state(rise, strain), [solved.contact_fraction, *friction])


def chain_warming(conditions: Conditions, solved: ChainResult) -> list[Warming]:
    """Return the temperature rise of the rubber on each wave of a solved chain."""
    heats = [WaveHeat.of(wave, wave.rubber or solved.rubber) for wave in solved.scales]
    load, kelvin = solved.load, conditions.temperature_of(solved.rubber)
    conditions = conditions.warming
    time = load.footprint / load.speed if load.speed > 0.0 else 0.0

    def friction_at(rise: float) -> float:
        warm, contact = None if kelvin is None else kelvin + rise, solved.contact_fraction
        return conditions.adhesive_friction(contact, load.pressure, load.speed, warm)

    return warming(heats, conditions, friction_at, speed=load.speed, time=time)
