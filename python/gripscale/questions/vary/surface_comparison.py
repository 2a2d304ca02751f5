"""Roads under the same rubber and load, in chain and direct contact, with their differences.

Differences are those to the first road. What another stretch of each road might have given is the
range of 90 % of n block bootstraps of its profiles (`gripscale.questions.ProfileBlocks`),

    low = X min(1, q_5(X_k/X_0)),    high = X max(1, q_95(X_k/X_0))

with X_k of the drawn blocks and X_0 of the road as measured; of the chain by half-planes, which
cost less, of the direct contact by itself to twice the error of the best estimate. Friction of X is
that from dissipation, which a coarse grid changes less. The roads are independent of each other,
see `gripscale.questions.vary.rubber_comparison.total_differences`.

What is to be believed are the best estimates of the direct contact, and their ratios to the first
(`gripscale.questions.vary.rubber_comparison.ratios_to_first`).
"""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.core import checks, provenance
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.experiment.design import (
    Design,
    Point,
    basis_numbers,
    solve_design,
    surface_numbers,
    variable_attributes,
)
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.experiment.task import Task
from gripscale.half_space.model import JUDGED_TO, DirectContact
from gripscale.model import STATUS, STATUS_WORD, Load, Model, input_doubts
from gripscale.model import TOTALS as OF_ALL
from gripscale.questions.answer.best_estimate import POINT_ESTIMATES, with_best_estimate
from gripscale.questions.uncertainty.propagation import quantiles
from gripscale.questions.uncertainty.sampled_inputs import FailSafeModel, Inputs, Measurement
from gripscale.questions.uncertainty.sampling import draws
from gripscale.questions.uncertainty.sources import SOURCES, SourceOptions
from gripscale.questions.vary import rubber_comparison
from gripscale.questions.vary.inputs import model_of, reading_notes, surface_of
from gripscale.questions.vary.side_by_side import Roads
from gripscale.surface import Surface, profile_spectrum
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, with_profile
from gripscale.surface.texture import textures
from gripscale.theory.half_plane import HalfPlane


def octave_ends(longest: float, shortest: float) -> Array:
    """Return the lower ends of octaves [m] from `longest` to `shortest`: powers of two of 1 mm."""
    first, last = np.ceil(np.log2(longest / 1e-3)), np.floor(np.log2(shortest / 1e-3))
    return np.asarray(1e-3 * 2.0 ** np.arange(first, last - 1.0, -1.0))


def friction_curve(answer: xr.Dataset) -> xr.Dataset:
    """Return the friction of all waves not shorter than each `curve_wavelength`, over `curve`.

    Of an answer of the chain, or of the direct contact; empty without its parts by wavelength.
    """
    if "octave_friction" in answer:
        parts = (answer["octave_friction"].fillna(0.0) * answer["weight"]).sum("profile")
        ordered = parts.sortby("wavelength", ascending=False)
        wavelength, friction = ordered["wavelength"].values, ordered.values
    elif "friction" in answer and answer["friction"].dims == ("scale",):
        wavelength, friction = answer["wavelength"].values, answer["friction"].values
    else:
        return xr.Dataset()
    columns = {"curve_wavelength": wavelength, "curve_friction": np.cumsum(friction)}
    return xr.Dataset({name: ("curve", values) for name, values in columns.items()})


def running_friction(wavelength: Array, friction: Array, ends: Array) -> Array:
    """Return the friction [-] of all waves longer than each of `ends` [m], which fall.

    Of a curve as in `friction_curve`; what is NaN in it does not count, NaN without a curve.
    Between the waves of a chain, and within the octaves of a direct contact, it is taken to be
    linear in the logarithm of the wavelength, as frictions add.
    """
    finite = np.isfinite(wavelength)
    if not finite.any():
        return np.full(ends.shape, np.nan)
    places, running = -np.log(wavelength[finite]), friction[finite]
    return np.asarray(np.interp(-np.log(ends), places, running, left=0.0, right=running[-1]))


_MODELS = ("chain", "direct")
_PER_DECADE = 12
"""Lags and wavenumbers at which roads are drawn together."""

DRAWN = {
    "total_friction": "total_friction_from_dissipation",
    "total_contact_fraction": "total_contact_fraction",
}
"""Totals with a range, and which number of the drawn samples says how far it reaches."""

AS_MEASURED, REFERENCE = 0, 1
"""Samples before the drawn ones: the road, and what its drawn samples are compared with."""


def road_numbers(answer: xr.Dataset, task: Task) -> xr.Dataset:
    """Return what is kept of the answer on one road: totals and friction by wavelength."""
    kept = surface_numbers(answer, task)[[*OF_ALL, STATUS, STATUS_WORD]]
    return kept.assign(basis_numbers(answer)).assign(friction_curve(answer))


