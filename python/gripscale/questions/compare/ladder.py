"""The ladder: from the chain to the profile as measured, one assumption given up on each model.

A new model is a function that draws its samples, entered at its place by `_compared`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from gripscale.chain.chain import Chain
from gripscale.conditions.conditions import Conditions
from gripscale.continuation.curve import ContinuedContact
from gripscale.core import Described, InputError, checks
from gripscale.half_space.model import BlockOnProfile, DirectContact
from gripscale.half_space.windows import spread_windows, surface_of_sines
from gripscale.model import Load, Model
from gripscale.questions.answer.estimate import DIRECT
from gripscale.rubber import Rubber
from gripscale.surface import Profile, SineStack, Surface, fit_sines, height_difference
from gripscale.surface.spectrum import ArealSpectrum, areal_spectrum, profile_spectrum
from gripscale.surface.surface import each_measured, with_single_measurement
from gripscale.theory.half_plane import HalfPlane
from gripscale.theory.klueppel_heinrich import KlueppelHeinrich
from gripscale.theory.persson import Persson


@dataclass(frozen=True, eq=False, repr=False)
class ComparisonSetup(Described):
    """What the models are compared over, and how finely."""

    rubber: Rubber
    surface: Surface
    load: Load
    chain: Chain
    """The chain of the case, under `conditions` without water."""
    seeds: int = 3
    """Random phases drawn of the sine waves."""
    tolerance: float = 0.05
    """Estimated relative error of each direct contact."""
    klueppel_heinrich: KlueppelHeinrich | None = None
    """That theory with its fitted parameters; without them it says nothing."""
    windows: int = 3
    """Windows of the profiles that are solved at finite strain."""
    continuation: ContinuedContact | None = None
    """Direct contact with roughness below the measurement, as the case says."""
    conditions: Conditions | None = None
    """What changes the rubber. Chain and direct contact know all of it, Persson's theory no heat,
    every other model only the temperature."""

    @property
    def lines(self) -> tuple[Profile, ...]:
        """The cleaned profiles, or the lines of a map; none of waves stated by hand."""
        return () if self.surface.measured is None else tuple(self.surface.measured.cleaned)

    @property
    def rubber_before(self) -> Rubber:
        """The rubber at the temperature before the contact, for models that know no more."""
        return self.rubber if self.conditions is None else self.conditions.before(self.rubber)

    def rubber_for(self, model: Model) -> Rubber:
        """Return the rubber as measured for a model with conditions, else `rubber_before`."""
        return self.rubber_before if model.conditions is None else self.rubber

    @property
    def direct(self) -> DirectContact:
        """The direct contact."""
        return DirectContact(
            tolerance=self.tolerance, conditions=self.conditions, alternatives=True
        )


class SampleSpec(NamedTuple):
    """One sample of a model: a model to ask, and on which surface."""

    model: Model
    surface: Surface
    subject: str = ""
    """What it is a sample of, such as a profile; samples of the same are compared in pairs."""


Draws = Callable[[ComparisonSetup], Sequence[SampleSpec]]


@dataclass(frozen=True)
class ComparedModel:
    """One model of the ladder."""

    name: str
    """Word for it in result files."""
    label: str
    """In words, for tables and figures."""
    group: str
    """Which models it belongs with, so that they can be asked for together."""
    change: str
    """What changes from the model it follows, in words; empty where there is none."""
    follows: str
    """Name of the model it is compared with; empty for none."""
    draws: Draws = field(repr=False)
    """From a setup to its samples; none where the model has nothing to say of it."""


WINDOWS = "windows"  # the group of models that take a minute and more
_BELOW = "below"  # the group of roughness below the measurement, which is compared on request only
LADDER: list[ComparedModel] = []
"""All models, in the order of the functions below."""


def chosen(names: Iterable[str]) -> list[ComparedModel]:
    """Return the models of names and groups; without names all but those below the measurement."""
    wanted = set(names)
    groups = dict.fromkeys(member.group for member in LADDER)
    checks.allowed_names("model", sorted(wanted), [*groups, *(member.name for member in LADDER)])
    if not wanted:
        return [member for member in LADDER if member.group != _BELOW]
    return [member for member in LADDER if wanted & {member.name, member.group}]


def _compared(
    name: str, label: str, group: str, change: str = "", follows: str = ""
) -> Callable[[Draws], Draws]:
    """Enter a function in `LADDER`."""

    def entered(draws: Draws) -> Draws:
        LADDER.append(ComparedModel(name, label, group, change, follows, draws))
        return draws

    return entered


@_compared("chain", "chain, finite strain", "waves")
def _chain(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    if isinstance(setup.chain.solver, HalfPlane):
        return []
    return [SampleSpec(setup.chain, setup.surface)]


@_compared("chain_half_plane", "chain, small strain", "waves", "small strain assumed", "chain")
def _chain_half_plane(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    solver = setup.chain.solver if isinstance(setup.chain.solver, HalfPlane) else HalfPlane()
    return [SampleSpec(replace(setup.chain, solver=solver), setup.surface)]


# Waves and pressure classes of the chain that comes nearest to direct contact on surfaces it was
# not chosen by, see docs/chain-and-direct-contact.md.
WAVES_OF_UPPER_HALF, CLASSES = 4, 8
# Points along each of its waves: within 0.2 % of 1024 on the shipped road, 3 mm/s to 30 m/s.
POINTS_OF_A_CLASS = 256


@_compared("chain_upper", "chain of the upper half, pressure in classes", "waves",
           "heights that touch, pressure as it is distributed", "chain_half_plane")  # fmt: skip
def _chain_upper(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    surface = setup.surface
    upper_already = surface.counted.get("top_height_fraction", 1.0) < 1.0
    cut_off_already = surface.sines.cut_off is not None
    if upper_already and cut_off_already and setup.chain.pressure_classes > 1:
        return []
    end, max_lag = surface.cutoff_wavelength, surface.counted.get("max_lag")
    sines = _of_upper_half(setup.lines, max_lag, end) if setup.lines else None
    if sines is None:
        return []
    solver = HalfPlane(points=POINTS_OF_A_CLASS)
    chain = replace(setup.chain, solver=solver, pressure_classes=CLASSES)
    return [SampleSpec(chain, Surface(sines, "waves of the upper half"))]


@lru_cache(maxsize=4)
def _of_upper_half(
    lines: tuple[Profile, ...], max_lag: float | None, cut_off: float
) -> SineStack | None:
    try:
        upper = height_difference(lines, top_height_fraction=0.5, max_lag=max_lag)
        return fit_sines(upper, scales=WAVES_OF_UPPER_HALF, cut_off=cut_off)
    except InputError:  # too few lags, or roughness that ends too near the first wave
        return None


LENGTH_OF_SINES = 10  # period of a surface of sines over its largest wave
_of_sines = lru_cache(maxsize=16)(surface_of_sines)  # drawn once for all loads


@_compared("sines", "direct contact, sine waves of the chain", "waves", "all scales together",
           "chain_half_plane")  # fmt: skip
def _sines(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    sines, length = setup.surface.sines, LENGTH_OF_SINES * float(setup.surface.sines.wavelength[0])
    lines = (_of_sines(sines, length, seed) for seed in range(setup.seeds))
    dry = setup.conditions and setup.conditions.dry  # lines have no pools
    in_full = replace(setup.direct, periodic=True, conditions=dry)
    return [SampleSpec(in_full, with_single_measurement(setup.surface, x)) for x in lines]


@_compared(DIRECT, "direct contact, measured surface", "measured", "the surface as measured",
           "sines")  # fmt: skip
def _direct(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    return _of_each(setup, setup.direct)


def _of_each(setup: ComparisonSetup, model: Model) -> Sequence[SampleSpec]:
    """Return a model on each profile or map."""
    return [SampleSpec(model, part, name) for name, part in each_measured(setup.surface)]


@_compared(ContinuedContact.name, "direct contact, continued below the measurement", _BELOW,
           "roughness below the measurement", DIRECT)  # fmt: skip
def _continued(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    measured = setup.surface.measured
    if setup.continuation is None or (measured is not None and measured.map is not None):
        return []
    return _of_each(setup, setup.continuation)


@lru_cache(maxsize=16)
def _spectrum(line: Profile) -> ArealSpectrum:
    return areal_spectrum(profile_spectrum(line))


@_compared("persson", "Persson, isotropic surface", "theory", follows=DIRECT)
def _persson(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    """Return each profile down to where the sine waves end, or its spectrum before them."""
    specs = []
    for name, part in each_measured(setup.surface):
        spectra = [_spectrum(line) for line in part.measured.followed] if part.measured else []
        ends = [float(2.0 * np.pi / spectrum.wavenumber[-1]) for spectrum in spectra]
        smallest = max(part.cutoff_wavelength, *ends)
        theory = Persson(smallest_wavelength=smallest, conditions=setup.conditions)
        specs.append(SampleSpec(theory, part, name))
    return specs


@_compared("klueppel_heinrich", "Klüppel & Heinrich", "theory", follows=DIRECT)
def _klueppel_heinrich(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    return [] if setup.klueppel_heinrich is None else _of_each(setup, setup.klueppel_heinrich)


# Windows of a profile in the block: length over the largest sine wave, waves that are kept at most
# (those of the roughness that the measurement has), and how many windows at most.
WINDOW, MOST_WAVES, MOST_WINDOWS = 1.1, 100, 16


def _on_windows(
    setup: ComparisonSetup, model: DirectContact | BlockOnProfile
) -> Sequence[SampleSpec]:
    """Return the windows of the profiles, the same for both models, with one cut-off."""
    sines = setup.surface.sines
    length = WINDOW * float(sines.wavelength[0])
    enough = tuple(line for line in setup.lines if line.length > length)
    if not enough:
        return []
    steps = 2.0 * max(line.step for line in enough)
    smallest = max(length / MOST_WAVES, float(sines.cutoff_wavelength), steps)
    return [
        SampleSpec(
            replace(model, smallest_wavelength=smallest),
            with_single_measurement(setup.surface, line),
            f"{line.name} from {line.x[0]:.4g} m",
        )
        for line in _windows(enough, length)[: setup.windows]
    ]


@lru_cache(maxsize=4)
def _windows(lines: tuple[Profile, ...], length: float) -> list[Profile]:
    """Return windows of which the first few are spread over the profiles as all are."""
    spread = spread_windows(lines, length, MOST_WINDOWS)
    bits = max(len(spread) - 1, 1).bit_length()
    halving = [int(f"{number:0{bits}b}"[::-1], 2) for number in range(len(spread))]
    return [spread[at] for at in np.argsort(halving, kind="stable")]


@_compared("windows_half_plane", "small-strain windows", WINDOWS)
def _windows_half_plane(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    # its error must not hide what a few per cent of finite strain change; it takes a second
    return _on_windows(setup, DirectContact(tolerance=0.2 * setup.tolerance, periodic=True))


@_compared("windows_finite_strain", "finite-strain windows", WINDOWS, "finite strain",
           "windows_half_plane")  # fmt: skip
def _windows_block(setup: ComparisonSetup) -> Sequence[SampleSpec]:
    return _on_windows(setup, BlockOnProfile(periodic=True))
