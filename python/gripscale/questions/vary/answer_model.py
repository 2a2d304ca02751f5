"""The answer as a model: what `gripscale.answer` returns, at every point of a study."""

from __future__ import annotations

import threading
from dataclasses import field, replace
from typing import ClassVar

import xarray as xr

from gripscale import model
from gripscale.case import BelowMeasurement, Case
from gripscale.conditions.conditions import Conditions
from gripscale.core import Checked, InputError, checked
from gripscale.experiment.design import solve_design
from gripscale.experiment.solve import Bench
from gripscale.half_space.model import JUDGED_TO, DirectContact
from gripscale.half_space.solve import relative_tolerance
from gripscale.model import Load, OnProgress
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.direct_contact import (
    continued_curve,
    direct_contact_design,
    direct_contact_totals,
)
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.vary.friction_parts import parts_of_answer
from gripscale.questions.vary.friction_ratio import ComparedContact, ratio_basis
from gripscale.rubber import Rubber
from gripscale.surface import Surface, SurfacePart

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
            raise InputError(
                "the direct contact needs a measured profile; got waves stated by hand"
            )
        if self.compared and load.speed > 0.0:
            contact = ComparedContact(
                tolerance=self.tolerance, conditions=self.conditions, alternatives=True
            )
            points = [replace(p, task=replace(p.task, model=contact)) for p in design.points]
            design = replace(design, points=points)
        on_task = None if on_progress is None else (lambda progress: on_progress(progress.result))
        samples = solve_design(
            design,
            Bench(None, on_task=on_task),
            lambda answer, task: reduce.sample_numbers(answer, task).assign(
                ratio_basis(answer).variables
            ),
        )
        curve = continued_curve(case, load)
        with _REDUCING:
            answer = direct_contact_totals(samples, case, case.load, curve)
            answer = answer.assign(ratio_basis(samples).reset_coords(drop=True).variables)
            if float(answer["answer_friction"]) > 0.0:
                parts = parts_of_answer(answer, samples, case.rubber_before, load.speed)
                answer = answer.assign(parts)
            return answer
