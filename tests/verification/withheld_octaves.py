"""Lines of which octaves are withheld and continued, judged by what was withheld."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.fft

import gripscale as gs
from gripscale.continuation import contact_by_cut_off
from gripscale.half_space.grid import Grid, resampled
from gripscale.surface.low_pass import transmission
from studies.shipped import DATA, road
from tests.verification.families import tread
from tests.verification.line_families import family_line

PRESSURE, SPEED = 3e5, 0.3
NUMBERS = ("friction_from_dissipation", "contact_fraction")


@dataclass(frozen=True)
class Line:
    """Profiles of a surface with the speed they are slid at [m/s]."""

    name: str
    profiles: tuple[gs.Profile, ...]
    speed: float = SPEED


@dataclass(frozen=True)
class Withheld:
    """What a continuation says of octaves that were measured."""

    line: str
    octaves: int
    refused: bool
    errors: tuple[float, float]
    """ln(found / true) of `NUMBERS`; of a refusal, of the measurement alone."""
    bands: tuple[float, float]
    """Half widths of the bands of the logarithms."""

    @property
    def holds(self) -> tuple[bool, bool]:
        """Whether the truth of each number lies in its band."""
        first, second = (abs(e) <= b for e, b in zip(self.errors, self.bands, strict=True))
        return first, second


def measured_lines() -> list[Line]:
    """Return the two stations of the shipped road, and a machined surface of another instrument."""
    machined = gs.read_profile(DATA / "surfaces" / "mitutoyo_2_mock.xlsx")
    return [
        Line("road", (road(0), road(1))),
        Line("machined", (gs.clean(machined)[0],), speed=0.01),
    ]


def synthetic_lines(families: Iterable[str], seeds: Iterable[int]) -> Iterator[Line]:
    """Yield a line of each family for each seed."""
    numbers = list(seeds)
    for family in families:
        for seed in numbers:
            yield Line(family, (family_line(family, seed),))


def coarser(line: gs.Profile, octaves: int) -> gs.Profile:
    """Return a line as an instrument with fewer points measures it.

    Its spot is a step wide: a Gaussian of which a wave of two steps keeps half its amplitude, and
    one of four steps, the shortest that counts as resolved, 0.84.
    """
    z = np.interp(line.x, line.x[~np.isnan(line.z)], line.z[~np.isnan(line.z)])
    waves = scipy.fft.rfft(z - np.linspace(z[0], z[-1], z.size))
    points, length = line.x.size >> octaves, line.step * line.x.size
    q = 2.0 * np.pi * scipy.fft.rfftfreq(z.size, line.step)
    if octaves:
        waves = waves * transmission(q, 2.0 * length / points)
    z = resampled(waves, z.shape, Grid((points,), (length,)))
    return gs.Profile(length / points * np.arange(points), z)


def judged(surfaces: Iterable[Line], octaves: tuple[int, ...] = (1, 2, 3)) -> Iterator[Withheld]:
    """Yield contact and friction of lines whose last octaves were withheld, over the true ones."""
    for line in surfaces:
        load = {"pressure": PRESSURE, "speed": line.speed}
        fine = [coarser(profile, 0) for profile in line.profiles]
        limit = max(profile.resolution_limit for profile in fine)
        true = contact_by_cut_off(tread(), fine, down_to=limit, **load)
        for count in octaves:
            lines = [coarser(profile, count) for profile in fine]
            found = contact_by_cut_off(tread(), lines, down_to=limit, **load)
            first, second = (
                math.log(found.values(name)[-1] / true.values(name)[-1]) for name in NUMBERS
            )
            bands = (float(found.band(NUMBERS[0])[-1]), float(found.band(NUMBERS[1])[-1]))
            yield Withheld(line.name, count, bool(found.refusal), (first, second), bands)
