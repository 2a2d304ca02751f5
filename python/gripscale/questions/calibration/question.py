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
import xarray as xr

from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.charts.chart import Mark, Series, ShadedBand
from gripscale.charts.draw import Picture
from gripscale.charts.style import BLUE, ORANGE
from gripscale.conditions import Conditions
from gripscale.conditions.area_term import InterfacialShearStress, shear_stress_from_dict
from gripscale.core import Array, InputError, checks
from gripscale.core.finding import Finding, sentences, to_json
from gripscale.core.units import ZERO_CELSIUS, DisplayUnit, celsius, display_unit_of
from gripscale.experiment.design import solve_design
from gripscale.experiment.measured_friction import (
    MEASURED,
    MeasuredFriction,
    MeasuredSeries,
    friction_doubts,
    read_measured_friction,
    speed_doubts,
)
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Column, Table, digits, fixed, least_to_most, percent, significant
from gripscale.model import INPUT_DOUBTS, STATUS, input_doubts_of
from gripscale.questions.answer.calibrated import Contact
from gripscale.questions.answer.findings import case_notices
from gripscale.questions.calibration import calibration_law as laws
from gripscale.questions.calibration.area_term_fit import Estimate, estimates_of, fit_area_term
from gripscale.questions.calibration.calibration_law import PARAMETERS, written
from gripscale.questions.calibration.measured_comparison import (
    Predicted,
    answers_at,
    measured_design,
    predicted_of,
)
from gripscale.questions.calibration.profile_likelihood import groups_of
from gripscale.questions.compare.charts import measured_sheet
from gripscale.questions.inputs import record
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.result import Result
from gripscale.questions.vary.inputs import default_model
from gripscale.report.failures import failures_in, first_of
from gripscale.rubber.extrapolation import require_measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def fitted_figure(data: xr.Dataset) -> Figure:
    """Draw measured friction with its spread, the hysteresis alone, and the total with its band."""
    level = f"{100.0 * data.attrs['level']:.0f} % interval of the fit"

    def fit(series: MeasuredSeries, speed_unit: DisplayUnit) -> list[Mark]:
        rows = series.rows[np.isfinite(data.friction.values[series.rows])]
        speed = speed_unit.of(data.measured_speed.values[rows])
        total, band, hysteresis = (
            data[name].values[rows] for name in ("friction", "friction_band", "hysteresis")
        )
        return [
            ShadedBand(speed, total - band, total + band, ORANGE, level, alpha=0.25),
            Series(speed, total, ORANGE, "hysteresis and area term"),
            Series(speed, hysteresis, BLUE, "hysteresis alone", marker="."),
        ]

    return measured_sheet(data, fit, head=0.5).on_paper()


_MODELS = ("direct", "chain")  # models whose hysteresis an area term can be put beside
# Contacts with the heat that the measured friction makes: passes at most, and the friction to which
# two of them agree.
MOST_WARMINGS, SAME_FRICTION = 6, 2e-3


