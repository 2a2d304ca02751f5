"""The ladder: from the chain to the profile as measured, one assumption given up on each rung.

A new rung is a function that draws its samples and an entry in `LADDER`. What two rungs on the same
surfaces say of an assumption becomes a factor of the best estimate by an entry in
`gripscale.comparison.estimate.FACTORS`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import TypeVar

import numpy as np

from gripscale import checks
from gripscale.chain.model import Chain
from gripscale.comparison.corrections import (
    lines_of_maps,
    maps,
    windows_finite_strain,
    windows_half_plane,
)
from gripscale.comparison.rung import Draw, Rung, Subject, only
from gripscale.errors import InputError
from gripscale.rough import random_phases, surface_of_sines
from gripscale.rough.model import DirectContact
from gripscale.surface import (
    HeightMap,
    PreparedSurface,
    Profile,
    SineStack,
    fit_sines,
    height_difference,
)
from gripscale.surface.isotropy import areal_spectrum
from gripscale.surface.periodogram import profile_spectrum
from gripscale.surface.spectrum import ArealSpectrum
from gripscale.theory.half_plane import HalfPlane
from gripscale.theory.models import Persson
from gripscale.wave.solver import WaveSolver

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
    checks.known("rung", sorted(wanted), [*groups, *(rung.name for rung in LADDER)])
    return [rung for rung in LADDER if not wanted or wanted & {rung.name, rung.group}]


def each_measured(surface: PreparedSurface) -> list[tuple[str, PreparedSurface]]:
    """Return `surface` with one profile after the other, or its map, and what it is called."""
    measured: Sequence[Profile | HeightMap] = surface.measured.surfaces if surface.measured else []
    return [(one.name or f"profile {i}", only(surface, one)) for i, one in enumerate(measured, 1)]


def _chain(subject: Subject) -> Sequence[Draw]:
    small_strain = isinstance(subject.solver, HalfPlane)
    if small_strain:
        return []
    return [Draw(_chain_of(subject, subject.solver), subject.surface)]


def _chain_of(subject: Subject, solver: WaveSolver) -> Chain:
    return Chain(solver, pressure_classes=subject.pressure_classes, conditions=subject.conditions)


def _direct_of(subject: Subject) -> DirectContact:
    return DirectContact(tolerance=subject.tolerance, conditions=subject.conditions)


def _chain_half_plane(subject: Subject) -> Sequence[Draw]:
    solver = subject.solver if isinstance(subject.solver, HalfPlane) else HalfPlane()
    return [Draw(_chain_of(subject, solver), subject.surface)]


def _chain_upper(subject: Subject) -> Sequence[Draw]:
    surface = subject.surface
    upper_already = surface.counted.get("upper_share", 1.0) < 1.0
    cut_off_already = surface.sines.cut_off is not None
    if upper_already and cut_off_already and subject.pressure_classes > 1:
        return []
    lines = () if surface.measured is None else tuple(surface.measured.cleaned)
    end = surface.sines.roughness_end
    sines = _of_upper_half(lines, surface.counted.get("max_lag"), end) if lines else None
    if sines is None:
        return []
    solver = HalfPlane(points=POINTS_OF_A_CLASS)
    chain = Chain(solver, pressure_classes=CLASSES, conditions=subject.conditions)
    return [Draw(chain, PreparedSurface(sines, "waves of the upper half"))]


@lru_cache(maxsize=4)
def _of_upper_half(
    lines: tuple[Profile, ...], max_lag: float | None, cut_off: float
) -> SineStack | None:
    """Return waves of the upper half of the heights; None where they cannot be fitted."""
    try:
        upper = height_difference(lines, upper_share=0.5, max_lag=max_lag)
        return fit_sines(upper, scales=WAVES_OF_UPPER_HALF, cut_off=cut_off)
    except InputError:  # too few lags, or roughness that ends too near the first wave
        return None


def _sines(subject: Subject) -> Sequence[Draw]:
    model, surface = _direct_of(subject), subject.surface
    lines = (_of_sines(surface.sines, seed) for seed in range(subject.seeds))
    return [Draw(model, only(surface, line)) for line in lines]


def _random_phases(subject: Subject) -> Sequence[Draw]:
    model, surface = _direct_of(subject), subject.surface
    measured = [] if surface.measured is None else surface.measured.surfaces
    return [
        Draw(model, only(surface, _shuffled(one, seed)), one.name)
        for one in measured
        for seed in range(subject.seeds)
    ]


def _direct(subject: Subject) -> Sequence[Draw]:
    model = _direct_of(subject)
    return [Draw(model, one, name) for name, one in each_measured(subject.surface)]


def _persson(subject: Subject) -> Sequence[Draw]:
    return [
        Draw(Persson(smallest_wavelength=_last_known(one)), one, name)
        for name, one in each_measured(subject.surface)
    ]


def _last_known(surface: PreparedSurface) -> float:
    """Return where the sine waves end [m], or the spectrum of the profile before them."""
    spectra = [_spectrum(line) for line in surface.measured.cleaned] if surface.measured else []
    ends = [float(2.0 * np.pi / spectrum.wavenumber[-1]) for spectrum in spectra]
    return max(surface.sines.roughness_end, *ends)


def _klueppel_heinrich(subject: Subject) -> Sequence[Draw]:
    theory = subject.klueppel_heinrich
    if theory is None:
        return []
    return [Draw(theory, one, name) for name, one in each_measured(subject.surface)]


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
