"""Samples of the rungs that correct the direct contact of a line: finite strain, and a whole map.

Each correction is the ratio of two rungs on the same surfaces, see
`gripscale.comparison.estimate.FACTORS`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from gripscale.comparison.rung import Draw, Subject, only
from gripscale.model import Model
from gripscale.rough.model import DirectContact
from gripscale.surface import Profile
from gripscale.surface.maps.isotropic import STEPS_IN_WAVE
from gripscale.surface.maps.measured import FEWEST_PERIODS
from gripscale.wave.model import BlockOnProfile

WINDOW, MOST_WAVES, WINDOWS = 1.1, 190, 8
"""Windows of a profile in the block: length over the largest sine wave, waves that are kept at most
(those of the roughness that the measurement has), and how many windows at most."""

MAP, WAVES_IN_MAP, MAPS, LINES = 1.8, 128, 2, 10
"""Synthetic maps: least length over the largest sine wave, length over the smallest wave that is
kept, how many, and how many lines of each are solved each way."""


def windows_half_plane(subject: Subject) -> Sequence[Draw]:
    """Return windows of the profiles for the half-space."""
    return _on_windows(subject, DirectContact(tolerance=subject.tolerance, periodic=True))


def windows_finite_strain(subject: Subject) -> Sequence[Draw]:
    """Return the same windows for the block."""
    return _on_windows(subject, BlockOnProfile(periodic=True))


def maps(subject: Subject) -> Sequence[Draw]:
    """Return synthetic isotropic maps of the profiles."""
    return _on_maps(subject, 0)


def lines_of_maps(subject: Subject) -> Sequence[Draw]:
    """Return lines of the same maps."""
    return _on_maps(subject, LINES)


def _on_windows(subject: Subject, model: Model) -> Sequence[Draw]:
    measured, sines = subject.surface.measured, subject.surface.sines
    lines = () if measured is None else tuple(measured.cleaned)
    length = WINDOW * float(sines.wavelength[0])
    return [
        Draw(
            model,
            only(subject.surface, line),
            f"{line.name} from {line.x[0]:.4g} m",
        )
        for line in _windows(lines, length, float(sines.roughness_end))
    ]


@lru_cache(maxsize=4)
def _windows(lines: tuple[Profile, ...], length: float, end: float) -> list[Profile]:
    """Return windows of the profiles that are long enough for one, with waves down to `end`."""
    from gripscale.rough import spread_windows  # scipy.stats with it: 0.3 s, which no run pays

    enough = [line for line in lines if line.length > length]
    if not enough:
        return []
    smallest = max(length / MOST_WAVES, end, 2.0 * max(line.step for line in enough))
    return spread_windows(enough, length, WINDOWS, smallest)


def _on_maps(subject: Subject, lines: int) -> Sequence[Draw]:
    """Return the maps; none of a surface that is a map, or whose profiles are too short."""
    from gripscale.rough.map_model import SyntheticMap

    surface = subject.surface
    if surface.measured is None or surface.measured.map is not None:
        return []
    cleaned, sines = surface.measured.cleaned, surface.sines
    step = max(line.step for line in cleaned)
    smallest = max(
        MAP * sines.wavelength[0] / WAVES_IN_MAP, sines.roughness_end, STEPS_IN_WAVE * step
    )
    if sum(line.length for line in cleaned) < FEWEST_PERIODS * WAVES_IN_MAP * smallest:
        return []
    return [
        Draw(
            SyntheticMap(seed, float(smallest), lines, tolerance=subject.tolerance),
            surface,
            f"map {seed}",
        )
        for seed in range(MAPS)
    ]
