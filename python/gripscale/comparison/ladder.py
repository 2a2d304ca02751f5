"""The ladder: from the chain to the profile as measured, one assumption given up on each rung.

A new rung is a function that draws its samples and an entry in `LADDER`. What two rungs on the same
surfaces say of an assumption becomes a factor of the best estimate by an entry in
`gripscale.comparison.estimate.FACTORS`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

import numpy as np

from gripscale import checks
from gripscale.chain.model import Chain
from gripscale.comparison.rung import Draw, Rung, Subject
from gripscale.rough import random_phases, surface_of_sines
from gripscale.rough.model import DirectContact
from gripscale.surface import PreparedSurface, Profile, SineStack
from gripscale.surface.isotropy import areal_spectrum
from gripscale.surface.periodogram import profile_spectrum
from gripscale.surface.prepared import Measured
from gripscale.surface.spectrum import ArealSpectrum
from gripscale.theory.half_plane import HalfPlane
from gripscale.theory.models import Persson

DIRECT = "direct"
"""The rung the chain is judged by, and the best estimate starts from."""

LENGTH_OF_SINES = 10
"""Period of a surface of sines over its largest wave."""


def chosen(names: Iterable[str]) -> list[Rung]:
    """Return the rungs of the given names and groups, in the order of the ladder; all for none.

    Raises `InputError` for a name that is neither.
    """
    wanted = set(names)
    known = dict.fromkeys([*(rung.group for rung in LADDER), *(rung.name for rung in LADDER)])
    checks.known("rung", sorted(wanted), known)
    return [rung for rung in LADDER if not wanted or wanted & {rung.name, rung.group}]


def each_profile(surface: PreparedSurface) -> list[tuple[str, PreparedSurface]]:
    """Return `surface` with one of its profiles after the other, and what the profile is called."""
    lines = [] if surface.measured is None else surface.measured.cleaned
    return [(line.name or f"profile {i}", only(surface, line)) for i, line in enumerate(lines, 1)]


def only(surface: PreparedSurface, line: Profile) -> PreparedSurface:
    """Return the waves of `surface` with `line` as the only profile."""
    return PreparedSurface(surface.sines, line.name, measured=Measured.of([line]))


def _chain(subject: Subject) -> Sequence[Draw]:
    small_strain = isinstance(subject.solver, HalfPlane)
    return [] if small_strain else [Draw(Chain(subject.solver), subject.surface)]


def _chain_half_plane(subject: Subject) -> Sequence[Draw]:
    solver = subject.solver if isinstance(subject.solver, HalfPlane) else HalfPlane()
    return [Draw(Chain(solver), subject.surface)]


def _sines(subject: Subject) -> Sequence[Draw]:
    model, surface = DirectContact(tolerance=subject.tolerance), subject.surface
    lines = (_of_sines(surface.sines, seed) for seed in range(subject.seeds))
    return [Draw(model, only(surface, line)) for line in lines]


def _random_phases(subject: Subject) -> Sequence[Draw]:
    model, surface = DirectContact(tolerance=subject.tolerance), subject.surface
    lines = [] if surface.measured is None else surface.measured.cleaned
    return [
        Draw(model, only(surface, _shuffled(line, seed)), line.name)
        for line in lines
        for seed in range(subject.seeds)
    ]


def _direct(subject: Subject) -> Sequence[Draw]:
    model = DirectContact(tolerance=subject.tolerance)
    return [Draw(model, one, name) for name, one in each_profile(subject.surface)]


def _persson(subject: Subject) -> Sequence[Draw]:
    return [
        Draw(Persson(smallest_wavelength=_last_known(one)), one, name)
        for name, one in each_profile(subject.surface)
    ]


def _last_known(surface: PreparedSurface) -> float:
    """Return the smallest sine wave [m], or where the spectrum of the profile ends before it."""
    spectra = [_spectrum(line) for line in surface.measured.cleaned] if surface.measured else []
    ends = [float(2.0 * np.pi / spectrum.wavenumber[-1]) for spectrum in spectra]
    return max(float(surface.sines.wavelength[-1]), *ends)


def _klueppel_heinrich(subject: Subject) -> Sequence[Draw]:
    theory = subject.klueppel_heinrich
    if theory is None:
        return []
    return [Draw(theory, one, name) for name, one in each_profile(subject.surface)]


@lru_cache(maxsize=16)
def _of_sines(sines: SineStack, seed: int) -> Profile:
    return surface_of_sines(sines, LENGTH_OF_SINES * float(sines.wavelength[0]), seed)


@lru_cache(maxsize=16)
def _spectrum(line: Profile) -> ArealSpectrum:
    return areal_spectrum(profile_spectrum(line))


@lru_cache(maxsize=64)
def _shuffled(line: Profile, seed: int) -> Profile:
    """Draw once what is met at every load."""
    return random_phases(line, seed)


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
        "sines",
        "its sine waves at once",
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
)
"""All rungs, in order; a new one is added here."""