def roads_dataset(surfaces: Mapping[str, Surface], solved: xr.Dataset) -> xr.Dataset:
    """Return what `gripscale.questions.compare_surfaces` promises, of answers by sample."""
    roads = solved.isel(sample=AS_MEASURED)
    words = OF_ALL | {
        STATUS: "converged, why not, or empty if it was not asked",
        STATUS_WORD: "word of the status",
    }
    data = xr.Dataset(
        {
            name: roads[name].drop_attrs().assign_attrs(variable_attributes(text))
            for name, text in words.items()
        },
        attrs={"title": "Contact and friction of one rubber on several roads"},
    )
    if solved.sizes["sample"] > REFERENCE:
        drawn = solved.isel(sample=slice(REFERENCE + 1, None))
        ratios = {
            name: drawn[measure] / solved[measure].isel(sample=REFERENCE)
            for name, measure in DRAWN.items()
        }
        levels = {name: quantiles(values) for name, values in ratios.items()}
        ends = {
            name: (level.isel(quantile=0).clip(max=1.0), level.isel(quantile=-1).clip(min=1.0))
            for name, level in levels.items()
        }
        if any(low.notnull().any() for low, _ in ends.values()):
            data = data.assign(
                rubber_comparison.ranges(data, ends, "that another stretch of the road might give")
            )
    running = _by_octave(roads)
    parts = running.diff("octave", label="upper")
    octaves = xr.concat([running.isel(octave=[0]), parts], dim="octave")
    text = "difference to the first, friction of the octave"
    by_octave = {
        "friction_running": running,
        "friction_difference": rubber_comparison.to_first(octaves, "surface", text),
    }
    return data.assign(
        rubber_comparison.total_differences(data, "surface") | by_octave | _measured(surfaces)
    ).assign(_best(surfaces, roads))


