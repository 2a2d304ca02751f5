"""Random waves to be solved cold: the box that docs/limits.md states, and far outside of it."""

import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import gripscale as gs
from gripscale.core.errors import RubberWarning
from gripscale.rubber import styrene_butadiene
from gripscale.rubber.material import MOST_PRESSURE

WAVELENGTH = 1e-3
SPEED = 1.0
OMEGA = 2.0 * np.pi * SPEED / WAVELENGTH
SEED = 20141114
PASSAGES = (1.0, 3.0, 10.0, 100.0, np.inf)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Box:
    """Ranges of the random waves; ratios are those of a wave's own first harmonic."""

    slopes: tuple[float, float]
    """A / lambda."""
    pressures: tuple[float, float]
    """p / |E*|."""
    most_glassy: float
    """E_glass / E_inf."""
    most_loss: float
    """Loss factor."""
    most_soft: float
    """p / E(t), t the load time."""


ORDINARY = Box((0.02, 0.27), (0.03, 1.0), 1e3, 1.0, MOST_PRESSURE)
FAR = Box((0.02, 0.35), (0.03, 1.5), 1e5, 3.0, np.inf)


@dataclass(frozen=True)
class RandomWave:
    """One wave with its rubber."""

    number: int
    rubber: gs.Rubber
    slope: float
    pressure_ratio: float
    passages: float
    """Load time in passages of the wave."""

    @property
    def softness(self) -> float:
        """Pressure over the relaxation modulus after the load time."""
        load = self.arguments()
        return float(load["pressure"] / self.rubber.relaxation_modulus(load["load_time"]))

    def arguments(self) -> dict[str, float]:
        """Keyword arguments for `gripscale.solve_scale`."""
        modulus = abs(complex(self.rubber.complex_modulus(OMEGA)))
        return {
            "wavelength": WAVELENGTH,
            "amplitude": self.slope * WAVELENGTH,
            "pressure": self.pressure_ratio * modulus,
            "speed": SPEED,
            "load_time": self.passages * WAVELENGTH / SPEED,
        }


def random_waves(box: Box, count: int, *, first: int = 0) -> Iterator[RandomWave]:
    """Yield the waves numbered from `first`; each depends on its number alone."""
    for number in range(first, first + count):
        yield _drawn(box, number, np.random.default_rng([SEED, number]))


def _drawn(box: Box, number: int, generator: np.random.Generator) -> RandomWave:
    kind = str(generator.choice(list(SERIES)))
    while True:
        rubber = _rubber(box, kind, generator)
        if rubber is None:
            continue
        wave = RandomWave(
            number,
            rubber,
            slope=generator.uniform(*box.slopes),
            pressure_ratio=_log_uniform(generator, *box.pressures),
            passages=float(generator.choice(PASSAGES)),
        )
        if wave.softness <= box.most_soft:
            return wave


def _rubber(box: Box, kind: str, generator: np.random.Generator) -> gs.Rubber | None:
    """Return a rubber, or None if it is not in the box or its Poisson's ratio would be negative."""
    relaxed, moduli, times = SERIES[kind](box, generator)
    loose = gs.Rubber(relaxed, moduli, times, bulk_modulus=1e9 * (relaxed + moduli.sum()))
    if loose.loss_factor(OMEGA) > box.most_loss or loose.glassy_modulus > box.most_glassy * relaxed:
        return None
    at_first = abs(complex(loose.complex_modulus(OMEGA)))
    if generator.random() < 0.5:
        scale, bulk = _log_uniform(generator, 3e6, 3e8) / at_first, 2e9
    else:
        scale = 1e7 / at_first
        bulk = _log_uniform(generator, 100.0, 1000.0) * 1e7 / 3.0
    if bulk <= 0.25 * scale * loose.glassy_modulus:
        return None
    with warnings.catch_warnings(action="ignore", category=RubberWarning):
        return gs.Rubber(scale * relaxed, scale * moduli, times, bulk_modulus=bulk)


def _few_terms(box: Box, generator: np.random.Generator) -> tuple[float, Array, Array]:
    """One to three elements anywhere within two decades of the wave."""
    count = int(generator.integers(1, 4))
    times = 10.0 ** generator.uniform(-2.0, 2.0, count) / OMEGA
    shares = generator.dirichlet(np.ones(count))
    glassy = _log_uniform(generator, 1.2, box.most_glassy)
    return 1.0, (glassy - 1.0) * shares, times


def _power_law(box: Box, generator: np.random.Generator) -> tuple[float, Array, Array]:
    """Eight to twenty-four elements of nearly one loss factor, uneven by a factor of three."""
    count = int(generator.integers(8, 25))
    below, above = generator.uniform(0.5, 5.0), generator.uniform(1.0, 5.0)
    times = np.geomspace(10.0**below, 10.0**-above, count) / OMEGA
    exponent = generator.uniform(0.05, 0.6)
    uneven = np.exp(generator.uniform(-0.55, 0.55, count))
    return _with_glass(box, generator, uneven * times**-exponent, times)


def _tread(box: Box, generator: np.random.Generator) -> tuple[float, Array, Array]:
    """Filled tread: small loss over many decades, then a glass transition of E' ~ w^0.4."""
    times = np.logspace(5.0, -7.0, 24) / OMEGA
    transition = 10.0 ** generator.uniform(-5.0, 1.0) / OMEGA
    moduli = times ** -generator.uniform(0.05, 0.12)
    steep = (transition / times) ** generator.uniform(0.3, 0.5)
    return _with_glass(box, generator, moduli * np.maximum(1.0, steep), times)


def _unfilled(box: Box, generator: np.random.Generator) -> tuple[float, Array, Array]:
    """Unfilled SBR at a speed of any decade, slow times left out that make it a melt."""
    rubber = styrene_butadiene()
    shift = 10.0 ** generator.uniform(1.0, 6.5) / OMEGA
    times, moduli = rubber.relaxation_times * shift, rubber.moduli
    relaxed = max(rubber.equilibrium_modulus, 1.01 * moduli.sum() / box.most_glassy)
    return relaxed, moduli, times


SERIES = {"few terms": _few_terms, "power law": _power_law, "tread": _tread, "unfilled": _unfilled}


def _with_glass(
    box: Box, generator: np.random.Generator, moduli: Array, times: Array
) -> tuple[float, Array, Array]:
    """Return the series with the relaxed modulus of a random ratio to the glassy one."""
    glassy = _log_uniform(generator, 3.0, box.most_glassy)
    return float(moduli.sum()) / (glassy - 1.0), moduli, times


def _log_uniform(generator: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(generator.uniform(np.log(low), np.log(high))))


def solve(wave: RandomWave, columns: int = 64, rows: int = 12) -> gs.ScaleResult:
    """Solve one wave cold."""
    return gs.solve_scale(wave.rubber, **wave.arguments(), columns=columns, rows=rows)