class Calibration(Result):
    """The area term of a case that agrees best with measured friction.

    A law of the shear stress in the real contact area: with it the predicted hysteresis, which is
    not fitted, gives the measured friction.
    """

    kind = "calibration"

    @property
    def law(self) -> InterfacialShearStress:
        """The law with the best parameters."""
        return shear_stress_from_dict(json.loads(self.data.attrs["law"]))

    @property
    def estimates(self) -> Sequence[Estimate]:
        """The fitted parameters with their 90 % intervals, in the units of the law."""
        return estimates_of(self.data)

    @property
    def lines(self) -> Sequence[str]:
        data, difference = self.data, self.data["difference"]
        values = ", ".join(f"{e.words} = {e.text(3)} ({e.interval})" for e in self.estimates)
        doubts = sentences(input_doubts_of(data))
        lead = f"none to rely on. {doubts} It would be an area term" if doubts else "area term"
        answer = f"Answer: {lead} with {values} ({percent(data.attrs['level'])} intervals)."
        if not bool(data["area_term"].notnull().any()):
            return (answer,)
        term, hysteresis = (least_to_most(data[name]) for name in ("area_term", "hysteresis"))
        share = float((data["area_term"] / data["friction"]).mean())
        missed, without = (
            significant(float(np.sqrt((part**2).mean())), 2)
            for part in (difference, difference - data["area_term"])
        )
        return (
            answer,
            f"  It adds {term} to a hysteresis friction of {hysteresis}: {percent(share)} of the "
            "friction in the mean of the points.",
            f"  Friction with it misses the measured friction by {missed} (rms), without it by "
            f"{without}.",
        )

    @property
    def findings(self) -> Sequence[Finding]:
        return tuple(case_notices(self.data, InputRecord(self.inputs)))

    @property
    def failure(self) -> str:
        return first_of(failures_in(self.data), self.data[STATUS].size, "measured points")

    def parts(self) -> Iterator[str | Table]:
        yield self.table()
        yield self._misfit_table()
        if "left_out" in self.data.coords:
            yield self._held_out_table()
        yield from str(self.data.attrs.get("notes", "")).splitlines()

    def table(self) -> Table:
        """Return value, standard error and interval of each fitted parameter."""
        fitted = self.estimates
        errors = [written(e.standard_error, e.unit, 2) if e.determined else "" for e in fitted]
        level = f"{percent(self.data.attrs['level'])} by profile likelihood"
        columns = [
            Column("parameter", [e.name for e in fitted]),
            Column("value", [e.text(4) for e in fitted], words=False),
            Column("standard_error", errors, "standard error", words=False),
            Column("interval", [e.interval for e in fitted], level),
        ]
        bad = [not e.determined for e in fitted]
        return Table("parameters", columns, "Parameters of the law", bad=bad)

    def _misfit_table(self) -> Table:
        names = ["hysteresis", "area_term", "friction", "difference", "difference_in_spread"]
        data, model = self.data, [str(self.data.attrs.get("model", "fit"))]
        table = data[[*names, *(f"measured_{name}" for name in MEASURED)]]
        table = table.assign({name: data[name].expand_dims(model=model) for name in names})
        rms = {f"rms_{n}": np.sqrt((table[n] ** 2).mean("measurement")) for n in names[3:]}
        return residual_table(table.assign(rms))

    def _held_out_table(self) -> Table:
        data = self.data
        by_temperature = data.attrs["held_out_by"] == "temperature"
        names = [
            celsius(value, ".0f") if by_temperature else f"{value:g} to {10.0 * value:g} m/s"
            for value in data.left_out.values
        ]
        errors = ("rms_inside", "rms_outside", "rms_outside_in_spread")
        columns = [
            Column("left_out", names, "left out"),
            Column("points", data.points.values, format="{:.0f}".format),
            *(Column(e, data[e].values, e.replace("_", " "), format=digits(2)) for e in errors),
            Column("why_not", data.why_not.values, "why not"),
        ]
        return Table("held-out", columns, "The law at points that were left out")

    def pictures(self) -> Iterator[Picture]:
        yield Picture(
            "measured_and_fitted",
            fitted_figure(self.data),
            "Measured friction with its spread, the hysteresis alone, and the fit with its band, "
            "at each temperature.",
            "A panel for each temperature with points and two curves over the speed.",
        )


def residual_table(data: xr.Dataset) -> Table:
    """Return measured and predicted friction, their difference, and it over the spread.

    `data` is what `gripscale.questions.residuals` answers; its root mean squares stand below.
    """
    speeds, pressures = (display_unit_of(data.attrs, name) for name in ("speed", "pressure"))
    spread, kelvin = bool(np.isfinite(data.measured_spread).any()), data.measured_temperature.values
    points = [
        Column("speed", data.measured_speed.values, "v", speeds.unit, speeds.divisor),
        Column("temperature", kelvin, "T", "°C", zero=ZERO_CELSIUS, format=fixed(1)),
        Column("pressure", data.measured_pressure.values, "p", pressures.unit, pressures.divisor),
        Column("measured_friction", data.measured_friction.values, "μ", format=fixed(3)),
        Column("measured_spread", data.measured_spread.values, "spread", format=fixed(3)),
    ]
    points = [column for column in points if np.isfinite(column.values).any()]
    columns, notes = [column.of(column.values, group="measured") for column in points], []
    numbers = {"friction": ("μ", fixed(3)), "difference": ("Δμ", fixed(3, "+"))}
    if "area_term" in data:
        numbers = {"hysteresis": ("μ hyst.", fixed(3)), **numbers}
    if spread:
        numbers["difference_in_spread"] = "Δμ / spread", fixed(1, "+")
    for name in data.model.values.tolist():
        model = data.sel(model=name).transpose("measurement", ...)
        group = str(name).replace("_", " ")
        columns += [
            Column(f"{name}_{number}", model[number].values, head, group=group, format=form)
            for number, (head, form) in numbers.items()
        ]
        rms = f"{float(model.rms_difference):.3f}"
        if spread:
            rms += f", {float(model.rms_difference_in_spread):.1f} times the spread"
        notes.append(f"Root mean square of Δμ, {group}: {rms}.")
    return Table("residuals", columns, "Measured and predicted friction", notes, keys=len(points))


