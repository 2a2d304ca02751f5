"""A random grid of loads as real roads bring them, to be solved cold."""

from dataclasses import dataclass
from typing import Any

import numpy as np

import gripscale as gs
from gripscale.theory import HalfPlane
from gripscale.wave import Sine, WaveLoad, WaveProblem

WAVELENGTH = 1e-3
SPEED = 1.0
MODULUS = 1e7
"""|E*| at the first harmonic [Pa]: results depend on ratios only."""


@dataclass(frozen=True)
class LoadCase:
    """One random load; all ratios are those of the wave's own excitation."""

    number: int
    rubber: gs.Rubber
    slope: float
    """A / lambda."""
    pressure_ratio: float
    """p / |E*(w_1)|."""
    loss_factor: float
    growth: float
    """|E*| at the 32nd harmonic over that at the first."""
    bulk_ratio: float
    """K / |G*(w_1)|."""
    passages: float
    """Load time in passages of the wave."""

    @property
    def problem(self) -> WaveProblem:
        """The same as a `WaveProblem`."""
        load = WaveLoad(self.pressure_ratio * MODULUS, SPEED, self.passages * WAVELENGTH / SPEED)
        return WaveProblem(self.rubber, Sine(WAVELENGTH, self.slope * WAVELENGTH), load)

    def arguments(self) -> dict[str, Any]:
        """Keyword arguments for `gripscale.solve_scale`."""
        return {
            "wavelength": WAVELENGTH,
            "amplitude": self.slope * WAVELENGTH,
            "pressure": self.pressure_ratio * MODULUS,
            "speed": SPEED,
            "load_time": self.passages * WAVELENGTH / SPEED,
        }


def cases(count: int = 300, seed: int = 20140714) -> list[LoadCase]:
    """Return `count` random cases, the same for the same `seed`."""
    generator = np.random.default_rng(seed)
    found: list[LoadCase] = []
    while len(found) < count:
        case = _draw(len(found), generator)
        if case is not None:
            found.append(case)
    return found


def _draw(number: int, generator: np.random.Generator) -> LoadCase | None:
    """Draw one case; None if its mean shear would exceed one or its solid is impossible."""
    loss = np.exp(generator.uniform(np.log(0.05), np.log(1.0)))
    bulk = np.exp(generator.uniform(np.log(50.0), np.log(5000.0)))
    slope = generator.uniform(0.02, 0.35)
    pressure = np.exp(generator.uniform(np.log(0.03), np.log(1.0)))
    passages = generator.choice([1.0, 3.0, 10.0, 100.0, np.inf])
    solid = rubber(loss, bulk, generator)
    if solid is None:
        return None
    omega = 2 * np.pi * SPEED / WAVELENGTH
    growth = float(np.abs(solid.complex_modulus(32 * omega) / solid.complex_modulus(omega)))
    case = LoadCase(
        number, solid, slope, pressure, solid.loss_factor(omega), growth, bulk, passages
    )
    return case if growth <= 10.0 and mean_shear(case.problem) < 1.0 else None


def rubber(loss: float, bulk: float, generator: np.random.Generator) -> gs.Rubber | None:
    """Return a power law seven of ten times, else a Zener solid; None where there is none."""
    return (power_law if generator.random() < 0.7 else single_term)(loss, bulk, generator)


def power_law(loss: float, bulk: float, generator: np.random.Generator) -> gs.Rubber | None:
    """Return a solid of nearly constant loss factor over the harmonics: E* ~ (i w)^a."""
    exponent = 2 / np.pi * np.arctan(loss)
    omega = 2 * np.pi * SPEED / WAVELENGTH
    below, above = generator.uniform(0.5, 3.0), generator.uniform(1.0, 3.0)
    times = np.logspace(below, -above, int(2 * (below + above)) + 1) / omega
    moduli = times**-exponent
    return _scaled(moduli, times, relaxed=(times[0] * 3.0) ** -exponent, bulk=bulk)


def single_term(loss: float, bulk: float, generator: np.random.Generator) -> gs.Rubber | None:
    """Return a Zener solid with the wanted loss factor at the first harmonic."""
    ratio = generator.uniform(1.5, 10.0)
    omega = 2 * np.pi * SPEED / WAVELENGTH
    # tan delta = (r - 1) x / (1 + r x^2), x = w tau, has two solutions or none.
    discriminant = (ratio - 1.0) ** 2 - 4.0 * ratio * loss**2
    if discriminant < 0.0:
        return None
    sign = generator.choice([-1.0, 1.0])
    x = (ratio - 1.0 + sign * np.sqrt(discriminant)) / (2.0 * ratio * loss)
    return _scaled(np.array([ratio - 1.0]), np.array([x / omega]), relaxed=1.0, bulk=bulk)


def _scaled(moduli: np.ndarray, times: np.ndarray, relaxed: float, bulk: float) -> gs.Rubber | None:
    omega = 2 * np.pi * SPEED / WAVELENGTH
    x = omega * times
    at_first = relaxed + np.sum(moduli * 1j * x / (1 + 1j * x))
    factor = MODULUS / abs(at_first)
    bulk_modulus = bulk * MODULUS / 3.0
    if bulk_modulus <= 0.5 * factor * (relaxed + moduli.sum()):
        return None
    return gs.Rubber(relaxed * factor, moduli * factor, times, bulk_modulus=bulk_modulus)


def mean_shear(problem: WaveProblem) -> float:
    """Estimate friction traction over the relaxation modulus at the load time."""
    load = problem.load
    friction = HalfPlane(points=256).solve(problem).friction
    shear_modulus = problem.rubber.relaxation_modulus(load.load_time) / 3.0
    return float(friction * load.pressure / shear_modulus)