def _best(surfaces: Mapping[str, Surface], roads: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the best estimates of the roads, and the ratios to the first that are believed.

    Of roads without a direct contact the ratios of the chain, which have no interval.
    """
    direct = roads.sel(model=DirectContact.name, drop=True)
    if bool((direct[STATUS] == "").any()):
        return rubber_comparison.ratios_to_first(roads.sel(model=Chain.name, drop=True), "surface")
    best = with_best_estimate(direct)
    names = [name for name in best if name in POINT_ESTIMATES]
    widths = {}
    for name in rubber_comparison.COMPARED_QUANTITIES:
        half_width = best[f"best_{name}_half_width"]
        width = half_width.copy(data=np.arcsinh(half_width.values))
        widths[name] = width, width
    ratios = rubber_comparison.ratios_to_first(best, "surface", widths)
    return {str(name): best[name] for name in names} | ratios


def _by_octave(roads: xr.Dataset) -> xr.DataArray:
    """Return the friction of all longer waves over octaves that all models and roads share."""
    longest, shortest = float(roads.curve_wavelength.max()), float(roads.curve_wavelength.min())
    ends = octave_ends(2.0 * longest, shortest * (1.0 + 1e-9))
    running: xr.DataArray = xr.apply_ufunc(
        lambda wavelength, friction: running_friction(wavelength, friction, ends),
        roads.curve_wavelength,
        roads.curve_friction,
        input_core_dims=[["curve"], ["curve"]],
        output_core_dims=[["octave"]],
        vectorize=True,
    )
    octave = xr.Variable("octave", ends, variable_attributes("shortest wave of the octave", "m"))
    text = "friction coefficient of the octave and all longer waves"
    return running.assign_coords(octave=octave).assign_attrs(variable_attributes(text))


def _measured(surfaces: Mapping[str, Surface]) -> dict[str, Any]:
    """Return height difference correlation and spectrum of the roads that were measured.

    At common places, NaN beyond the ends of each.
    """
    curves: dict[str, dict[str, tuple[Array, Array]]] = {"correlation": {}, "spectrum": {}}
    for name, surface in surfaces.items():
        if surface.correlation is not None:
            curves["correlation"][name] = (surface.correlation.lag, surface.correlation.value)
        if surface.measured is not None:
            spectrum = profile_spectrum(surface.measured.followed).averaged()
            curves["spectrum"][name] = (spectrum.wavenumber, spectrum.density)
    out: dict[str, Any] = {}
    for name, axis, unit, units, text in (
        ("correlation", "lag", "m", "m2", "height difference correlation C_z"),
        ("spectrum", "wavenumber", "rad/m", "m3", "one-sided power spectrum of lines"),
    ):
        if not curves[name]:
            continue
        low, high = (pick(float(pick(x)) for x, _ in curves[name].values()) for pick in (min, max))
        places = np.geomspace(low, high, max(2, int(_PER_DECADE * np.log10(high / low)) + 1))
        values = np.full((len(surfaces), places.size), np.nan)
        for road, (x, y) in curves[name].items():
            good = (x > 0.0) & (y > 0.0)
            logs = np.interp(np.log(places), np.log(x[good]), np.log(y[good]), np.nan, np.nan)
            values[list(surfaces).index(road)] = np.exp(logs)
        out[name] = (("surface", axis), values, variable_attributes(text, units))
        out[axis] = (axis, places, variable_attributes(axis, unit))
    return out


_POINTS = 128
"""Points of the half-planes that tell the range: only ratios of theirs count."""
_TOLERANCE = 2.0 * JUDGED_TO
"""Estimated relative error of the direct contacts that tell the range, of which ratios count.

On the first full grid the friction from traction of steep roads is half of what it is.
"""
_FEWEST_SAMPLES, _MOST_SAMPLES = 10, 10_000
SAMPLES = 20
SEED = 0


def compare_surfaces(
    case: Case,
    surfaces: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    samples: int | None = SAMPLES,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Roads:
    """Predict area and friction of a case's rubber on several roads, and compare them.

    Raises `InputError` or `FileError` if there are fewer than two or more than six roads, or one
    cannot be read.

    Parameters
    ----------
    case
        The case, or its file: rubber, load, solver and conditions are taken from it.
    surfaces
        Two to six roads by what they are called; the others are compared with the first. Each is a
        `Surface`, a `SineStack`, "case", a surface known by name, another case, or a
        profile (of a case on a map, a map), read with all other settings of the case but the crop.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    samples : int or None
        Block bootstraps of each road, 10 to 10 000, for the range of its totals; None: no ranges.
    workers, on_task
        As for `gripscale.experiment.solve_all`.

    Returns
    -------
    Roads
        Over `model` and `surface`: the totals, `total_friction_low` and so on, `..._difference` to
        the first with its `_low` and `_high`; over `surface` the best estimates `best_friction` and
        so on (`with_best_estimate`) and `friction_ratio` to the first and so on,
        with its `_low` and `_high`; over `octave` of wavelength `friction_running`, from
        the longest wave down, and `friction_difference`; over `surface` the texture
        (`gripscale.surface.texture`); `correlation` over `lag` and `spectrum` over `wavenumber`.
    """
    rubber_comparison.require_some("surfaces", surfaces, "roads")
    if samples is not None:
        checks.whole("samples", samples, least=_FEWEST_SAMPLES, most=_MOST_SAMPLES)
    roads = {
        # a synthetic road with its profile, for the direct contact
        name: with_profile(value)
        if isinstance(value, str) and value in SYNTHETIC_SURFACES
        else surface_of(value, case)
        for name, value in surfaces.items()
    }
    load, rubber = case.load, case.rubber
    points: list[Point] = []
    notes = [*reading_notes(surfaces.values())]
    for (i, name), (j, (road, surface)) in product(enumerate(_MODELS), enumerate(roads.items())):
        model = model_of(name, case, JUDGED_TO)
        if "measurement" in model.needs and surface.measured is None:
            notes.append(f"{road} was not measured: no direct contact")
            continue
        task = Task(rubber, surface, load, FailSafeModel(model))
        points.append(Point((i, j, AS_MEASURED), f"{name}, {road}, as measured", task))
        if samples is None:
            continue
        measurement = Measurement(surface, rubber, load)
        try:
            tasks = _drawn(measurement, model, load, samples)
        except InputError as why:
            notes.append(f"{road}, {name}: no range; {why}")
            continue
        for sample, task in tasks.items():
            part = f"sample {sample - REFERENCE}"
            if sample == REFERENCE:
                part = "what its samples are compared with"
            points.append(Point((i, j, sample), f"{name}, {road}, {part}", task))
    sizes = {"model": len(_MODELS), "surface": len(roads)}
    sizes["sample"] = 1 if samples is None else REFERENCE + 1 + samples
    design = Design(sizes, points, {"model": list(_MODELS), "surface": list(roads)})
    with bench_in(folder, workers, None, on_task) as bench:
        solved = solve_design(design, bench, road_numbers).assign_attrs(nominal_speed=load.speed)
    words = [value if isinstance(value, str) else name for name, value in surfaces.items()]
    heights = {
        name: road.measured.heights if road.measured else None for name, road in roads.items()
    }
    data = roads_dataset(roads, solved).assign(textures(heights, "surface"))
    data = data.assign_attrs(
        notes="\n".join(notes),
        surfaces=shlex.join(words),
        case_file=case.origin.name,
        **case.attributes,
        **input_doubts([*roads.values(), case.measured_rubber], [load], case.units),
        **provenance.version_attributes(),
    )
    return Roads(data)


def _drawn(measurement: Measurement, model: Model, load: Load, samples: int) -> dict[int, Task]:
    """Return the tasks of a road's samples, and the one they are compared with, by their number.

    Raises `InputError` if no samples can be drawn.
    """
    source = SOURCES["profile"].of(measurement, SourceOptions(models=(model.name,)))
    case = Inputs.of(measurement)
    if isinstance(model, Chain):
        model = replace(model, solver=HalfPlane(points=_POINTS))
    if isinstance(model, DirectContact):
        # no waves are fitted: the roughness ends where it does as measured, to the last bit
        model, case = replace(model, tolerance=_TOLERANCE), replace(case, fit={})
    drawn = [case, *(sample.inputs for sample in draws(case, [source], samples, SEED))]
    return {
        number: inputs.tasks(model, [load])[0]
        for number, inputs in enumerate(drawn, start=REFERENCE)
        if inputs is not None
    }
