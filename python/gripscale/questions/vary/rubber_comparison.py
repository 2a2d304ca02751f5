"""Compounds on one road under one load, at one temperature."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from gripscale.case import Case
from gripscale.core.errors import InputError
from gripscale.core.units import celsius
from gripscale.experiment.solve import OnTask
from gripscale.model import input_doubts
from gripscale.questions.vary.answer_model import AnswerModel
from gripscale.questions.vary.inputs import (
    READING,
    TEMPERATURE,
    default_model,
    measured_rubber_of,
    model_of,
    reading_notes,
)
from gripscale.questions.vary.ranking import ranked_answers, require_some
from gripscale.questions.vary.side_by_side import Compounds
from gripscale.questions.vary.study import Study
from gripscale.rubber import Rubber, temperature_doubts

_SAME = 0.5
"""Temperatures that differ by less are one [K]: 20 °C and 293 K."""


def at_one_temperature(
    rubbers: Mapping[str, Rubber], temperature: float | None = None
) -> tuple[dict[str, Rubber], tuple[str, ...]]:
    """Return rubbers that hold for one temperature, and what is to be said of that.

    Without a `temperature` it is that of the rubbers which cannot be shifted, or else of the first
    that states one. A rubber whose temperature is not known stays as it is, which is said.

    Parameters
    ----------
    rubbers
        The rubbers by what they are called.
    temperature : float, optional
        Where they are wanted [K].

    Returns
    -------
    tuple
        The rubbers, and a sentence for each that was shifted and for what is doubtful (see
        `gripscale.rubber.temperature_doubts`).

    Raises
    ------
    InputError
        If a rubber would have to be shifted and has no shift.
    """
    temperatures = {
        name: rubber.reference_temperature
        for name, rubber in rubbers.items()
        if rubber.reference_temperature is not None
    }
    wanted = temperature
    if wanted is None:
        fixed = {name: t for name, t in temperatures.items() if rubbers[name].shift is None}
        if fixed and max(fixed.values()) - min(fixed.values()) > _SAME:
            each = ", ".join(
                f"{name} for {celsius(kelvin, '.1f')}" for name, kelvin in fixed.items()
            )
            raise InputError(
                "compounds must hold for one temperature, or have a shift to it; got "
                f"{each} without one"
            )
        wanted = next(iter((fixed or temperatures).values()), None)
    if wanted is None:
        return dict(rubbers), temperature_doubts(rubbers)
    together, shifted = {}, []
    for name, rubber in rubbers.items():
        before = temperatures.get(name)
        if before is None or abs(before - wanted) <= _SAME:
            together[name] = rubber
            continue
        if rubber.shift is None:
            raise InputError(
                f"{name} holds for {celsius(before, '.1f')} and cannot be brought to "
                f"{celsius(wanted, '.1f')}: "
                "give it a shift, or leave it out"
            )
        together[name] = rubber.at(wanted)
        shifted.append(f"{name} shifted from {celsius(before, '.1f')} to {celsius(wanted, '.1f')}")
    return together, (*shifted, *temperature_doubts(together))


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

    Parameters
    ----------
    case : Case
        Surface, load and conditions; without a measured surface also the solver of the chain.
    rubbers
        Two to six compounds by what they are called: a `Rubber`, a `MeasuredRubber`, "case", or a
        rubber known by name.
    folder : path, optional
        Keeps each answer as soon as it is there: what was interrupted resumes.
    temperature : float, optional
        Where they are compared [K]; by default the temperature of the case's conditions, or one
        all of them have or can be shifted to.
    workers, on_task
        As for `gripscale.experiment.solve_all`.

    Returns
    -------
    Compounds
        Over `rubber` the numbers of the answer; over `rubber` and `over` the ratio of their
        frictions and so on (`gripscale.questions.vary.ranking.RANKED`); friction by octave of
        wavelength, `octave_friction`, and by decade of relaxation time, `friction_by_decade`.

    Raises
    ------
    InputError
        If there are fewer than two or more than six compounds, or they cannot be brought to one
        temperature.
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
    study = Study(case, {"rubber": together}, static=False, model=model)
    data = ranked_answers(study, folder, workers, on_task)
    loads = [point.task.load for point in study.points]
    data = data.assign_attrs(
        input_doubts([*study.surfaces, *measured.values()], loads, case.units),
        title="Compounds on one road, by friction",
        **{READING: "\n".join([*reading_notes(rubbers.values()), *notes])},
    )
    kelvins = [rubber.reference_temperature for rubber in together.values()]
    if kelvins[0] is not None and len({*kelvins}) == 1:
        data = data.assign_attrs({TEMPERATURE: kelvins[0]})
    return Compounds(data)
