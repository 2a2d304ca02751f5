"""Which relaxation times of the rubber make the friction: an estimate in small-strain terms.

The contact pressure of one wave has harmonics p_k. On a half-plane of modulus E*, harmonic k
dissipates, per sliding distance and up to factors common to all of them,

    D_k = |p_k|^2 E''(w_k) / |E*(w_k)|^2,       w_k = 2 pi k v / lambda,

and E'' is a sum over the Maxwell elements (Ferry, Viscoelastic Properties of Polymers, 3rd ed.
(1980), ch. 3), so each D_k splits into their parts. The parts, added by decade of relaxation time
and scaled to the friction coefficient that was solved, are what is returned: the pressure is the
solver's, at finite strain; the split is that of small strain.

A series samples a continuous spectrum (Ferry, ch. 4), so an element stands for the times between
it and half way to its neighbours. Where it only stood for its own, a whole share would jump from
one decade into the next as a temperature shifts the times.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.rubber import Rubber
from gripscale.wave.harmonics import harmonics

ON_EDGE = 1e-9
"""Decades by which rounding may move an end over the edge of a decade."""
HARMONICS = 32
"""Harmonics of the contact pressure that count."""

NEAR = 1.0
"""Decades up to which an element is a neighbour: further away is another process of relaxation."""

Array = NDArray[np.float64]


def friction_by_decade(solved: xr.Dataset, rubber: Rubber) -> dict[int, float]:
    """Return the friction coefficient of all waves by decade of relaxation time.

    Parameters
    ----------
    solved
        A prediction in motion, as `Prediction.to_dataset` returns it.
    rubber
        What it was solved for; of waves that say which rubber they met, that one counts.

    Returns
    -------
    dict
        From n, for relaxation times of 10^n s up to 10^(n+1) s, to its part of the friction
        coefficient [-]. Empty where nothing slides, the rubber is elastic, a wave failed or the
        model has no waves.
    """
    needed = {"surface_pressure", "angular_frequency", "friction"}
    if not needed <= set(solved.data_vars) or solved.prediction_status != "converged":
        return {}
    if solved.nominal_speed == 0.0:
        return {}
    parts: dict[int, float] = {}
    for i in range(solved.sizes["scale"]):
        wave = solved.isel(scale=i)
        own = _rubber_of(wave, rubber)
        share = _shares(wave, own) * float(wave.friction)
        for n, part in _in_decades(np.log10(own.relaxation_times), share):
            parts[n] = parts.get(n, 0.0) + part
    return parts


def _in_decades(place: Array, share: Array) -> Iterator[tuple[int, float]]:
    """Yield decades and the part of the shares of elements, at `place` [decades], in each."""
    order = np.argsort(place)
    for low, high, part in zip(*_ends(place[order]), share[order], strict=True):
        first, last = math.floor(low + ON_EDGE), math.floor(high - ON_EDGE)
        for n in range(first, max(first, last) + 1):
            inside = float(min(high, n + 1.0) - max(low, n))
            yield n, float(part * (inside / (high - low) if last > first else 1.0))


def _ends(place: Array) -> tuple[Array, Array]:
    """Return from where to where each element reaches [decades], places in rising order.

    Without a neighbour on one side it reaches as far there as on the other.
    """
    half = np.diff(place) / 2.0
    half = np.where(2.0 * half <= NEAR, half, np.nan)
    below, above = np.append(np.nan, half), np.append(half, np.nan)
    left, right = (np.where(np.isnan(a), b, a) for a, b in ((below, above), (above, below)))
    return place - np.nan_to_num(left), place + np.nan_to_num(right)


def _rubber_of(wave: xr.Dataset, rubber: Rubber) -> Rubber:
    """Return the rubber a wave met: conditions may have made it another one than was given."""
    text = str(wave.rubber_parameters.item()) if "rubber_parameters" in wave else ""
    return Rubber.from_dict(json.loads(text)) if text else rubber


def _shares(wave: xr.Dataset, rubber: Rubber) -> Array:
    """Return the part of each Maxwell element in the dissipation of one wave, adding to one."""
    order = np.arange(1, HARMONICS + 1)
    omega = order * float(wave.angular_frequency)
    pressure = harmonics(
        wave.surface_x.values, wave.surface_pressure.values, float(wave.wavelength), order
    )
    weight = pressure**2 / np.abs(rubber.complex_modulus(omega)) ** 2
    phase = omega[:, None] * rubber.relaxation_times
    loss = rubber.moduli * phase / (1.0 + phase**2)
    parts = weight @ loss
    total = float(parts.sum())
    return np.asarray(parts / total if total > 0.0 else parts)
