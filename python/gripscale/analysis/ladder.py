"""The ladder: from the chain to the profile as measured, one assumption given up on each rung.

A new rung is a function that draws its samples and an entry in `LADDER`. What two rungs on the same
surfaces say of an assumption becomes a factor of the best estimate by an entry in
`gripscale.analysis.best_estimate.FACTORS`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple, TypeVar

import numpy as np

from gripscale.chain.chain import Chain
from gripscale.conditions.conditions import Conditions
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.half_space.model import DirectContact
from gripscale.half_space.windows import random_phases, surface_of_sines
from gripscale.model import Load, Model
from gripscale.rubber import Rubber
from gripscale.surface import (
    HeightMap,
    Measured,
    Profile,
    SineStack,
    Surface,
    fit_sines,
    height_difference,
)
from gripscale.surface.isotropic_maps import STEPS_IN_WAVE
from gripscale.surface.line_statistics import FEWEST_PERIODS
from gripscale.surface.spectrum import ArealSpectrum, areal_spectrum, profile_spectrum
from gripscale.theory.half_plane import HalfPlane
from gripscale.theory.models import KlueppelHeinrich, Persson
from gripscale.wave.kernel import WaveSolver
from gripscale.wave.profile import BlockOnProfile

# What a rung of the ladder is: a model, what it changes, and the surfaces it is tried on.


@dataclass(frozen=True, eq=False)
class ComparisonSetup:
    """What the models are compared over, and how finely.

    Parameters
    ----------
    rubber, surface, load
        What slides on what, how hard and how fast.
    solver : WaveSolver
        What solves one wave of the chain, as the case says.
    seeds : int
        Random phases drawn of each surface.
    tolerance : float
        Estimated relative error of each direct contact.
    klueppel_heinrich : KlueppelHeinrich, optional
        That theory with its fitted parameters; without them it says nothing.
    pressure_classes : int
        In how many classes of equal load the chain hands its pressure down, as the case says.
    conditions : Conditions, optional
        What changes the rubber. Chain and direct contact know all of it, every other model only the
        temperature.
    """

    rubber: Rubber
    surface: Surface
    load: Load
    solver: WaveSolver
    seeds: int = 3
    tolerance: float = 0.05
    klueppel_heinrich: KlueppelHeinrich | None = None
    pressure_classes: int = 1
    conditions: Conditions | None = None

    @property
    def of_map(self) -> bool:
        """Whether a map was measured."""
        return self.surface.measured is not None and self.surface.measured.map is not None

    @property
    def rubber_before(self) -> Rubber:
        """The rubber at the temperature before the contact, for models that know no more."""
        return self.rubber if self.conditions is None else self.conditions.before(self.rubber)

    def rubber_for(self, model: Model) -> Rubber:
        """Return the rubber as measured for a model with conditions, else `rubber_before`."""
        return self.rubber_before if model.conditions is None else self.rubber


class SampleSpec(NamedTuple):
    """One sample of a rung: a model to ask, and on which surface."""

    model: Model
    surface: Surface
    subject: str = ""
    """What it is a sample of, such as a profile; samples of the same are compared in pairs."""


@dataclass(frozen=True)
class Rung:
    """One model of the ladder.

    Parameters
    ----------
    name : str
        Word for it in result files.
    label : str
        In words, for tables and figures.
    group : str
        Which rungs it belongs with, so that they can be asked for together.
    change : str
        What changes from the rung it follows, in words; empty where there is none.
    follows : str
        Name of the rung it is compared with; empty for none.
    draws : callable
        From a `ComparisonSetup` to its samples; none where the model has nothing to say of it.
    """

    name: str
    label: str
    group: str
    change: str
    follows: str
    draws: Callable[[ComparisonSetup], Sequence[SampleSpec]] = field(repr=False)


def with_single_measurement(surface: Surface, measured: Profile | HeightMap) -> Surface:
    """Return the waves of `surface` with nothing else measured."""
    whole = measured if isinstance(measured, HeightMap) else [measured]
    return Surface(surface.sines, measured.name, measured=Measured.of(whole))


# Samples of the rungs that correct the direct contact of a line: finite strain, and a whole map.
#
# Each correction is the ratio of two rungs on the same surfaces, see
# `gripscale.analysis.best_estimate.FACTORS`.

WINDOW, MOST_WAVES, WINDOWS = 1.1, 190, 8
"""Windows of a profile in the block: length over the largest sine wave, waves that are kept at most
(those of the roughness that the measurement has), and how many windows at most."""

MAP, WAVES_IN_MAP, MAPS, LINES = 1.8, 128, 2, 10
"""Synthetic maps: least length over the largest sine wave, length over the smallest wave that is
kept, how many, and how many lines of each are solved each way."""


def windows_half_plane(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    """Return windows of the profiles for the half-space."""
    return _on_windows(setup, DirectContact(tolerance=setup.tolerance, periodic=True))


def windows_finite_strain(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    """Return the same windows for the block."""
    return _on_windows(setup, BlockOnProfile(periodic=True))


def maps(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    """Return synthetic isotropic maps of the profiles."""
    return _on_maps(setup, 0)


def lines_of_maps(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    """Return lines of the same maps."""
    return _on_maps(setup, LINES)


def _on_windows(setup: ComparisonSetup, model: Model) -> Sequence[SampleSpec]:
    measured, sines = setup.surface.measured, setup.surface.sines
    lines = () if measured is None else tuple(measured.cleaned)
    length = WINDOW * float(sines.wavelength[0])
    return [
        SampleSpec(
            model,
            with_single_measurement(setup.surface, line),
            f"{line.name} from {line.x[0]:.4g} m",
        )
        for line in _windows(lines, length, float(sines.cutoff_wavelength))
    ]


@lru_cache(maxsize=4)
def _windows(lines: tuple[Profile, ...], length: float, end: float) -> list[Profile]:
    """Return windows of the profiles that are long enough for one, with waves down to `end`."""
    from gripscale.half_space.finite_strain import (
        spread_windows,  # scipy.stats with it: 0.3 s, which no run pays
    )

    enough = [line for line in lines if line.length > length]
    if not enough:
        return []
    smallest = max(length / MOST_WAVES, end, 2.0 * max(line.step for line in enough))
    return spread_windows(enough, length, WINDOWS, smallest)


def _on_maps(setup: ComparisonSetup, lines: int) -> Sequence[SampleSpec]:
    """Return the maps; none of a surface that is a map, or whose profiles are too short."""
    from gripscale.half_space.maps import SyntheticMap

    surface = setup.surface
    if surface.measured is None or surface.measured.map is not None:
        return []
    cleaned, sines = surface.measured.cleaned, surface.sines
    step = max(line.step for line in cleaned)
    smallest = max(
        MAP * sines.wavelength[0] / WAVES_IN_MAP, sines.cutoff_wavelength, STEPS_IN_WAVE * step
    )
    if sum(line.length for line in cleaned) < FEWEST_PERIODS * WAVES_IN_MAP * smallest:
        return []
    return [
        SampleSpec(
            SyntheticMap(seed, float(smallest), lines, tolerance=setup.tolerance),
            surface,
            f"map {seed}",
        )
        for seed in range(MAPS)
    ]


Measurement = TypeVar("Measurement", Profile, HeightMap)

DIRECT = "direct"
"""The rung the chain is judged by, and the best estimate starts from."""

LENGTH_OF_SINES = 10
"""Period of a surface of sines over its largest wave."""

WAVES_OF_UPPER_HALF, CLASSES = 4, 8
"""Waves and pressure classes of the chain that comes nearest to direct contact on surfaces it was
not chosen by, see docs/chain-and-direct-contact.md."""

POINTS_OF_A_CLASS = 256
"""Points along each of its waves: within 0.2 % of 1024 on the shipped road, 3 mm/s to 30 m/s."""


def chosen(names: Iterable[str]) -> list[Rung]:
    """Return the rungs of the given names and groups in the order of the ladder; all without any.

    Raises `InputError` for an unknown one.
    """
    wanted = set(names)
    groups = dict.fromkeys(rung.group for rung in LADDER)
    checks.allowed_names("rung", sorted(wanted), [*groups, *(rung.name for rung in LADDER)])
    return [rung for rung in LADDER if not wanted or wanted & {rung.name, rung.group}]


def each_measured(surface: Surface) -> list[tuple[str, Surface]]:
    """Return `surface` with one profile after the other, or its map, and what it is called."""
    measured: Sequence[Profile | HeightMap] = surface.measured.surfaces if surface.measured else []
    return [
        (part.name or f"profile {i}", with_single_measurement(surface, part))
        for i, part in enumerate(measured, 1)
    ]


def _chain(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    small_strain = isinstance(setup.solver, HalfPlane)
    if small_strain:
        return []
    return [SampleSpec(_chain_of(setup, setup.solver), setup.surface)]


def _chain_of(setup: ComparisonSetup, solver: WaveSolver) -> Chain:
    return Chain(solver, pressure_classes=setup.pressure_classes, conditions=setup.conditions)


def _direct_of(setup: ComparisonSetup) -> DirectContact:
    return DirectContact(tolerance=setup.tolerance, conditions=setup.conditions)


def _chain_half_plane(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    solver = setup.solver if isinstance(setup.solver, HalfPlane) else HalfPlane()
    return [SampleSpec(_chain_of(setup, solver), setup.surface)]


def _chain_upper(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    surface = setup.surface
    upper_already = surface.counted.get("top_height_fraction", 1.0) < 1.0
    cut_off_already = surface.sines.cut_off is not None
    if upper_already and cut_off_already and setup.pressure_classes > 1:
        return []
    lines = () if surface.measured is None else tuple(surface.measured.cleaned)
    end = surface.cutoff_wavelength
    sines = _of_upper_half(lines, surface.counted.get("max_lag"), end) if lines else None
    if sines is None:
        return []
    solver = HalfPlane(points=POINTS_OF_A_CLASS)
    chain = Chain(solver, pressure_classes=CLASSES, conditions=setup.conditions)
    return [SampleSpec(chain, Surface(sines, "waves of the upper half"))]


@lru_cache(maxsize=4)
def _of_upper_half(
    lines: tuple[Profile, ...], max_lag: float | None, cut_off: float
) -> SineStack | None:
    """Return waves of the upper half of the heights; None where they cannot be fitted."""
    try:
        upper = height_difference(lines, top_height_fraction=0.5, max_lag=max_lag)
        return fit_sines(upper, scales=WAVES_OF_UPPER_HALF, cut_off=cut_off)
    except InputError:  # too few lags, or roughness that ends too near the first wave
        return None


def _sines(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    model, surface = _direct_of(setup), setup.surface
    lines = (_of_sines(surface.sines, seed) for seed in range(setup.seeds))
    return [SampleSpec(model, with_single_measurement(surface, line)) for line in lines]


def _random_phases(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    model, surface = _direct_of(setup), setup.surface
    measured = [] if surface.measured is None else surface.measured.surfaces
    return [
        SampleSpec(model, with_single_measurement(surface, _shuffled(part, seed)), part.name)
        for part in measured
        for seed in range(setup.seeds)
    ]


def _direct(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    model = _direct_of(setup)
    return [SampleSpec(model, part, name) for name, part in each_measured(setup.surface)]


def _persson(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    return [
        SampleSpec(Persson(smallest_wavelength=_last_known(part)), part, name)
        for name, part in each_measured(setup.surface)
    ]


def _last_known(surface: Surface) -> float:
    """Return where the sine waves end [m], or the spectrum of the profile before them."""
    spectra = [_spectrum(line) for line in surface.measured.cleaned] if surface.measured else []
    ends = [float(2.0 * np.pi / spectrum.wavenumber[-1]) for spectrum in spectra]
    return max(surface.cutoff_wavelength, *ends)


def _klueppel_heinrich(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    theory = setup.klueppel_heinrich
    if theory is None:
        return []
    return [SampleSpec(theory, part, name) for name, part in each_measured(setup.surface)]


@lru_cache(maxsize=16)
def _of_sines(sines: SineStack, seed: int) -> Profile:
    return surface_of_sines(sines, LENGTH_OF_SINES * float(sines.wavelength[0]), seed)


@lru_cache(maxsize=16)
def _spectrum(line: Profile) -> ArealSpectrum:
    return areal_spectrum(profile_spectrum(line))


@lru_cache(maxsize=64)
def _shuffled(measured: Measurement, seed: int) -> Measurement:
    """Draw once what is met at every load."""
    return random_phases(measured, seed)


LADDER: tuple[Rung, ...] = (
    Rung("chain", "chain, finite strain", "waves", "", "", _chain),
    Rung(
        "chain_half_plane",
        "chain, small strain",
        "waves",
        "small strain assumed",
        "chain",
        _chain_half_plane,
    ),
    Rung(
        "chain_upper",
        "chain of the upper half, pressure in classes",
        "waves",
        "heights that touch, pressure as it is distributed",
        "chain_half_plane",
        _chain_upper,
    ),
    Rung(
        "sines",
        "the case's sine waves at once",
        "waves",
        "all scales together",
        "chain_half_plane",
        _sines,
    ),
    Rung(
        "random_phases",
        "profile with random phases",
        "measured",
        "the whole spectrum",
        "sines",
        _random_phases,
    ),
    Rung(
        DIRECT,
        "profile as measured, at once",
        "measured",
        "the measured phases",
        "random_phases",
        _direct,
    ),
    Rung("persson", "Persson, isotropic surface", "theory", "", DIRECT, _persson),
    Rung("klueppel_heinrich", "Klüppel & Heinrich", "theory", "", DIRECT, _klueppel_heinrich),
    Rung(
        "windows_half_plane",
        "windows of it, small strain",
        "windows",
        "",
        "",
        windows_half_plane,
    ),
    Rung(
        "windows_finite_strain",
        "windows of it, finite strain",
        "windows",
        "finite strain",
        "windows_half_plane",
        windows_finite_strain,
    ),
    Rung("map_lines", "lines of a synthetic map", "map", "", "", lines_of_maps),
    Rung("map", "the synthetic map", "map", "a map for its lines", "map_lines", maps),
)
"""All rungs, in order; a new one is added here."""
