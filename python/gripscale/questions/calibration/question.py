"""Which area term agrees with measured friction: its law beside the predicted hysteresis.

result = gs.calibrate(case, measured)
result.law
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.charts.draw import image
from gripscale.conditions import Conditions
from gripscale.conditions.area_term import (
    FittedPoints,
    InterfacialShearStress,
    shear_stress_from_dict,
)
from gripscale.core import Array, InputError, checks
from gripscale.core.finding import Finding, Severity, to_json
from gripscale.experiment.design import solve_design
from gripscale.experiment.measured_friction import (
    MeasuredFriction,
    friction_doubts,
    read_measured_friction,
    speed_doubts,
)
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Table
from gripscale.model import INPUT_DOUBTS, STATUS
from gripscale.questions.answer.calibrated import Contact
from gripscale.questions.answer.findings import case_notices
from gripscale.questions.calibration import calibration_law as laws
from gripscale.questions.calibration import page
from gripscale.questions.calibration.area_term_fit import AreaTermFit, Estimate, fit_area_term
from gripscale.questions.calibration.charts import calibration_pictures
from gripscale.questions.calibration.measured_comparison import (
    Predicted,
    answers_at,
    measured_design,
    predicted_of,
)
from gripscale.questions.calibration.profile_likelihood import groups_of
from gripscale.questions.inputs import record
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.result import Result
from gripscale.questions.vary.inputs import default_model
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Card, Page, Section, Text, as_elements
from gripscale.report.failures import failures_in, first_of
from gripscale.rubber.extrapolation import require_measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MODELS = ("direct", "chain")  # models whose hysteresis an area term can be put beside
# Contacts with the heat that the measured friction makes: passes at most, and the friction to which
# two of them agree.
MOST_WARMINGS, SAME_FRICTION = 6, 2e-3
_CALIBRATION = (
    "A law of the shear stress in the real contact area, fitted so that the predicted hysteresis "
    "and this area term together give the measured friction. The hysteresis is not fitted."
)


class Calibration(Result):
    """The area term of a case that agrees best with measured friction."""

    kind = "calibration"
    fit: AreaTermFit | None = None
    """The fit with all its numbers; None of a result that was loaded from a file."""

    @property
    def law(self) -> InterfacialShearStress:
        """The law with the best parameters."""
        return shear_stress_from_dict(json.loads(self.data.attrs["law"]))

    @property
    def estimates(self) -> Sequence[Estimate]:
        """The fitted parameters with their 90 % intervals."""
        return tuple(page.estimates(self.data))

    @property
    def lines(self) -> Sequence[str]:
        return tuple(page.calibration_lines(self.data))

    @property
    def findings(self) -> Sequence[Finding]:
        return tuple(case_notices(self.data, InputRecord(self.inputs)))

    @property
    def failure(self) -> str:
        return first_of(failures_in(self.data), self.data[STATUS].size, "measured points")

    def parts(self) -> Iterator[str | Table]:
        yield page.misfit_table(self.data)
        yield self.table()
        yield from filter(None, [page.correlations(self.data)])
        if "left_out" in self.data.coords:
            yield page.held_out_table(self.data)
        yield from str(self.data.attrs.get("notes", "")).splitlines()

    def table(self) -> Table:
        return page.parameter_table(self.data)

    def figures(self) -> Iterator[tuple[str, Figure]]:
        for picture in calibration_pictures(self.data):
            yield picture.name, picture.figure

    def page_content(self) -> Page:
        attrs, case = self.data.attrs, case_title(self.data.attrs)
        errors = [Finding(Severity.ERROR, self.failure)] if self.failure else []
        points, *tables = as_elements(self.parts())
        fit, profiles = map(image, calibration_pictures(self.data))
        law = [fit, page.law_facts(self.data), Text(_CALIBRATION), *tables]
        return Page.of(
            f"{attrs.get('title', 'Calibration')}{f': {case}' if case else ''}",
            str(attrs.get("model", "")).replace("_", " "),
            [*errors, *self.findings],
            [
                Card(e.words, e.text(3), "", not e.determined, f"{e.interval} (90 %)")
                for e in self.estimates
            ],
            [
                Section("law", "The law", law),
                Section("points", "Point by point", [points]),
                Section("profiles", "How well the data determine the law", [profiles]),
                rerun_section(attrs),
            ],
            (line.strip() for line in self.lines),
        )


def calibrate(
    case: Case,
    measured: MeasuredFriction | str | Path | None = None,
    *,
    model: str | None = None,
    law: str = "gaussian",
    fixed: Mapping[str, float] | None = None,
    hold_out: str | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> Calibration:
    """Predict the hysteresis of a case at each measured point and fit an area term beside it.

    Raises `InputError` or `FileError` as `fit_area_term` and the models do; if the case has no
    measured friction; if it refuses extrapolation and a point excites the rubber beyond its
    measured frequencies.

        >>> gs.calibrate(case, "friction.csv", law="constant").lines[-1]
        '  Friction with it misses the measured friction by 0.32 (rms), without it by 0.68.'

    Parameters
    ----------
    case : Case
        An area term of its own has no part in it.
    measured : MeasuredFriction or path, optional
        Measured friction, or a table of it; that of the case by default.
    model : str, optional
        "direct" or "chain": what predicts the hysteresis and the real contact area; by default
        the direct contact where a surface was measured, with the factors of `gripscale.answer`:
        the case with the fitted law then has the fitted friction as its answer. With heat the
        interface is as warm as the measured friction makes it.
    law, fixed, hold_out
        As for `gripscale.questions.fit_area_term`.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.
    """
    if model is not None:
        checks.one_of("model", model, _MODELS)
    laws.check_names(law, fixed or ())
    model = model or default_model(case)
    friction = measured_of(case, measured)
    laws.refuse_unfit(friction, law, fixed or {})
    if hold_out is not None:
        groups_of(hold_out, friction.speed, friction.temperature)
    rubber, surface, load = case.rubber, case.surface, case.load
    if case.chain.extrapolate == "refuse":
        for speed, kelvin in zip(friction.speed, friction.temperature, strict=True):
            warm = case.rubber_before if np.isnan(kelvin) else rubber.at(float(kelvin))
            require_measured(warm, surface.sines.wavelength, float(speed))
    warms = case.conditions is not None and case.conditions.heat is not None
    stress: Array | None = None
    with bench_in(folder, workers, client, on_task) as bench:
        for _ in range(MOST_WARMINGS if warms else 1):
            if model == Chain.name:
                design = measured_design(
                    friction, case.chain, case.measured_rubber, surface, load, warming_stress=stress
                )
                predicted = predicted_of(solve_design(design, bench))
            else:
                predicted = answers_at(friction, case, bench, stress)
            before, stress = stress, _measured_stress(predicted, friction)
            change = (stress - (0.0 if before is None else before)) * predicted.leverage
            if np.nan_to_num(np.abs(change)).max() < SAME_FRICTION:
                break
    fit = fit_area_term(friction, predicted, law=law, fixed=fixed, hold_out=hold_out)
    if model != Chain.name:  # whose answers have no interval
        fit = replace(fit, fitted_to=_points_of(fit, case))
    data = fit.to_dataset().assign_attrs(
        case.attributes, model=model, notes="\n".join(page.notes(fit))
    )
    if far := speed_doubts(friction, case.load.speed):
        data.attrs[INPUT_DOUBTS] = to_json(far)
    # its speeds have a doubt of their own
    loads = [replace(case.load, pressure=float(p)) for p in predicted.pressure]
    doubts = friction_doubts(friction, case.load.speed)
    result = Calibration(data, record.inputs(case, loads=loads, further=doubts))
    result.fit = fit
    return result


def _measured_stress(predicted: Predicted, measured: MeasuredFriction) -> Array:
    """Return the shear stress [Pa] that adds to the hysteresis what was measured; not below 0."""
    missing = measured.friction - predicted.friction
    adds = predicted.has_answer & (missing > 0.0)
    return np.divide(missing, predicted.leverage, out=np.zeros(missing.size), where=adds)


def _points_of(fit: AreaTermFit, case: Case) -> FittedPoints:
    """Return the record of the points of a fit beside the direct contact of a case."""
    below, answered = case.below_measurement, fit.predicted.has_answer
    contact = Contact(case.rubber, case.surface, case.load, case.conditions, below)
    before = (case.conditions or Conditions()).temperature_of(case.rubber)
    kelvin = np.where(
        np.isnan(fit.measured.temperature),
        math.nan if before is None else before,
        fit.measured.temperature,
    )[answered]
    return FittedPoints(
        contact.key,
        fit.measured.speed[answered].tolist(),
        fit.predicted.contact_fraction[answered].tolist(),
        fit.half_width.tolist(),
        None if np.isnan(kelvin).any() else kelvin.tolist(),
    )


def measured_of(case: Case, measured: MeasuredFriction | str | Path | None) -> MeasuredFriction:
    """Return measured friction, read from a table, or that of the case.

    Raises `InputError` if there is none, `FileError` if it cannot be read.
    """
    if isinstance(measured, str | Path):
        return read_measured_friction(Path(measured))
    friction = case.friction if measured is None else measured
    if friction is None:
        raise InputError(
            f"{case.name}: [measured] friction must name a table of measured friction; got none"
        )
    return friction
