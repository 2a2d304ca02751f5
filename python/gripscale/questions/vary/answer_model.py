"""The answer as a model: what `gripscale.answer` returns, at every point of a study.

The friction of the answer by octave of wavelength is that of the direct contact times the factors
of the answer. Of an octave the Maxwell elements lose in proportion to their parts of E'' at the
frequency of its middle, w = 2 pi v / (sqrt(2) lambda) with its lower end lambda (Ferry,
Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 3).
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from dataclasses import field, replace
from typing import ClassVar

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import BelowMeasurement, Case
from gripscale.conditions.conditions import Conditions
from gripscale.core import Checked, InputError, checked, labelled
from gripscale.experiment.design import solve_design, variable_attributes
from gripscale.experiment.solve import Bench
from gripscale.experiment.task import Task
from gripscale.half_space.model import JUDGED_TO
from gripscale.half_space.solve import relative_tolerance
from gripscale.model import Load, OnProgress
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.direct_contact import (
    continued_curve,
    direct_contact_design,
    direct_contact_totals,
)
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.vary.friction_ratio import RATIO_BASIS, ComparedContact
from gripscale.questions.vary.speed_and_temperature import in_decades
from gripscale.rubber import Rubber
from gripscale.surface import Surface, SurfacePart

OCTAVE_UNIT = 1e-3  # length [m] of which the lower ends of octaves are multiples by powers of two
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
        settings = {name: getattr(load, name) for name in ("footprint", "thickness", "load_time")}
        case = Case(
            surface,
            rubber,
            pressure=load.pressure,
            speed=load.speed,
            conditions=self.conditions,
            below_measurement=self.below_measurement,
            **settings,
        )
        design = direct_contact_design(case, load, tolerance=self.tolerance)
        if design is None:
            raise InputError(
                "the direct contact needs a measured profile; got waves stated by hand"
            )
        if self.compared and load.speed > 0.0:
            contact = ComparedContact(tolerance=self.tolerance, conditions=self.conditions)
            points = [replace(p, task=replace(p.task, model=contact)) for p in design.points]
            design = replace(design, points=points)
        on_task = None if on_progress is None else (lambda progress: on_progress(progress.result))
        samples = solve_design(design, Bench(None, on_task=on_task), _sample_numbers)
        curve = continued_curve(case, load)
        with _REDUCING:
            return _answer(samples, case, curve)


def _answer(samples: xr.Dataset, case: Case, curve: xr.Dataset | None) -> xr.Dataset:
    answer = direct_contact_totals(samples, case, case.load, curve)
    basis = [name for name in RATIO_BASIS if name in samples]
    answer = answer.assign(samples[basis].reset_coords(drop=True).variables)
    if float(answer["answer_friction"]) > 0.0:
        answer = answer.assign(_by_octave(samples, answer))
        answer = answer.assign(_by_decade(answer, case.rubber_before, case.load.speed))
    return answer


def _sample_numbers(answer: xr.Dataset, task: Task) -> xr.Dataset:
    kept = [name for name in RATIO_BASIS if name in answer]
    return reduce.sample_numbers(answer, task).assign(answer[kept].variables)


def _by_octave(samples: xr.Dataset, answer: xr.Dataset) -> dict[str, xr.Variable]:
    """Return the friction of the answer by octave of wavelength."""
    waves = samples["curve_wavelength"].values
    ends = reduce.octaves(float(np.nanmax(waves)), float(np.nanmin(waves)), OCTAVE_UNIT)
    running = reduce.running(samples, "friction", ends).values
    running = np.nan_to_num(running) / running[-1] * float(answer["answer_friction"])
    parts = np.diff(running, prepend=0.0)
    return {
        "octave": labelled("octave", ends, "m", "shortest wavelength of the octave", DIRECT),
        "octave_friction": labelled("octave", parts, "1", "friction μ of the octave", DIRECT),
    }


def _by_decade(answer: xr.Dataset, rubber: Rubber, speed: float) -> dict[str, xr.DataArray]:
    """Return the friction of the answer by decade of relaxation time; empty if elastic."""
    times = rubber.relaxation_times
    if not times.size:
        return {}
    parts: dict[int, float] = {}
    omega = 2.0 * math.pi * speed / (math.sqrt(2.0) * answer["octave"].values)
    for w, friction in zip(omega, answer["octave_friction"].values, strict=True):
        loss = rubber.moduli * w * times / (1.0 + (w * times) ** 2)
        for n, part in in_decades(np.log10(times), loss / loss.sum() * friction):
            parts[n] = parts.get(n, 0.0) + part
    decades: Sequence[int] = sorted(parts)
    attrs = variable_attributes("friction coefficient by relaxation time, split as at small strain")
    values = [parts[n] for n in decades]
    return {"friction_by_decade": xr.DataArray(values, {"decade": list(decades)}, attrs=attrs)}
