"""From the answers on all roads to one Dataset: totals, ranges, differences, and where they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.differences import TOTALS, attributes, ranges, to_first, total_differences
from gripscale.model import TOTALS as OF_ALL
from gripscale.roads.by_octave import octave_ends, running_friction
from gripscale.surface import PreparedSurface, profile_spectrum
from gripscale.uncertainty.quantiles import quantiles

MODELS = ("chain", "direct")
AS_MEASURED, TO_COMPARE = "as measured", "what its samples are compared with"
PER_DECADE = 12
"""Lags and wavenumbers at which roads are drawn together."""


Answers = Mapping[tuple[str, str], xr.Dataset]
"""Answers by model and road."""


class Place(NamedTuple):
    """One prediction: of which model on which road, and what of it."""

    model: str
    surface: str
    part: str


def roads_dataset(
    surfaces: Mapping[str, PreparedSurface], solved: Mapping[Place, xr.Dataset]
) -> xr.Dataset:
    """Return what `gripscale.roads.compare_surfaces` promises."""
    own = {(p.model, p.surface): answer for p, answer in solved.items() if p.part == AS_MEASURED}
    data = xr.Dataset(
        {
            **{name: _totals(own, list(surfaces), name) for name in OF_ALL},
            "prediction_status": _status(own, list(surfaces)),
        },
        {"model": list(MODELS), "surface": list(surfaces)},
        {"title": "Contact and friction of one rubber on several roads"},
    )
    factors = {name: _factors(solved, list(surfaces), name) for name in TOTALS}
    if any(np.isfinite(found).any() for found in factors.values()):
        text = "that another stretch of the road might give"
        data = data.assign(ranges(data, ["model", "surface"], factors, text))
    data = data.assign(total_differences(data, "surface"))
    data = data.assign(_by_octave(own, list(surfaces)))
    text = "difference to the first, friction of the octave"
    parts = data.friction_running.diff("octave", label="upper")
    first = data.friction_running.isel(octave=[0])
    octaves = xr.concat([first, parts], dim="octave")
    data = data.assign(friction_difference=to_first(octaves, "surface", text))
    return data.assign(_measured(surfaces))


def _totals(own: Answers, names: list[str], quantity: str) -> xr.Variable:
    values = [
        [float(own[m, name][quantity]) if (m, name) in own else np.nan for name in names]
        for m in MODELS
    ]
    return xr.Variable(("model", "surface"), values, attributes(OF_ALL[quantity]))


def _status(own: Answers, names: list[str]) -> xr.Variable:
    values = [
        [str(own[m, n].prediction_status.item()) if (m, n) in own else "" for n in names]
        for m in MODELS
    ]
    told = attributes("converged, why not, or empty if it was not asked")
    return xr.Variable(("model", "surface"), np.array(values, dtype=object), told)


def _factors(
    solved: Mapping[Place, xr.Dataset], names: list[str], quantity: str
) -> NDArray[np.float64]:
    """Return the ends of 90 % of the samples over what they are compared with.

    Shape (2, models, roads), with 1 between the ends.
    """
    ends = np.full((2, len(MODELS), len(names)), np.nan)
    for i, model in enumerate(MODELS):
        for j, name in enumerate(names):
            base = solved.get(Place(model, name, TO_COMPARE))
            if base is None:
                continue
            samples = [
                float(answer[quantity])
                for place, answer in solved.items()
                if place[:2] == (model, name) and place.part not in (AS_MEASURED, TO_COMPARE)
            ]
            found = quantiles(np.array(samples) / float(base[quantity]))
            ends[:, i, j] = min(found[0], 1.0), max(found[-1], 1.0)
    return ends


def _by_octave(own: Answers, names: list[str]) -> dict[str, xr.DataArray]:
    """Return the friction of all longer waves over octaves that all models and roads share."""
    lengths = [one["wavelength"].values for one in own.values() if "wavelength" in one]
    known = np.concatenate(lengths)
    ends = octave_ends(2.0 * float(np.nanmax(known)), float(np.nanmin(known)) * (1.0 + 1e-9))
    values = np.full((len(MODELS), len(names), ends.size), np.nan)
    for (model, name), answer in own.items():
        values[MODELS.index(model), names.index(name)] = running_friction(answer, ends)
    octave = xr.Variable("octave", ends, {"units": "m", "long_name": "shortest wave of the octave"})
    running = xr.DataArray(
        values,
        coords={"model": list(MODELS), "surface": names, "octave": octave},
        dims=("model", "surface", "octave"),
        attrs=attributes("friction coefficient of the octave and all longer waves"),
    )
    return {"friction_running": running}


def _measured(surfaces: Mapping[str, PreparedSurface]) -> dict[str, Any]:
    """Return height difference correlation and spectrum of the roads that were measured."""
    correlations, spectra = {}, {}
    for name, surface in surfaces.items():
        if surface.correlation is not None:
            correlations[name] = (surface.correlation.lag, surface.correlation.value)
        if surface.measured is not None:
            spectrum = profile_spectrum(surface.measured.cleaned).averaged()
            spectra[name] = (spectrum.wavenumber, spectrum.density)
    out: dict[str, Any] = {}
    for name, axis, curves, unit, units, text in (
        ("correlation", "lag", correlations, "m", "m2", "height difference correlation C_z"),
        ("spectrum", "wavenumber", spectra, "rad/m", "m3", "one-sided power spectrum of lines"),
    ):
        if curves:
            places, values = _together(curves, list(surfaces))
            out[name] = (("surface", axis), values, {"units": units, "long_name": text})
            out[axis] = (axis, places, {"units": unit, "long_name": axis})
    return out


def _together(
    curves: Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]], names: list[str]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return curves of positive numbers at common places, NaN beyond the ends of each."""
    low, high = (pick(float(pick(x)) for x, _ in curves.values()) for pick in (min, max))
    places = np.geomspace(low, high, max(2, int(PER_DECADE * np.log10(high / low)) + 1))
    values = np.full((len(names), places.size), np.nan)
    for name, (x, y) in curves.items():
        good = (x > 0.0) & (y > 0.0)
        logs = np.interp(np.log(places), np.log(x[good]), np.log(y[good]), np.nan, np.nan)
        values[names.index(name)] = np.exp(logs)
    return places, values
