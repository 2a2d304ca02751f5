"""What a model predicts at the points of a measurement: its speeds, temperatures and pressures."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model as models
from gripscale.case import Case, fitted_for_load
from gripscale.conditions.area_term import ConstantStress, InterfacialShearStress
from gripscale.conditions.conditions import Conditions
from gripscale.core import Array, Checked, InputError, Mask, Vector, checked, checks, labelled
from gripscale.core.units import ZERO_CELSIUS, plain
from gripscale.experiment.design import CONVERGED, Design, Point, solve_design
from gripscale.experiment.measured_friction import (
    MeasuredFriction,
    TemperatureProbe,
    measured_variables,
)
from gripscale.experiment.solve import Bench
from gripscale.experiment.task import Task
from gripscale.half_space.model import JUDGED_TO, DirectContact
from gripscale.model import Load, Model
from gripscale.questions.answer.direct_contact import direct_contact_totals
from gripscale.questions.answer.samples import sample_numbers
from gripscale.questions.answer.variables import HYSTERESIS, INTERFACE
from gripscale.questions.cut_off.curve import contact_curves
from gripscale.rubber import Rubber
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.surface import Surface
from gripscale.surface.surface import each_measured


class Predicted(Checked, eq=False):
    """Contact and friction at the points of a measurement, arrays of shape (n,) in its order.

    Raises `InputError` if the lengths differ, or a pressure is not above zero.

    Parameters
    ----------
    friction : array_like
        Of the hysteresis [-]; NaN where the model has no answer.
    contact_fraction : array_like
        A_r/A_0 [-].
    pressure : array_like
        Nominal [Pa], above zero.
    temperature : array_like
        In the contact [K], the mean over the real contact area; NaN where not known.
    outside_band : array_like, optional
        Share of the friction that rests on the rubber outside its measured frequencies [-].
    status : sequence of str, optional
        "converged", or why there is no answer.
    status_word : sequence of str, optional
        Words of these statuses, empty where there is none.
    """

    friction: Vector = checked(checks.vector, missing=True, repr=False)
    contact_fraction: Vector = checked(checks.vector, missing=True, repr=False)
    pressure: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    temperature: Vector = checked(checks.vector, unit="K", missing=True, repr=False)
    outside_band: Vector = checked(checks.vector, missing=True, default=None, repr=False)
    status: Sequence[str] = checked(checks.instances, kind=str, default=None, repr=False)
    status_word: Sequence[str] = checked(checks.instances, kind=str, default=None, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        size = self.friction.size
        if self.outside_band is None:
            self._set(outside_band=np.full(size, np.nan))
        if self.status is None:
            self._set(status=[CONVERGED] * size)
        if self.status_word is None:
            self._set(status_word=[models.word_of(text) for text in self.status])
        checks.same_length(0, **{name: np.asarray(values) for name, values in vars(self).items()})

    def require_points_of(self, measured: MeasuredFriction, name: str = "predicted") -> None:
        """Raise `InputError` unless it has the number and the pressures of the points measured."""
        if self.friction.size != measured.speed.size:
            raise InputError(
                f"{name} must be predicted at the {measured.speed.size} points measured; "
                f"got {self.friction.size}"
            )
        # a measurement without pressures is predicted at that of the load
        apart = ~np.isclose(self.pressure, measured.pressure, rtol=1e-6, atol=0.0)
        apart &= np.isfinite(measured.pressure)
        if apart.any():
            at = int(np.argmax(apart))
            raise InputError(
                f"{name} must be predicted at the points measured, in their order; at index {at} "
                f"{measured.pressure[at]:g} Pa was measured and {self.pressure[at]:g} Pa predicted"
            )

    @property
    def has_answer(self) -> Mask:
        """Where the model has an answer."""
        return np.isfinite(self.friction) & (self.contact_fraction > 0.0)

    @property
    def leverage(self) -> Array:
        """A_r/(A_0 p) [1/Pa]: the friction of the area term for each pascal of shear stress."""
        return self.contact_fraction / self.pressure

    def area_term(self, law: InterfacialShearStress, speed: Array) -> Array:
        """Return the friction of the area term [-] under `law` at the speeds [m/s] of the points.

        NaN where the model has no answer.
        Raises `InputError` if it depends on a temperature that is not known.
        """
        out, answers = np.full(self.friction.size, np.nan), self.has_answer
        kelvin = self.temperature[answers]
        at = None if np.isnan(kelvin).all() else kelvin
        out[answers] = self.leverage[answers] * law.stress(speed[answers], at)
        return out


def averaged(parts: Sequence[Predicted]) -> Predicted:
    """Return the mean of the predictions of several samples of one model at the same points.

    A point at which one of them has no answer has none. Temperatures are weighted by the contact
    area, which the area term is the sum over.

    Raises `InputError` if there is none, or their points differ in number or pressure.
    """
    checks.instances("parts", parts, Predicted)
    pressure = parts[0].pressure
    if any(not np.array_equal(part.pressure, pressure) for part in parts):
        raise InputError("parts must be predicted at the same pressures; got others")
    area = np.array([part.contact_fraction for part in parts])
    kelvin = np.array([part.temperature for part in parts])
    failed = np.array([part.status for part in parts]) != CONVERGED
    first = failed.argmax(axis=0)  # of each point, the first sample without an answer
    return Predicted(
        np.mean([part.friction for part in parts], axis=0),
        area.mean(axis=0),
        pressure,
        (area * kelvin).sum(axis=0) / area.sum(axis=0),
        np.mean([part.outside_band for part in parts], axis=0),
        [parts[sample].status[point] for point, sample in enumerate(first)],
        [parts[sample].status_word[point] for point, sample in enumerate(first)],
    )


def measured_design(
    measured: MeasuredFriction,
    model: Model,
    rubber: Rubber | MeasuredRubber,
    surface: Surface,
    load: Load,
    label: str = "",
    warming_stress: Array | None = None,
) -> Design:
    """Return what a model predicts at each measured point as a design over `measurement`.

    `predicted_of` reads the Dataset that `gripscale.experiment.solve_design` makes of it.

    Parameters
    ----------
    measured : MeasuredFriction
        The points. A missing temperature is that of the model's conditions or, without one, of the
        rubber; a missing pressure is that of the load.
    model : Model
        What predicts. Where it has `conditions` they get the temperature and a shear stress that
        tells the temperature in the contact; else the rubber is brought to the temperature, which
        needs a shift.
    rubber, surface, load
        What slides on what, and the load of the case. A measured rubber is fitted for each point.
    label : str
        Begins the labels of the points.
    warming_stress : array, optional
        What the interface of each point loses with the heat of the conditions [Pa].
    """
    warming = np.zeros(measured.speed.size) if warming_stress is None else warming_stress
    pressure = np.where(np.isnan(measured.pressure), load.pressure, measured.pressure)
    made = MeasuredRubber(rubber, "") if isinstance(rubber, Rubber) else rubber
    usual = model.conditions or Conditions()
    case = usual.temperature_of(made.rubber)
    kelvin = np.where(
        np.isnan(measured.temperature), math.nan if case is None else case, measured.temperature
    )
    rows = zip(pressure, measured.speed, kelvin, warming, strict=True)
    points = []
    for at, (p, v, t, heating) in enumerate(rows, start=1):
        point_load = replace(load, pressure=float(p), speed=float(v))
        temperature = None if math.isnan(t) else float(t)
        other = temperature is not None and temperature != case
        at_kelvin = Conditions(temperature=temperature)
        met = fitted_for_load(made, surface, point_load, at_kelvin).rubber
        if model.takes_conditions:
            law = ConstantStress(float(heating)) if heating > 0.0 else None
            conditions = replace(usual, shear_stress=TemperatureProbe(law))
            if other:
                conditions = replace(conditions, temperature=temperature)
            task = Task(met, surface, point_load, model.with_conditions(conditions))
        else:
            met = met.at(temperature) if other and temperature else met
            task = Task(met, surface, point_load, model)
        celsius = "" if temperature is None else f", {t - ZERO_CELSIUS:.4g} C"
        words = f"speed {plain(v, 4)} m/s{celsius}, pressure {p / 1e5:.4g} bar"
        points.append(Point((at - 1,), f"{label}point {at}, {words}", task))
    coords = {
        "nominal_pressure": ("measurement", pressure, {"units": "Pa"}),
        "temperature": ("measurement", kelvin, {"units": "K"}),
    }
    return Design({"measurement": len(points)}, points, coords)


def predicted_of(data: xr.Dataset) -> Predicted:
    """Return the predictions in the solved Dataset of `measured_design`."""
    area, pressure = data["total_contact_fraction"], data["nominal_pressure"]
    kelvin = data["temperature"]
    if models.ADHESIVE_FRICTION in data:  # what the probe says
        term = data[models.ADHESIVE_FRICTION]
        contact = (term * pressure / area.where(area > 0.0)).where(lambda t: t > 0.0)
        kelvin = contact.where(term.notnull(), kelvin)
    return Predicted(
        data["total_friction"].values,
        area.values,
        pressure.values,
        kelvin.values,
        data.get(models.FRICTION_OUTSIDE_BAND, area * math.nan).values,
        data[models.STATUS].values.tolist(),
        models.status_words(data).values.tolist(),
    )


def answers_at(
    measured: MeasuredFriction, case: Case, bench: Bench, warming_stress: Array | None = None
) -> Predicted:
    """Return what the answer of a case with a measured surface states at each measured point.

    Friction and contact area are those of `gripscale.answer` at the speed, temperature and pressure
    of a point: the direct contact of the profiles times the factors of the answer. A law
    that is fitted to them is multiplied with the same area when the case is answered with it.
    A missing temperature or pressure is that of the case, `warming_stress` as of `measured_design`.

    Raises `InputError` and `FileError` as `Bench.solve`; without a measured surface.
    """
    profiles = each_measured(case.surface)
    if not profiles:
        raise InputError("the direct contact needs a measured profile; got waves stated by hand")
    direct = DirectContact(tolerance=JUDGED_TO, conditions=case.conditions)
    points: list[Point] = []
    for sample, (name, surface) in enumerate(profiles):
        label = f"{name}: " if len(profiles) > 1 else ""
        line = measured_design(
            measured, direct, case.measured_rubber, surface, case.load, label, warming_stress
        )
        points += [replace(point, index=(*point.index, sample)) for point in line.points]
    sizes = {**line.sizes, "sample": len(profiles)}
    subjects = {"subject": ("sample", [name for name, _ in profiles])}
    samples = solve_design(Design(sizes, points, subjects), bench, sample_numbers)
    curves: list[xr.Dataset | None] = [None] * len(line.points)
    if case.below_measurement.down_to is not None:
        model = case.continuation()
        rubber, label = case.measured_rubber, "continued: "
        continued = measured_design(
            measured, model, rubber, case.surface, case.load, label, warming_stress
        )
        solved = bench.solve(continued.tasks, contact_curves)
        curves = [solved[point.task.key] for point in continued.points]
    rows = []
    for at, (point, curve) in enumerate(zip(line.points, curves, strict=True)):
        of_point = samples.isel(measurement=at)
        rows.append(direct_contact_totals(of_point, case, point.task.load, curve))
        if curve is not None and curve[models.STATUS].item() != CONVERGED:
            rows[-1] = curve
    numbers = {
        "total_friction": HYSTERESIS if HYSTERESIS in rows[0] else "answer_friction",
        "total_contact_fraction": "answer_contact_fraction",
        models.ADHESIVE_FRICTION: INTERFACE,
        models.FRICTION_OUTSIDE_BAND: models.FRICTION_OUTSIDE_BAND,
    }
    columns: dict[str, Any] = {
        name: [float(row.get(in_answer, math.nan)) for row in rows]
        for name, in_answer in numbers.items()
    }
    for name in (models.STATUS, models.STATUS_WORD):
        columns[name] = np.array([row[name].item() for row in rows], dtype=object)
    data = xr.Dataset({name: ("measurement", values) for name, values in columns.items()})
    return predicted_of(data.assign_coords(line.coords))


_SOURCE = "gripscale residuals"


def residuals(
    measured: MeasuredFriction,
    predicted: Mapping[str, Predicted],
    shear_stress: InterfacialShearStress | None = None,
) -> xr.Dataset:
    """Return predicted friction beside measured friction, over `model` and `measurement`.

    The result has `hysteresis`, `area_term` where there is a law, `friction` (their sum),
    `difference` (predicted less measured) and `difference_in_spread` (NaN where no spread is known)
    over `model` and `measurement`; `rms_difference` and `rms_difference_in_spread` over `model`, of
    the points that have an answer; and what was measured. Raises `InputError` if a prediction has
    another number of points or other pressures than the measurement, there is none, or the law
    needs a temperature that is not known.

    Parameters
    ----------
    measured : MeasuredFriction
        What was measured.
    predicted : mapping of str to Predicted
        What each model says at its points, in their order, by the model's name.
    shear_stress : InterfacialShearStress, optional
        Law of an area term that the total friction has beside the hysteresis.
    """
    checks.instance("measured", measured, MeasuredFriction)
    if not isinstance(predicted, Mapping) or not predicted:
        short = checks.short_repr(predicted)
        raise InputError(f"predicted must hold the prediction of at least one model; got {short}")
    if shear_stress is not None and not isinstance(shear_stress, InterfacialShearStress):
        short = checks.short_repr(shear_stress)
        raise InputError(f"shear_stress must be a law of gripscale.conditions; got {short}")
    for name, prediction in predicted.items():
        checks.instance("each of predicted", prediction, Predicted)
        prediction.require_points_of(measured, name)
    grid, predictions = ("model", "measurement"), predicted.values()
    total = hysteresis = np.array([prediction.friction for prediction in predictions])
    columns: dict[str, Any] = {"hysteresis": (grid, hysteresis, "friction of the hysteresis")}
    if shear_stress is not None:
        law, speed = shear_stress, measured.speed
        terms = np.array([prediction.area_term(law, speed) for prediction in predictions])
        columns["area_term"] = (grid, terms, "friction of the area term")
        total = hysteresis + terms
    difference = total - measured.friction
    relative = in_spread(difference, measured.spread)
    about = "predicted less measured friction"
    columns |= {
        "friction": (grid, total, "predicted friction coefficient"),
        "difference": (grid, difference, about),
        "difference_in_spread": (grid, relative, f"{about}, over its spread"),
        "rms_difference": ("model", rms(difference), f"rms of {about}"),
        "rms_difference_in_spread": ("model", rms(relative), f"rms of {about}, over its spread"),
    }
    data = {
        name: labelled(dims, values, "1", text, _SOURCE)
        for name, (dims, values, text) in columns.items()
    }
    return xr.Dataset(data | measured_variables(measured), coords={"model": list(predicted)})


def in_spread(difference: Array, spread: Array) -> Array:
    """Return differences over the spread [-]; NaN where it is not known or zero."""
    return difference / np.where(spread > 0.0, spread, np.nan)


def rms(values: Array) -> Array:
    """Return the root mean square over the last axis of what is known, NaN where nothing is."""
    finite = np.isfinite(values)
    count = finite.sum(axis=-1)
    squares = np.where(finite, values, 0.0) ** 2
    return np.asarray(np.sqrt(squares.sum(axis=-1) / np.where(count > 0, count, np.nan)))