def shear_stress_table(result: Calibration) -> str:
    """Return the table [conditions.shear_stress] of the fitted law, with its intervals."""
    law = json.loads(result.data.attrs["law"])
    points = law.pop("fitted_to")
    estimates = {estimate.name: estimate for estimate in result.estimates}
    source = Path(result.data.attrs["measured_source"]).name or "a measurement"
    lines = [
        f"# Fitted to {int(result.data.area_term.count())} points of {source};",
        f"# intervals of {result.data.attrs['level']:.0%} by profile likelihood, for this rubber "
        "on this surface.",
        "[conditions.shear_stress]",
        f'kind = "{law.pop("kind")}"',
    ]
    if law.get("activation_energy") == 0.0:
        del law["activation_energy"], law["reference_temperature"]
        lines.insert(2, "# No activation energy: the law holds at the measured temperature.")
    for name, value in law.items():
        unit = PARAMETERS[name].unit
        text = written(float(value), unit)
        text = f'"{text}"' if unit else text
        about = estimates[name].interval if name in estimates else "held"
        lines.append(f"{name} = {text}  # {about}")
    if points is not None:
        if points["temperature"] is not None:
            points["temperature"] = [f"{kelvin!r} K" for kelvin in points["temperature"]]
        rows = ((key, value) for key, value in points.items() if value is not None)
        lines += [
            "# Without this table an answer has the whole error of its contact area.",
            "[conditions.shear_stress.fitted_to]",
            *(f"{key} = {json.dumps(value)}" for key, value in rows),
        ]
    return "\n".join(lines) + "\n"


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
    data = fit_area_term(friction, predicted, law=law, fixed=fixed, hold_out=hold_out)
    if model != Chain.name:  # whose answers have no interval
        fitted = json.loads(data.attrs["law"]) | {"fitted_to": _points_of(data, case)}
        data.attrs["law"] = json.dumps(fitted)
    data = data.assign_attrs(case.attributes, model=model)
    if far := speed_doubts(friction, case.load.speed):
        data.attrs[INPUT_DOUBTS] = to_json(far)
    # its speeds have a doubt of their own
    loads = [replace(case.load, pressure=float(p)) for p in predicted.pressure]
    doubts = friction_doubts(friction, case.load.speed)
    return Calibration(data, record.inputs(case, loads=loads, further=doubts))


def _measured_stress(predicted: Predicted, measured: MeasuredFriction) -> Array:
    """Return the shear stress [Pa] that adds to the hysteresis what was measured; not below 0."""
    missing = measured.friction - predicted.friction
    adds = predicted.has_answer & (missing > 0.0)
    return np.divide(missing, predicted.leverage, out=np.zeros(missing.size), where=adds)


def _points_of(data: xr.Dataset, case: Case) -> dict[str, Any]:
    """Return the record of the points of a fit beside the direct contact (`FittedPoints`)."""
    contact = Contact(case.rubber, case.surface, case.load, case.conditions, case.below_measurement)
    before = (case.conditions or Conditions()).temperature_of(case.rubber)
    points = data.isel(measurement=np.isfinite(data.area_term.values))
    kelvin = points.measured_temperature.fillna(math.nan if before is None else before)
    return {
        "contact": contact.key,
        "speed": points.measured_speed.values.tolist(),
        "contact_fraction": points.contact_fraction.values.tolist(),
        "half_width": points.friction_half_width.values.tolist(),
        "temperature": None if kelvin.isnull().any() else kelvin.values.tolist(),
    }


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
