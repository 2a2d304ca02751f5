"""Two hundred random waves of ten hard kinds, to hold stated errors against true ones.

A kind is a line of `KINDS`: its waves are drawn from the ranges that its name says.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import gripscale as gs
from gripscale import theory
from gripscale.wave import Sine, WaveLoad, WaveProblem
from tests.closed_forms import contact_fraction
from tests.verification.families import tread
from tests.verification.load_grid import MODULUS, SPEED, WAVELENGTH, mean_shear, power_law, rubber

Draw = Callable[[np.random.Generator], WaveProblem | None]


@dataclass(frozen=True)
class CoverageCase:
    """A wave of one kind."""

    number: int
    kind: str
    problem: WaveProblem

    @property
    def closed_form(self) -> bool:
        """Whether the small-strain models are its reference: its contact is tiny and shallow."""
        return self.kind in ("elastic tiny", "sliding tiny")


def cases(count: int = 200, seed: int = 19390601) -> list[CoverageCase]:
    """Return `count` random cases, the kinds taking turns, the same for the same `seed`."""
    generator = np.random.default_rng(seed)
    kinds = list(KINDS.items())
    return [_case(i, *kinds[i % len(kinds)], generator) for i in range(count)]


def _case(number: int, kind: str, draw: Draw, generator: np.random.Generator) -> CoverageCase:
    while True:
        problem = draw(generator)
        if problem is not None and (problem.load.speed == 0.0 or mean_shear(problem) < 1.0):
            return CoverageCase(number, kind, problem)


def _log(generator: np.random.Generator, least: float, most: float) -> float:
    return float(np.exp(generator.uniform(np.log(least), np.log(most))))


def _near_full(generator: np.random.Generator) -> float:
    """Return a pressure over that of full contact, three of four times below one."""
    sign = 1.0 if generator.random() < 0.25 else -1.0
    return 1.0 + sign * _log(generator, 3e-4, 0.2)


def _at_rest(slope: float, share: float) -> WaveProblem:
    """Return elastic contact at a share of the small-strain pressure of full contact."""
    solid = gs.Rubber(MODULUS, bulk_modulus=1e3 * MODULUS)
    return _wave(solid, slope, share * np.pi * MODULUS / 0.75 * slope, 0.0)


def _sliding(
    solid: gs.Rubber | None, slope: float, share: float, generator: np.random.Generator
) -> WaveProblem | None:
    """Return sliding at a share of the small-strain pressure of full contact."""
    passages = float(generator.choice([1.0, 3.0, 10.0, 100.0, np.inf]))
    if solid is None:
        return None
    full = share * np.pi * MODULUS / 0.75 * slope
    return _wave(solid, slope, full, SPEED, passages * WAVELENGTH / SPEED)


def _wave(
    solid: gs.Rubber, slope: float, pressure: float, speed: float, load_time: float = np.inf
) -> WaveProblem:
    return WaveProblem(
        solid, Sine(WAVELENGTH, slope * WAVELENGTH), WaveLoad(pressure, speed, load_time)
    )


def _share(generator: np.random.Generator, slope: float, least: float, most: float) -> float:
    """Return the share of full contact of a pressure between two shares of the modulus."""
    return _log(generator, least, most) * 0.75 / (np.pi * slope)


def _elastic_harsh(g: np.random.Generator) -> WaveProblem:
    slope = g.uniform(0.15, 0.35)
    return _at_rest(slope, _share(g, slope, 0.03, 1.0))


def _sliding_lossy(g: np.random.Generator) -> WaveProblem | None:
    slope = g.uniform(0.02, 0.25)
    loss, bulk = _log(g, 0.8, 1.6), _log(g, 50.0, 5000.0)
    return _sliding(power_law(loss, bulk, g), slope, _share(g, slope, 0.03, 0.5), g)


def _sliding_harsh(g: np.random.Generator) -> WaveProblem | None:
    slope = g.uniform(0.2, 0.35)
    solid = rubber(_log(g, 0.05, 1.0), _log(g, 50.0, 5000.0), g)
    return _sliding(solid, slope, _share(g, slope, 0.03, 1.0), g)


def _sliding_tiny(g: np.random.Generator) -> WaveProblem | None:
    solid = rubber(_log(g, 0.05, 1.0), 1e4, g)
    return _sliding(solid, 1e-3, _log(g, 1e-3, 0.03), g)


def _sliding_full(g: np.random.Generator) -> WaveProblem | None:
    solid = rubber(_log(g, 0.05, 1.0), _log(g, 50.0, 5000.0), g)
    return _sliding(solid, _log(g, 0.002, 0.05), _near_full(g), g)


def _sliding_nearly_elastic(g: np.random.Generator) -> WaveProblem | None:
    solid = power_law(_log(g, 0.002, 0.05), _log(g, 50.0, 5000.0), g)
    return _sliding(solid, _log(g, 0.002, 0.2), g.uniform(0.02, 0.7), g)


def _sliding_tread(g: np.random.Generator) -> WaveProblem:
    wavelength, speed = _log(g, 1e-4, 3e-2), _log(g, 1e-3, 10.0)
    slope, solid = g.uniform(0.02, 0.2), tread()
    modulus = abs(solid.complex_modulus(2.0 * np.pi * speed / wavelength))
    load = WaveLoad(_log(g, 0.02, 0.5) * modulus, speed, _log(g, 1.0, 10.0) * wavelength / speed)
    return WaveProblem(solid, Sine(wavelength, slope * wavelength), load)


KINDS: dict[str, Draw] = {
    "elastic near full": lambda g: _at_rest(_log(g, 0.001, 0.03), _near_full(g)),
    "sliding near full": _sliding_full,
    "elastic tiny": lambda g: _at_rest(_log(g, 5e-4, 2e-3), _log(g, 1e-4, 0.03)),
    "sliding tiny": _sliding_tiny,
    "elastic shallow": lambda g: _at_rest(_log(g, 0.002, 0.1), g.uniform(0.05, 0.9)),
    "sliding nearly elastic": _sliding_nearly_elastic,
    "elastic harsh": _elastic_harsh,
    "sliding harsh": _sliding_harsh,
    "sliding very lossy": _sliding_lossy,
    "sliding tread": _sliding_tread,
}


def closed_form(problem: WaveProblem) -> tuple[float, float]:
    """Return contact fraction and friction of the half-plane, in closed form at rest."""
    profile, load = problem.profile, problem.load
    if load.speed == 0.0:
        full = theory.full_contact_pressure(
            problem.rubber.plane_strain_modulus(1.0).real,
            wavelength=profile.wavelength,
            amplitude=profile.amplitude,
        )
        return float(contact_fraction(load.pressure / full)), 0.0
    result = theory.HalfPlane(points=4096).solve(problem)
    assert result.converged
    return result.contact_fraction, result.friction
