"""Surfaces, rubbers, models and effects that a question varies, as a model takes them."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import xarray as xr

from gripscale import model
from gripscale.case import BelowMeasurement, Case
from gripscale.chain.chain import Chain
from gripscale.conditions import Conditions
from gripscale.conditions.flash_temperature import ThermalProperties
from gripscale.core import Checked, InputError, checked, checks
from gripscale.experiment.design import OF_THE_CASE, solve_design
from gripscale.experiment.solve import Bench
from gripscale.experiment.task import Task
from gripscale.half_space.model import JUDGED_TO, DirectContact
from gripscale.half_space.solve import relative_tolerance
from gripscale.model import Load, Model, OnProgress
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.direct_contact import (
    continued_curve,
    direct_contact_design,
    direct_contact_totals,
)
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.vary.friction_parts import parts_of_answer
from gripscale.questions.vary.friction_ratio import ComparedContact, ratio_basis
from gripscale.rubber import Rubber, styrene_butadiene
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.surface import SineStack, Surface, SurfacePart
from gripscale.surface.synthetic import SYNTHETIC_SURFACES, synthetic_surface
from gripscale.theory.persson import Persson

# xarray silences warnings of missing numbers in all threads at once: one of them at a time.
_REDUCING = threading.Lock()


class AnswerModel(Checked, model.Model):
    """Model that answers with the friction and contact area of `gripscale.answer`.

    Parameters
    ----------
    tolerance : float or None
        Estimated relative error of each direct contact; None: its first full grid.
    conditions : Conditions, optional
        As of the direct contact.
    below_measurement : BelowMeasurement
        As of the case.
    compared : bool
        Whether the answer also holds what its ratio to that of another rubber on the same surface
        needs (`RATIO_BASIS`).
    """

    name: ClassVar[str] = DIRECT
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"waves", "measurement", "cut_off"})
    takes_conditions: ClassVar[bool] = True

    tolerance: float | None = checked(relative_tolerance, default=JUDGED_TO)
    conditions: Conditions | None = None
    below_measurement: BelowMeasurement = field(default_factory=BelowMeasurement)
    compared: bool = False

    @property
    def method(self) -> tuple[str, ...]:
        """What a page says of it."""
        sheared = self.conditions is not None and self.conditions.shear_stress is not None
        return (*DirectContact.method, "surface", *(["interface"] if sheared else []))

    def with_conditions(self, conditions: Conditions | None) -> AnswerModel:
        """Return the model under other conditions."""
        return replace(self, conditions=conditions)

    def parts(self, surface: Surface) -> int:
        """Return the number of profiles, whose direct contacts are solved concurrently."""
        return 1 if surface.measured is None else len(surface.measured.surfaces)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer; `on_progress` gets the direct contact of each profile.

        Raises `InputError` if the surface was not measured.
        """
        case = Case(
            surface,
            rubber,
            **vars(load),
            conditions=self.conditions,
            below_measurement=self.below_measurement,
        )
        design = direct_contact_design(case, load, tolerance=self.tolerance)
        if design is None:
            text = "the direct contact needs a measured profile; got waves stated by hand"
            raise InputError(text)
        if self.compared and load.speed > 0.0:
            contact = ComparedContact(
                tolerance=self.tolerance, conditions=self.conditions, alternatives=True
            )
            points = [replace(p, task=replace(p.task, model=contact)) for p in design.points]
            design = replace(design, points=points)

        def numbers(answer: xr.Dataset, task: Task) -> xr.Dataset:
            return reduce.sample_numbers(answer, task).assign(ratio_basis(answer).variables)

        on_task = None if on_progress is None else (lambda progress: on_progress(progress.result))
        samples = solve_design(design, Bench(None, on_task=on_task), numbers)
        curve = continued_curve(case, load)
        with _REDUCING:
            answer = direct_contact_totals(samples, case, case.load, curve)
            answer = answer.assign(ratio_basis(samples).reset_coords(drop=True).variables)
            if not float(answer["answer_friction"]) > 0.0:
                return answer
            return answer.assign(parts_of_answer(answer, samples, case.rubber_before, load.speed))


_NAMED_RUBBERS = {"styrene_butadiene": styrene_butadiene}


