"""Random waves to be solved cold: the box that docs/limits.md states, and far outside of it.

    python -m tests.verification.random_waves FILE.csv --box ordinary --count 10000

writes a line for every wave as it is solved, and goes on after the last one of an unfinished file.
"""

from __future__ import annotations

import csv
import time
import warnings
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
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

    name: str
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


ORDINARY = Box("ordinary", (0.02, 0.27), (0.03, 1.0), 1e3, 1.0, MOST_PRESSURE)
FAR = Box("far", (0.02, 0.35), (0.03, 1.5), 1e5, 3.0, np.inf)
BOXES = {box.name: box for box in (ORDINARY, FAR)}


@dataclass(frozen=True)
class RandomWave:
    """One wave with its rubber."""

    number: int
    kind: str
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


def random_waves(box: Box, count: int, *, first: int = 0, seed: int = SEED) -> Iterator[RandomWave]:
    """Yield the waves numbered from `first`; each depends on seed and number alone."""
    for number in range(first, first + count):
        yield _drawn(box, number, np.random.default_rng([seed, number]))


def _drawn(box: Box, number: int, generator: np.random.Generator) -> RandomWave:
    kind = str(generator.choice(list(SERIES)))
    while True:
        rubber = _rubber(box, kind, generator)
        if rubber is None:
            continue
        wave = RandomWave(
            number,
            kind,
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


@dataclass(frozen=True)
class Row:
    """What one wave gave, with its inputs."""

    box: str
    seed: int
    number: int
    kind: str
    terms: int
    slope: float
    pressure_ratio: float
    loss_factor: float
    growth: float
    """|E*| at the 32nd harmonic over that at the first."""
    glassy_ratio: float
    bulk_ratio: float
    """K / |G*|."""
    passages: float
    pressure_over_relaxed: float
    """p / E(t), t the load time."""
    mean_shear: float
    """Friction over G(t)."""
    columns: int
    rows: int
    status: str
    load_reached: float
    friction: float
    friction_from_dissipation: float
    mismatch: float
    contact_fraction: float
    min_stretch: float
    max_stretch: float
    newton_iterations: int
    load_steps: int
    seconds: float
    """CPU."""


def solve(box: Box, wave: RandomWave, *, columns: int, rows: int, seed: int = SEED) -> Row:
    """Solve one wave cold and measure it."""
    arguments, rubber = wave.arguments(), wave.rubber
    start = time.process_time()
    result = gs.solve_scale(rubber, **arguments, columns=columns, rows=rows)
    seconds = time.process_time() - start
    modulus = abs(complex(rubber.complex_modulus(OMEGA)))
    return Row(
        box.name,
        seed,
        wave.number,
        wave.kind,
        len(rubber.moduli),
        wave.slope,
        wave.pressure_ratio,
        float(rubber.loss_factor(OMEGA)),
        abs(complex(rubber.complex_modulus(32.0 * OMEGA))) / modulus,
        rubber.glassy_modulus / rubber.equilibrium_modulus,
        3.0 * rubber.bulk_modulus / modulus,
        wave.passages,
        wave.softness,
        3.0 * abs(result.friction) * wave.softness,
        int(result.details["columns"]),
        int(result.details["rows"]),
        str(result.status),
        float(result.details["load_reached"]),
        result.friction,
        result.friction_from_dissipation,
        result.friction_mismatch,
        result.contact_fraction,
        result.min_stretch,
        result.max_stretch,
        result.newton_iterations,
        int(result.details["load_steps"]),
        seconds,
    )


def main(
    file: Path,
    box: Annotated[str, typer.Option()] = ORDINARY.name,
    count: Annotated[int, typer.Option()] = 200,
    columns: Annotated[int, typer.Option()] = 64,
    rows: Annotated[int, typer.Option()] = 12,
    seed: Annotated[int, typer.Option()] = SEED,
) -> None:
    """Solve random waves into FILE.csv."""
    known = BOXES[box]
    done = sum(1 for _ in file.open()) - 1 if file.exists() else 0
    with file.open("a", newline="") as out:
        writer = csv.DictWriter(out, Row.__dataclass_fields__)
        if done <= 0:
            writer.writeheader()
        for wave in random_waves(known, count - max(done, 0), first=max(done, 0), seed=seed):
            writer.writerow(asdict(solve(known, wave, columns=columns, rows=rows, seed=seed)))
            out.flush()


if __name__ == "__main__":
    typer.run(main)
