"""How strongly a wave strains the rubber it touches."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gripscale.conditions.conditions import StrainNorm
from gripscale.errors import InputError
from gripscale.wave.result import WaveResult


def strains(waves: Sequence[WaveResult], norm: StrainNorm) -> list[float]:
    """Return the strain amplitude [-] on each wave, largest wave first.

    Raises `InputError` for the stretches of a solver that gives none.
    """
    if norm == "stretch":
        return [_largest_strain(wave) for wave in waves]
    squares = np.cumsum([(0.5 * contact_slope(wave)) ** 2 for wave in waves])
    return [float(e) for e in np.sqrt(squares)]


def contact_slope(wave: WaveResult) -> float:
    """Return the rms slope of a solved wave in its contact [-]."""
    k = 2.0 * math.pi / wave.wavelength
    edges = np.asarray(wave.details["contact_edges"], dtype=float)
    start, end = k * edges[:, 0], k * edges[:, 1]
    square = 0.5 - (np.sin(2.0 * end) - np.sin(2.0 * start)).sum() / (4.0 * (end - start).sum())
    return float(k * wave.amplitude * math.sqrt(max(square, 0.0)))


def _largest_strain(wave: WaveResult) -> float:
    strain = max(wave.max_stretch - 1.0, 1.0 - wave.min_stretch)
    if not math.isfinite(strain):
        raise InputError(
            f'strain_norm must be "slope" for a solver without stretches; got "stretch" '
            f"with {wave.model}"
        )
    return strain