def surface_of(value: Any, case: Case) -> Surface:
    """Return a surface that a question names.

    `value` is a `Surface`, a `SineStack`, "case" for the surface of the case, or the name of a
    synthetic surface. Raises `InputError` for anything else.
    """
    if isinstance(value, Surface):
        return value
    if isinstance(value, SineStack):
        return Surface(value, "sine waves given by the caller")
    if value == OF_THE_CASE:
        return case.surface
    names = [OF_THE_CASE, *SYNTHETIC_SURFACES]
    return synthetic_surface(checks.one_of("surface", value, names))


def measured_rubber_of(value: Any, case: Case) -> MeasuredRubber:
    """Return a rubber that a question names, with what it comes from.

    `value` is a `Rubber`, a `MeasuredRubber`, "case" for the rubber of the case, or the name of a
    rubber. Raises `InputError` for anything else.
    """
    if isinstance(value, MeasuredRubber):
        return value
    if value == OF_THE_CASE:
        return case.measured_rubber
    if not isinstance(value, Rubber):
        names = [OF_THE_CASE, *_NAMED_RUBBERS]
        value = _NAMED_RUBBERS[checks.one_of("rubber", value, names)]()
    return MeasuredRubber(value, value.source)


def reading_notes(values: Iterable[Any]) -> tuple[str, ...]:
    """Return what was assumed when surfaces or rubbers were read from files, a sentence each."""
    return tuple(filter(None, (getattr(value, "note", "") for value in values)))


@dataclass(frozen=True)
class Setting:
    """What a point of a study predicts with: a model, a load, and changed waves of its surface."""

    model: Model
    load: Load
    waves: Mapping[str, Any] = field(default_factory=dict)  # arguments of `Surface.varied`

    def with_load(self, **changes: Any) -> Setting:
        """Return the setting with another load."""
        return replace(self, load=replace(self.load, **changes))

    def with_waves(self, **changes: Any) -> Setting:
        """Return the setting with other waves of its surface."""
        return replace(self, waves={**self.waves, **changes})


def conditions_of(model: Model) -> Conditions:
    """Return the conditions of a model or empty ones; `InputError` if it takes none."""
    return model.with_conditions(model.conditions).conditions or Conditions()


def at_temperature(model: Model, kelvin: float) -> Model:
    """Return `model` with another temperature before the contact [K]."""
    return model.with_conditions(replace(conditions_of(model), temperature=kelvin))


def with_effects(model: Model, selection: str) -> Model:
    """Return `model` with all of its effects, without one or with none; its area term stays.

    Raises `InputError` if `selection` is neither "all", "no" one that the model has, nor "none".
    """
    conditions, effects = conditions_of(model), ("temperature", "softening", "heat", "water")
    asked = [effect for effect in effects if getattr(conditions, effect) is not None]
    without = {"all": [], **{f"no {effect}": [effect] for effect in asked}, "none": asked}
    nothing = without[checks.one_of("effects", selection, without)]
    return model.with_conditions(conditions.without(*nothing))


def for_rubber(model: Model, rubber: Rubber) -> Model:
    """Return `model` with what its conditions do to a rubber that may be another than the case's.

    Rubber known by name is unfilled and does not soften; without a shift none warms by typical
    constants.
    """
    effects = model.conditions
    if effects is None or not model.takes_conditions:
        return model
    if rubber.name in {named().name for named in _NAMED_RUBBERS.values()}:
        effects = replace(effects, softening=None)
        if rubber.shift is None and effects.temperature == 293.15:  # that of its moduli
            effects = replace(effects, temperature=None)
    if rubber.shift is None and effects.heat == ThermalProperties():
        effects = replace(effects, heat=None)
    return model if effects == model.conditions else model.with_conditions(effects)


def default_model(case: Case, surfaces: Sequence[Surface] = ()) -> str:
    """Return "direct" where the surface of a case, or all `surfaces`, is measured; else "chain"."""
    measured = all(surface.measured is not None for surface in surfaces or [case.surface])
    return DirectContact.name if measured else Chain.name


def model_of(model: Model | str, case: Case, tolerance: float | None = JUDGED_TO) -> Model:
    """Return a model, or the chain of a case or its answer by the direct contact by their names.

    `tolerance` is the estimated relative error of a direct contact chosen by name; None for its
    first full grid. Raises `InputError` if the name is another, or the tolerance out of range.
    """
    if not isinstance(model, str):
        if isinstance(model, Persson) and model.conditions is None:
            return model.with_conditions(case.conditions)
        return model
    if checks.one_of("model", model, (Chain.name, DirectContact.name)) == Chain.name:
        return case.chain
    return AnswerModel(tolerance, case.conditions, case.below_measurement)
