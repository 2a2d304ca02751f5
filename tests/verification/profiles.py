"""Whole profiles with their loads: windows of the measured road, sums of sines, steep stones."""

from dataclasses import dataclass
from functools import cache

import numpy as np

import gripscale as gs
from gripscale.half_space import one_period
from tests.samples import EXAMPLES
from tests.verification.families import tread

ROAD = EXAMPLES / "data" / "road"
WINDOW = 38e-3
MARGIN = 0.02
"""Share of the record at each end that holds the transition into the surface."""


@dataclass(frozen=True)
class ProfileCase:
    """A profile under a load; `solve` and `half_plane` take the same heights."""

    name: str
    profile: gs.Profile
    pressure: float
    speed: float
    periodic: bool
    smallest_wavelength: float | None = None

    def solve(self, **mesh: int) -> gs.ScaleResult:
        """Return the answer of the finite-strain block."""
        return gs.solve_profile(tread(), self.line, **self._options, **mesh)

    def half_plane(self) -> gs.RoughContact:
        """Return the answer at small strain."""
        return gs.solve_rough_contact(tread(), self.line, **self._options, workers=1)

    @property
    def line(self) -> gs.Profile:
        """The periodic line of both models."""
        return self.profile if self.periodic else one_period(self.profile)

    @property
    def _options(self) -> dict[str, float | None]:
        cut_off = self.smallest_wavelength
        load = {"pressure": self.pressure, "speed": self.speed}
        return {**load, "periodic": True, "smallest_wavelength": cut_off}


@cache
def road_windows(
    station: int, cut_off: float, count: int = 20, *, cleaned: bool = False
) -> tuple[ProfileCase, ...]:
    """Return `count` windows spread over the record of a station, at 3 bar and 0.3 m/s.

    `cleaned` takes out what is no road, spikes above all, which matter to the shortest waves.
    """
    road = gs.read_profile(ROAD / f"20211011_aylesbury_dec_station_{station}.dat")
    if cleaned:
        road, _ = gs.clean(road)
    points = round(WINDOW / road.step)
    x = road.x - road.x[0]
    inside = [
        first
        for first in range(0, len(road) - points, points)
        if x[first] >= MARGIN * road.length and x[first + points] <= (1.0 - MARGIN) * road.length
    ]
    chosen = [inside[i] for i in np.linspace(0, len(inside) - 1, count).round().astype(int)]
    return tuple(_window(road, station, first, points, cut_off) for first in chosen)


def _window(road: gs.Profile, station: int, first: int, points: int, cut_off: float) -> ProfileCase:
    part = slice(first, first + points + 1)
    name = f"station {station} from {road.x[first]:.3f} m"
    return ProfileCase(name, gs.Profile(road.x[part], road.z[part]), 3e5, 0.3, False, cut_off)


def sums_of_sines(count: int = 200, seed: int = 38) -> list[ProfileCase]:
    """Return sums of 2 to 6 sines with slopes to 0.4 each, 1 to 10 bar, 0.01 to 10 m/s."""
    random = np.random.default_rng(seed)
    return [_sum(number, random) for number in range(count)]


def _sum(number: int, random: np.random.Generator, points: int = 512) -> ProfileCase:
    others = random.choice(np.arange(2, 13), size=random.integers(1, 6), replace=False)
    waves = np.array([1, *others])
    period = WINDOW * np.arange(points) / points
    turn = 2.0 * np.pi * waves / WINDOW
    amplitude = random.uniform(0.1, 0.4, waves.size) / turn
    phase = random.uniform(0.0, 2.0 * np.pi, waves.size)
    z = (amplitude * np.cos(np.outer(period, turn) + phase)).sum(axis=1)
    pressure, speed = 10.0 ** random.uniform(5.0, 6.0), 10.0 ** random.uniform(-2.0, 1.0)
    return ProfileCase(f"sum {number}", gs.Profile(period, z), pressure, speed, True)


def steep_stones(count: int = 100, seed: int = 5) -> list[ProfileCase]:
    """Return two or three stones of different height and width on 8 mm, with flanks of slope 2.

    From 0.3 to 0.5 mm high and 0.1 to 1.5 mm wide, the narrowest of them single peaks; edges are
    rounded by a Gaussian of 0.05 mm, which leaves slopes of 1.7 to 2 and waves down to 0.1 mm.
    From 3 to 30 bar, at 0.3 m/s.
    """
    random = np.random.default_rng(seed)
    return [_stones(number, random) for number in range(count)]


def _stones(number: int, random: np.random.Generator) -> ProfileCase:
    period, points, flank = 8e-3, 640, 2.0
    x = period * np.arange(points) / points
    stones = random.integers(2, 4)
    z = np.zeros(points)
    for stone in range(stones):
        middle = period * (stone + random.uniform(0.3, 0.7)) / stones
        height, half_width = random.uniform(0.3e-3, 0.5e-3), 0.5 * random.uniform(0.1e-3, 1.5e-3)
        outside = np.maximum(np.abs(x - middle) - half_width, 0.0)
        z = np.maximum(z, height - flank * outside)
    wave = 2.0 * np.pi * np.fft.rfftfreq(points, period / points)
    z = np.fft.irfft(np.fft.rfft(z) * np.exp(-0.5 * (wave * 0.05e-3) ** 2), points)
    pressure = 10.0 ** random.uniform(np.log10(3e5), np.log10(3e6))
    return ProfileCase(f"stones {number}", gs.Profile(x, z), pressure, 0.3, True, 0.1e-3)
