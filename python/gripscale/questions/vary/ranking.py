"""Compounds on one road, or roads under one rubber, ranked by the friction of the answer.

Every pair has the ratio of their frictions with its interval, and the confidence that one lies over
the other (`gripscale.questions.vary.friction_ratio`). Where a surface was not measured all answers
are those of the chain, whose errors nobody knows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.core import Array, InputError, celsius
from gripscale.experiment.design import variable_attributes
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.model import input_doubts
from gripscale.questions.answer.variables import believed
from gripscale.questions.vary.friction_ratio import RANKED, FrictionRatio, answer_ratio
from gripscale.questions.vary.inputs import (
    READING_NOTES,
    TEMPERATURE,
    AnswerModel,
    default_model,
    measured_rubber_of,
    model_of,
    reading_notes,
    surface_of,
)
from gripscale.questions.vary.page_side_by_side import Compounds, Surfaces
from gripscale.questions.vary.study import Study, study_numbers
from gripscale.rubber import Rubber, temperature_doubts
from gripscale.surface import Surface, profile_spectrum
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, with_profile
from gripscale.surface.texture import textures

_SAME = 0.5  # temperatures that differ by less are one [K]: 20 °C and 293 K
_PER_DECADE = 12  # lags and wavenumbers at which roads are drawn together
FEWEST_COMPARED, MOST_COMPARED = 2, 6


def compare_compounds(
    case: Case,
    rubbers: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    temperature: float | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Compounds:
    """Rank several compounds on the road of a case by the friction of their answers.

    Returns over `rubber` the numbers of the answer; over `rubber` and `over` the ratio of their
    frictions and so on (`gripscale.questions.vary.friction_ratio.RANKED`); friction by octave of
    wavelength, `octave_friction`, and by decade of relaxation time, `friction_by_decade`.

    Raises `InputError` if there are fewer than two or more than six compounds, or they cannot be
    brought to one temperature.

    Parameters
    ----------
    case : Case
        Surface, load and conditions; without a measured surface also the solver of the chain.
    rubbers
        The compounds by what they are called: a `Rubber`, a `MeasuredRubber`, "case", or a rubber
        known by name.
    folder : path, optional
        Keeps each answer as soon as it is there: what was interrupted resumes.
    temperature : float, optional
        Where they are compared [K]; by default the temperature of the case's conditions, or one
        all of them have or can be shifted to.
    workers, on_task
        As for `gripscale.experiment.Bench`.
    """
    require_some("rubbers", rubbers, "compounds")
    measured = {name: measured_rubber_of(value, case) for name, value in rubbers.items()}
    if temperature is None and case.conditions is not None:
        temperature = case.conditions.temperature
    compounds = {name: each.rubber for name, each in measured.items()}
    together, notes = at_one_temperature(compounds, temperature)
    model = model_of(default_model(case), case)
    if isinstance(model, AnswerModel):
        model = replace(model, compared=True)
    study = Study(case, {"rubber": together}, model=model)
    data = ranked_answers(study, folder, workers, on_task)
    loads = [point.task.load for point in study.points]
    kelvins = [rubber.reference_temperature for rubber in together.values()]
    data = data.assign_attrs(
        input_doubts(
            [*study.surfaces, *measured.values()], loads, case.units, case.softening_doubts
        ),
        title="Compounds on one surface, by friction",
        **{READING_NOTES: "\n".join([*reading_notes(rubbers.values()), *notes])},
        **({TEMPERATURE: kelvins[0]} if None not in kelvins and len({*kelvins}) == 1 else {}),
    )
    return Compounds(data)


def compare_surfaces(
    case: Case,
    surfaces: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> Surfaces:
    """Rank several surfaces under the rubber of a case by the friction of their answers.

    Returns over `surface` the numbers of the answer and the texture (`gripscale.surface.texture`);
    ratios of friction and `octave_friction` as `compare_compounds`; `correlation` over `lag` and
    `spectrum` over `wavenumber`.

    Raises `InputError` if there are fewer than two or more than six surfaces, or one is not known.

    Parameters
    ----------
    case : Case
        Rubber, load and conditions; without measured surfaces also the solver of the chain.
    surfaces
        The surfaces by what they are called: a `Surface`, a `SineStack`, "case", or one known by
        name.
    folder, workers, on_task
        As for `compare_compounds`.
    """
    require_some("surfaces", surfaces, "surfaces")
    roads = {
        # a synthetic road with its profile, for the direct contact
        name: with_profile(value)
        if isinstance(value, str) and value in SYNTHETIC_SURFACES
        else surface_of(value, case)
        for name, value in surfaces.items()
    }
    data = ranked_answers(Study(case, {"surface": roads}), folder, workers, on_task)
    waves = [f"{name} was not measured" for name, road in roads.items() if road.measured is None]
    heights = {
        name: road.measured.heights if road.measured else None for name, road in roads.items()
    }
    data = data.assign(textures(heights, "surface")).assign(_measured(roads))
    notes = "\n".join([*reading_notes(surfaces.values()), *waves])
    title = "Surfaces under one rubber, by friction"
    return Surfaces(data.assign_attrs(title=title, **{READING_NOTES: notes}))


def at_one_temperature(
    rubbers: Mapping[str, Rubber], temperature: float | None = None
) -> tuple[dict[str, Rubber], tuple[str, ...]]:
    """Return rubbers that hold for one temperature, and what is to be said of that.

    Without a `temperature` it is that of the rubbers which cannot be shifted, or else of the first
    that states one [K]. A rubber whose temperature is not known stays as it is, which is said.

    Returns the rubbers, and a sentence for each that was shifted and for what is doubtful
    (`gripscale.rubber.temperature_doubts`). Raises `InputError` if a rubber would have to be
    shifted and has no shift.
    """
    temperatures = {
        name: rubber.reference_temperature
        for name, rubber in rubbers.items()
        if rubber.reference_temperature is not None
    }
    if temperature is None:
        fixed = {name: t for name, t in temperatures.items() if rubbers[name].shift is None}
        if fixed and max(fixed.values()) - min(fixed.values()) > _SAME:
            each = [f"{name} for {celsius(kelvin, '.1f')}" for name, kelvin in fixed.items()]
            raise InputError(
                "compounds must hold for one temperature, or have a shift to it; got "
                f"{', '.join(each)} without one"
            )
        temperature = next(iter((fixed or temperatures).values()), None)
    if temperature is None:
        return dict(rubbers), temperature_doubts(rubbers)
    together, shifted, target = dict(rubbers), [], celsius(temperature, ".1f")
    for name, kelvin in temperatures.items():
        if abs(kelvin - temperature) <= _SAME:
            continue
        before = celsius(kelvin, ".1f")
        if rubbers[name].shift is None:
            raise InputError(
                f"{name} holds for {before} and cannot be brought to {target}: give it a shift, or "
                "leave it out"
            )
        together[name] = rubbers[name].at(temperature)
        shifted.append(f"{name} shifted from {before} to {target}")
    return together, (*shifted, *temperature_doubts(together))


def require_some(name: str, mapping: Mapping[str, Any], what: str) -> None:
    """Raise `InputError` unless there are two to six things to be compared."""
    if not FEWEST_COMPARED <= len(mapping) <= MOST_COMPARED:
        raise InputError(
            f"{name} must be {FEWEST_COMPARED} to {MOST_COMPARED} {what} to be compared; got "
            f"{len(mapping)}"
        )


def ranked_answers(
    study: Study, folder: str | Path | None, workers: int | None, on_task: OnTask | None
) -> xr.Dataset:
    """Return the answers of a study over `rubber` or `surface`, with `RANKED` of each pair."""
    with bench_in(folder, workers, None, on_task) as bench:
        data = study.assemble(bench.solve(study.design.tasks, study_numbers))
    (dim,) = study.design.sizes
    names = data[dim].values
    friction = believed(data, "friction")
    numbers = data[friction].transpose(dim).values
    values = np.full((len(RANKED), names.size, names.size), np.nan)
    for i, j in np.ndindex(names.size, names.size):
        if numbers[i] > 0.0 and numbers[j] > 0.0:
            over, under = data.isel({dim: i}), data.isel({dim: j})
            ratio = FrictionRatio(0.0, 0.0) if i == j else answer_ratio(over, under, friction)
            values[:, i, j] = math.exp(ratio.log_ratio), *ratio.interval, ratio.confidence
    columns = {
        name: ((dim, "over"), part, variable_attributes(text))
        for (name, text), part in zip(RANKED.items(), values, strict=True)
    }
    return data.assign_coords(over=("over", names)).assign(columns)


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
