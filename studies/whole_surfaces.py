"""What adding scale upon scale costs: the chain beside the direct contact of the same surfaces.

An early prototype of the same equations gave the figures in `SAID`; here each is found again with
today's solvers, or corrected. The waves are those of the shipped road: A/lambda = 0.096
(lambda/28.7 mm)^-0.094, so that every factor between waves samples one surface.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

import gripscale as gs
from gripscale.half_space import surface_of_sines
from gripscale.model import FOOTPRINT
from gripscale.reproduction.inputs import (
    COARSE,
    FASTEST,
    FILLED_TREAD,
    NOMINAL_PRESSURE,
    SBR,
    SPEED,
    PaperInputs,
)
from gripscale.surface import HeightMap, Profile, SineStack
from studies.random_phases import random_phases

SEEDS = range(6)
PERIODS = 12
"""Largest waves on a line of sines."""
Pair = tuple[float, float]
"""Contact fraction and friction."""


@dataclass(frozen=True)
class Case:
    """One line of the table."""

    surface: str
    said: str
    """By the prototype: chain; direct."""
    chain: Callable[[], Pair] | None
    direct: Callable[[], Sequence[Pair]]
    """Of every seed, station or window."""


@dataclass(frozen=True)
class Found:
    """What came out of a case."""

    case: Case
    chain: Pair | None
    direct: np.ndarray
    """Shape (solutions, 2)."""

    def cells(self) -> list[str]:
        """Return surface, chain and direct, as printed."""
        return [self.case.surface, self.case.said, _told(self.chain), self._direct()]

    def _direct(self) -> str:
        if len(self.direct) <= 2:
            return "; ".join(_told(pair) for pair in self.direct)
        (area, friction), (of_area, of_friction) = self.direct.mean(0), self.direct.std(0, ddof=1)
        return f"{area:.4f} +- {of_area:.4f}, {friction:.3f} +- {of_friction:.3f}"


def _told(pair: Pair | None) -> str:
    return "-" if pair is None else f"{pair[0]:.4f}, {pair[1]:.3f}"


@dataclass(frozen=True)
class Cases:
    """The surfaces and rubbers, and what is asked of them."""

    inputs: PaperInputs

    def small_strain(self) -> Iterator[Case]:
        """Yield the lines of the first table."""
        for factor, waves, said in (
            (2.2443, 6, "0.029, 0.377; 0.027, 0.246"),
            (3.5, 4, "0.0296, 0.259; 0.035, 0.200"),
            (6.0, 3, "0.0324, 0.197; 0.038, 0.169"),
        ):
            stack = self.waves(factor ** np.arange(waves))
            yield Case(
                f"{waves} sines, factor {factor:.3g}",
                said,
                partial(self.chain, stack),
                partial(self._seeds_of_sines, stack),
            )
        yield from self._roads()
        yield from self._maps()
        yield from self._lossy()

    def _roads(self) -> Iterator[Case]:
        stations, down = self.stations(), 2e-4
        yield Case(
            "road, whole",
            "0.022, 0.50; 0.053, 0.145 and 0.054, 0.138",
            lambda: self.chain(self.seven()),
            lambda: [self.contact(line, down) for line in stations],
        )
        yield Case(
            "road, 1.2 m",
            "0.057, 0.158 and 0.062, 0.127",
            None,
            lambda: [self.contact(_first(line, 1.2), down) for line in stations],
        )
        for number, said in enumerate(("0.024, 0.34", "0.017, 0.47")):
            yield Case(
                f"station {number}, random phases",
                said,
                None,
                partial(self._seeds_of_phases, stations[number], down),
            )
        yield Case(
            "station 0, 0.5 mm; upside down",
            "0.079, 0.103; 0.059, 0.232",
            None,
            lambda: [
                self.contact(stations[0], 5e-4),
                self.contact(replace(stations[0], z=-stations[0].z), 5e-4),
            ],
        )

    def _maps(self) -> Iterator[Case]:
        surface = isotropic_map()
        lines = [Profile(surface.x, surface.z[:, row]) for row in range(0, len(surface.y), 16)]
        tread = self.inputs.compounds[FILLED_TREAD].rubber
        step = float(surface.x[1])
        spectrum = gs.surface.map_spectrum(surface.z, x_step=step, y_step=step, taper="none")
        yield Case(
            "isotropic map, 0.4 mm",
            "0.037, 0.191; 0.0367, 0.129",
            lambda: self.chain(
                gs.fit_sines(gs.height_difference(lines), scales=6, smallest_wavelength=4e-4)
            ),
            lambda: [self.contact(surface, 4e-4, periodic=True)],
        )
        yield Case(
            "single lines of it",
            "0.068, 0.104",
            None,
            lambda: [self.contact(line, 4e-4, periodic=True) for line in lines],
        )
        found = gs.theory.persson(
            tread, spectrum, pressure=NOMINAL_PRESSURE, speed=SPEED, smallest_wavelength=4e-4
        )
        pair = found.contact_fraction, found.friction
        yield Case("Persson's theory for it", "0.027, 0.086", None, lambda: [pair])

    def _lossy(self) -> Iterator[Case]:
        stations, down, seven = self.stations(), 2e-4, self.seven()
        yield Case(
            "road, unfilled SBR, 30 m/s",
            "0.0135, 2.45; 0.058, 0.77 (station 0)",
            lambda: self.chain(seven, rubber=SBR, speed=FASTEST),
            lambda: [self.contact(stations[0], down, rubber=SBR, speed=FASTEST, tolerance=0.05)],
        )

    def stations(self) -> list[Profile]:
        """Return the two lines of the road as they are evaluated."""
        measured = self.inputs.surfaces[COARSE].measured
        assert measured is not None
        return measured.cleaned

    def waves(self, multiples: np.ndarray) -> SineStack:
        """Return waves that many times shorter than the first, with slopes by the road's law."""
        fitted = self.inputs.surfaces[COARSE].sines
        first, slope = fitted.wavelength[0], fitted.amplitude / fitted.wavelength
        exponent = np.log(slope[-1] / slope[0]) / np.log(first / fitted.wavelength[-1])
        lengths = first / np.asarray(multiples, dtype=float)
        return SineStack(lengths, lengths * slope[0] * (first / lengths) ** exponent)

    def _seeds_of_sines(self, stack: SineStack) -> list[Pair]:
        return [self.contact(_line(stack, seed)) for seed in SEEDS]

    def _seeds_of_phases(self, line: Profile, down: float) -> list[Pair]:
        lines = [random_phases(line, seed) for seed in SEEDS]
        return [self.contact(drawn, down, periodic=True) for drawn in lines]

    def seven(self) -> SineStack:
        """Return seven waves fitted to the road down to 0.2 mm."""
        return gs.fit_sines(self.inputs.correlation(COARSE), scales=7, smallest_wavelength=2e-4)

    def chain(
        self,
        sines: SineStack,
        rubber: str = FILLED_TREAD,
        speed: float = SPEED,
        solver: str = "half_plane",
    ) -> Pair:
        """Return contact fraction and friction of the waves one after the other."""
        found = gs.solve_chain(
            self.inputs.compounds[rubber].rubber,
            sines,
            pressure=NOMINAL_PRESSURE,
            speed=speed,
            footprint=FOOTPRINT,
            solver=solver,
        )
        return found.contact_fraction, found.friction

    def contact(
        self,
        surface: Profile | HeightMap,
        smallest: float | None = None,
        *,
        rubber: str = FILLED_TREAD,
        speed: float = SPEED,
        periodic: bool | None = None,
        tolerance: float = 0.02,
    ) -> Pair:
        """Return contact fraction and friction of a whole surface at once."""
        found = gs.solve_rough_contact(
            self.inputs.compounds[rubber].rubber,
            surface,
            pressure=NOMINAL_PRESSURE,
            speed=speed,
            smallest_wavelength=smallest,
            periodic=smallest is None if periodic is None else periodic,
            tolerance=tolerance,
        )
        return found.contact_fraction, found.friction


def isotropic_map() -> HeightMap:
    """Return Gaussian heights: rms 0.3 mm, H = 0.8 between 4 and 0.4 mm, 256 x 256 points."""
    points, step = 256, 1e-4
    along = 2.0 * np.pi * np.fft.fftfreq(points, step)
    q = np.hypot(along[:, None], along)
    rough = (q > 0.0) & (q <= 2.0 * np.pi / 4e-4)
    size = np.where(rough, np.maximum(q, 2.0 * np.pi / 4e-3) ** -1.8, 0.0)
    noise = np.fft.fft2(np.random.default_rng(0).standard_normal(q.shape))
    z = np.fft.ifft2(size * noise).real
    place = np.asarray(step * np.arange(points), dtype=np.float64)
    return HeightMap(place, place, z * (3e-4 / z.std()))


def _line(stack: SineStack, seed: int) -> Profile:
    return surface_of_sines(stack, PERIODS * float(stack.wavelength[0]), seed)


def _first(line: Profile, length: float) -> Profile:
    inside = line.x < line.x[0] + length
    return Profile(line.x[inside], line.z[inside])


def solved(case: Case) -> Found:
    """Return what comes out of a case."""
    return Found(case, case.chain() if case.chain else None, np.array(case.direct()))
