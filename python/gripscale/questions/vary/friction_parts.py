"""Friction by octave of wavelength, and by decade of relaxation time, in small-strain terms.

Derived in docs/derivations.md, "Friction by wavelength and relaxation time".
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core import labelled
from gripscale.core.arrays import Array
from gripscale.experiment.design import variable_attributes
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.variables import answer_number, of_hysteresis
from gripscale.rubber import Rubber
from gripscale.wave.result import harmonics

OCTAVE_UNIT = 1e-3  # length [m] of which the lower ends of octaves are multiples by powers of two
ON_EDGE = 1e-9  # decades by which rounding may move an end over the edge of a decade
_HARMONICS = 32  # harmonics of the contact pressure that count
# Decades up to which an element is a neighbour: further away is another process of relaxation.
NEAR = 1.0


def friction_by_decade(solved: xr.Dataset, rubber: Rubber) -> dict[int, float]:
    """Return the friction coefficient [-] of all waves by decade of relaxation time.

    From n, for relaxation times of 10^n s up to 10^(n+1) s, to its part. Empty where nothing
    slides, the rubber is elastic, a wave failed or the model has no waves. Of waves that say which
    rubber they met, conditions having made it another one, that one counts.
    """
    needed = {"surface_pressure", "angular_frequency", "friction"}
    if not needed <= set(solved.data_vars) or solved.prediction_status != "converged":
        return {}
    if solved.nominal_speed == 0.0:
        return {}
    parts = []
    order = np.arange(1, _HARMONICS + 1)
    for i in range(solved.sizes["scale"]):
        wave = solved.isel(scale=i)
        text = str(wave.rubber_parameters.item()) if "rubber_parameters" in wave else ""
        matching = Rubber.from_dict(json.loads(text)) if text else rubber
        omega = np.asarray(order * float(wave.angular_frequency), dtype=float)
        nodes = wave.surface_x.values, wave.surface_pressure.values
        pressure = harmonics(*nodes, float(wave.wavelength), order)
        weight = pressure**2 / np.abs(matching.complex_modulus(omega)) ** 2
        share = loss_by_element(matching, omega) @ weight
        total = float(share.sum())
        friction = share / total * float(wave.friction) if total > 0.0 else share
        parts.append((matching.relaxation_times, friction))
    return added_by_decade(parts)


def loss_by_element(rubber: Rubber, omega: Array) -> Array:
    """Return the parts of the Maxwell elements in E'' [Pa], shape (elements, frequencies)."""
    phase = rubber.relaxation_times[:, None] * omega
    return np.asarray(rubber.moduli[:, None] * phase / (1.0 + phase**2))


def added_by_decade(parts: Iterable[tuple[Array, Array]]) -> dict[int, float]:
    """Return parts of the friction, each at relaxation times [s], added by decade."""
    added: dict[int, float] = {}
    for times, friction in parts:
        for n, part in in_decades(np.log10(times), friction):
            added[n] = added.get(n, 0.0) + part
    return added


def in_decades(decade: Array, share: Array) -> Iterator[tuple[int, float]]:
    """Yield decades and the part of the shares of elements, at `decade` [decades], in each.

    An element without a neighbour on one side reaches as far there as on the other.
    """
    order = np.argsort(decade)
    half = np.diff(decade[order]) / 2.0
    half = np.where(2.0 * half <= NEAR, half, np.nan)
    below, above = np.append(np.nan, half), np.append(half, np.nan)
    lower, upper = (np.where(np.isnan(a), b, a) for a, b in ((below, above), (above, below)))
    lows, highs = decade[order] - np.nan_to_num(lower), decade[order] + np.nan_to_num(upper)
    for low, high, part in zip(lows, highs, share[order], strict=True):
        first, last = math.floor(low + ON_EDGE), math.floor(high - ON_EDGE)
        for n in range(first, max(first, last) + 1):
            inside = float(min(high, n + 1.0) - max(low, n))
            yield n, float(part * (inside / (high - low) if last > first else 1.0))


def over_decades(parts: dict[int, float]) -> dict[str, xr.DataArray]:
    """Return the variable of the friction by decade; nothing without a part."""
    if not parts:
        return {}
    text = "friction coefficient by relaxation time, split as at small strain"
    decades = sorted(parts)
    values = [parts[n] for n in decades]
    by_decade = xr.DataArray(values, {"decade": decades}, attrs=variable_attributes(text))
    return {"friction_by_decade": by_decade}


def with_decades(data: xr.Dataset) -> xr.Dataset:
    """Return a study with the friction of all decades of relaxation time from first to last."""
    if "friction_by_decade" not in data:
        return data
    data = data.reindex(decade=range(int(data.decade[0]), int(data.decade[-1]) + 1))
    parts = data.friction_by_decade.transpose(..., "decade")
    data = data.assign(friction_by_decade=parts.fillna(0.0).where(parts.notnull().any("decade")))
    time = [10.0**n for n in data.decade.values.tolist()]
    described = variable_attributes("relaxation time, from", "s")
    return data.assign_coords(decade=xr.Variable("decade", time, described))


def waves_by_octave(data: xr.Dataset) -> dict[str, Any]:
    """Return the friction of the waves of a chain by octave of wavelength."""
    friction = data["friction"].transpose(..., "scale").values
    number = np.log2(np.broadcast_to(data["wavelength"].values, friction.shape) / OCTAVE_UNIT)
    octave = np.floor(number + 1e-9)
    every = np.unique(octave[np.isfinite(octave)])
    parts = [np.where(octave == n, friction, 0.0).sum(axis=-1) for n in every]
    dims = tuple(dim for dim in data["friction"].dims if dim != "scale")
    ends = variable_attributes("shortest wavelength of the octave", "m")
    about = variable_attributes("friction coefficient of the octave")
    return {
        "octave": ("octave", OCTAVE_UNIT * 2.0**every, ends),
        "octave_friction": ((*dims, "octave"), np.stack(parts, -1), about),
    }


def parts_of_answer(
    answer: xr.Dataset, samples: xr.Dataset, rubber: Rubber, speed: float
) -> dict[str, Any]:
    """Return the friction of an answer by octave and by decade, from the samples of its profiles.

    `rubber` is that before the contact; an elastic one has no decades.
    """
    friction = answer_number(answer, of_hysteresis(answer, "friction")).value
    waves = samples["curve_wavelength"].values
    ends = reduce.octaves(float(np.nanmax(waves)), float(np.nanmin(waves)), OCTAVE_UNIT)
    running = reduce.running(samples, "friction", ends).values
    running = np.nan_to_num(running) / running[-1] * friction
    parts = np.diff(running, prepend=0.0)
    octaves = {
        "octave": labelled("octave", ends, "m", "shortest wavelength of the octave", DIRECT),
        "octave_friction": labelled("octave", parts, "1", "friction μ of the octave", DIRECT),
    }
    times = rubber.relaxation_times
    if not times.size:
        return octaves
    loss = loss_by_element(rubber, 2.0 * math.pi * speed / (math.sqrt(2.0) * ends))
    losses = (loss / loss.sum(axis=0) * parts).T
    return octaves | over_decades(added_by_decade((times, row) for row in losses))
