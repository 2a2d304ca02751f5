"""Fitting the area term to measured friction; the hysteresis is never fitted.

mu_measured = mu_hysteresis(v, T, p) + tau_f(v, T; theta) A_r/(A_0 p)
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from gripscale.analysis.calibration_law import (
    Optimum,
    Problem,
    best,
    check_names,
    family_of,
    points_of,
)
from gripscale.analysis.measured_comparison import (
    Predicted,
    friction_of_case,
    in_spread,
    measured_variables,
    predict_points,
)
from gripscale.analysis.measured_friction import MeasuredFriction
from gripscale.analysis.profile_likelihood import (
    LEVEL,
    WAYS,
    FittedLaw,
    Profile,
    groups_of,
    held_out,
    settled,
    threshold_of,
)
from gripscale.case.read import CaseFile
from gripscale.case.results import CaseResults
from gripscale.case.run import prepare_case
from gripscale.conditions.area_term import shear_stress_to_dict
from gripscale.core import checks, provenance
from gripscale.core.errors import InputError
from gripscale.core.units import ZERO_CELSIUS, parse_quantity
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.half_space.model import DirectContact
from gripscale.model import Model
from gripscale.rubber.extrapolation import WORTH_SAYING, require_measured
from gripscale.wave.result import labelled

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.analysis.profile_likelihood import Estimate, FittedLaw


# What a calibration answers, as numbers and as a Dataset.


@dataclass(frozen=True, eq=False)
class Calibration(FittedLaw):
    """A law of the area term fitted to measured friction beside a predicted hysteresis."""

    def to_dataset(self) -> xr.Dataset:
        """Return all of it as a labelled Dataset, see `gripscale.analysis.calibration`."""
        return to_dataset(self)


def calibrate(
    measured: MeasuredFriction,
    predicted: Predicted,
    *,
    law: str = "gaussian",
    fixed: Mapping[str, float] | None = None,
    hold_out: str | None = None,
) -> Calibration:
    """Fit a law of the interfacial shear stress to measured friction.

    Weighted with the spread of the measurement; without any, all points weigh the same and the
    scatter of the residuals is taken for it.

    Parameters
    ----------
    measured : MeasuredFriction
        What was measured.
    predicted : Predicted
        The hysteresis and the real contact area at its points, see `predictions_at`.
    law : str
        "constant", "gaussian" or "le_gal_klueppel", see `gripscale.conditions`.
    fixed : mapping of str to float, optional
        Parameters of the law that are known [SI units, eV], by name.
    hold_out : str, optional
        "temperature" or "speed": predict each temperature, or each decade of speed, from the
        others.

    Raises
    ------
    InputError
        If a value cannot be used, points are too few for the law, or the hysteresis alone exceeds
        what was measured at more than half of the points.
    """
    checks.instance("measured", measured, MeasuredFriction)
    checks.instance("predicted", predicted, Predicted)
    known = {} if fixed is None else dict(checks.instance("fixed", fixed, Mapping))  # type: ignore[type-abstract]
    points = points_of(measured, predicted)
    problem = Problem(points, family_of(law, points, known))
    groups = None
    if hold_out is not None:
        groups = groups_of(hold_out, measured.speed, measured.temperature)[predicted.known]
    optimum, ends = settled(
        problem, best(problem), lambda found: _ends(problem, found, points.spread is not None)
    )
    out = () if groups is None else held_out(points, groups, law, known)
    return Calibration(measured, predicted, problem, optimum, tuple(ends), out, hold_out or "")


def _ends(problem: Problem, optimum: Optimum, known: bool) -> list[tuple[float, float]]:
    threshold = threshold_of(optimum, known=known)
    profiles = [Profile(problem, optimum, place) for place in range(len(problem.family.free))]
    return [(one.end(-1, threshold), one.end(1, threshold)) for one in profiles]


# The area term of a case: its measured friction beside the hysteresis of one of the models.

MODELS = ("direct", "chain")
"""Models whose hysteresis an area term can be put beside."""

KINDS_OF_QUANTITY = {
    "stress_0": "pressure",
    "speed_0": "speed",
    "critical_speed": "speed",
    "activation_energy": "bond energy",
    "reference_temperature": "temperature",
}
"""What the parameters of the laws are, those that are no plain numbers."""


def calibrate_case(
    case: CaseResults | CaseFile | str | Path,
    *,
    model: str = "direct",
    law: str = "gaussian",
    fixed: Mapping[str, float] | None = None,
    hold_out: str | None = None,
    measured: MeasuredFriction | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> Calibration:
    """Predict the hysteresis of a case at every measured point and fit an area term beside it.

    Parameters
    ----------
    case : path, CaseFile or CaseResults
        The case; `prepare_case` gives one with its inputs prepared. An area term of its own has no
        part in it.
    model : str
        "direct" or "chain": what predicts the hysteresis and the real contact area.
    law, fixed, hold_out
        As for `calibrate`.
    measured : MeasuredFriction, optional
        What was measured; what `[measured] friction` of the case names by default.
    folder : path, optional
        Keeps each answer as soon as it is there, in `predictions`; what it has is not solved again.
    workers, client, on_task
        As for `gripscale.experiment.solve_all`.

    Raises
    ------
    InputError, FileError
        As `calibrate` and the models do; if the case names no measured friction; if it refuses
        extrapolation and a point excites the rubber beyond its measured frequencies.
    """
    checks.one_of("model", model, MODELS)
    check_names(law, fixed or ())
    if hold_out is not None:
        checks.one_of("hold_out", hold_out, WAYS)
    results = case if isinstance(case, CaseResults) else prepare_case(case)
    found = measured or measured_of(results.file)
    if results.file.case.rubber.extrapolate == "refuse":
        _require_measured(results, found)
    with bench_in(folder, workers, client, on_task) as bench:
        predicted = predict_points(
            found,
            _model(model, results),
            results.rubber.rubber,
            results.surface,
            results.load,
            bench,
        )
    return calibrate(found, predicted, law=law, fixed=fixed, hold_out=hold_out)


def measured_of(file: CaseFile) -> MeasuredFriction:
    """Return the friction a case names; raise `InputError` if it names none."""
    found = friction_of_case(file)
    if found is None:
        raise InputError(
            f"{file.path}: [measured] friction must name a table of measured friction; got none"
        )
    return found


def parse_fixed(texts: Iterable[str]) -> dict[str, float]:
    """Return parameters stated as "width=0.1" or "stress_0=5 MPa" [SI units, eV].

    Raises `InputError` if one cannot be understood.
    """
    found: dict[str, float] = {}
    for text in texts:
        name, sign, value = (part.strip() for part in text.partition("="))
        if not sign or not name or name in found:
            raise InputError(
                f"fixed must be name=value, each name once; got {checks.short_repr(text)}"
            )
        found[name] = _value(name, value)
    return found


def _value(name: str, text: str) -> float:
    try:
        if name in KINDS_OF_QUANTITY:
            return parse_quantity(text, KINDS_OF_QUANTITY[name])
        return float(text)
    except ValueError as error:
        why = str(error) if name in KINDS_OF_QUANTITY else "expected a number"
        raise InputError(f"fixed {name} = {checks.short_repr(text)}: {why}") from error


def _model(name: str, results: CaseResults) -> Model:
    return results.chain if name == "chain" else DirectContact(conditions=results.conditions)


def _require_measured(results: CaseResults, measured: MeasuredFriction) -> None:
    for speed, kelvin in zip(measured.speed, measured.temperature, strict=True):
        before = results.rubber_before
        rubber = before if np.isnan(kelvin) else results.rubber.rubber.at(float(kelvin))
        require_measured(rubber, results.surface.sines.wavelength, float(speed))


# What must be said of a calibration beside its numbers.

UNLIKELY = 0.01
"""Chance of the sum of squares below which something must be wrong."""


def notes(calibration: FittedLaw) -> Iterator[str]:
    """Yield a sentence on each thing to know before the numbers are used."""
    yield from _of_fit(calibration)
    yield from _parameter_notes(calibration)
    yield from _of_predictions(calibration)


def _of_fit(calibration: FittedLaw) -> Iterator[str]:
    if not calibration.spread_known:
        yield (
            f"No spread is stated: the scatter of the residuals, {calibration.scatter:.2g}, "
            "is taken for it, whatever makes it."
        )
    elif calibration.chance < UNLIKELY:
        yield (
            f"The residuals are {calibration.scatter:.2g} times the stated spread: law, hysteresis "
            "or spread is wrong, and the intervals are too narrow."
        )
    yield (
        "The intervals hold for the spread of the measurement alone: an error of the predicted "
        "contact area is an error of the shear stress."
    )


def _parameter_notes(calibration: FittedLaw) -> Iterator[str]:
    held = calibration.problem.family.held
    if calibration.law.kind == "gaussian" and held.get("activation_energy") == 0.0:
        yield (
            "No activation energy: temperatures in the contact "
            f"{calibration.problem.points.temperature_range:.2g} K apart do not determine one, and "
            "the law holds at the temperature measured."
        )
    for one in calibration.estimates:
        ends = {"lower": one.low, "upper": one.high}
        missing = [word for word, end in ends.items() if not np.isfinite(end)]
        if len(missing) == 2:
            yield f"{one.name} is not determined by the data."
        elif missing:
            yield f"The {missing[0]} end of {one.name} is not determined by the data."


def _of_predictions(calibration: FittedLaw) -> Iterator[str]:
    predicted = calibration.predicted
    without = int((~predicted.known).sum())
    if without:
        why = next(s for s, k in zip(predicted.status, predicted.known, strict=True) if not k)
        yield f"Measured points without a prediction, which do not count: {without}, as {why}."
    below = int((calibration.problem.points.difference < 0.0).sum())
    if below:
        yield f"Measured points below the hysteresis alone: {below}."
    beyond = int((predicted.outside_band > WORTH_SAYING).sum())
    if beyond:
        yield (
            f"Points where more than {WORTH_SAYING:.0%} of the hysteresis rests on the rubber "
            f"outside its measured frequencies: {beyond}."
        )


# The fitted law as the table of a case file, ready to be pasted.

WRITTEN: Mapping[str, tuple[Callable[[float], float], str]] = {
    "Pa": (lambda value: value / 1e6, "MPa"),
    "m/s": (lambda value: value, "m/s"),
    "eV": (lambda value: value, "eV"),
    "K": (lambda value: value - ZERO_CELSIUS, "C"),
    "": (lambda value: value, ""),
}
"""How a number in a unit of the law is written: conversion and unit."""

HELD_UNITS = {
    "stress_0": "Pa",
    "speed_0": "m/s",
    "critical_speed": "m/s",
    "activation_energy": "eV",
    "reference_temperature": "K",
}
"""Units of parameters that may be held; the others have none."""


def shear_stress_table(calibration: FittedLaw) -> str:
    """Return the table [conditions.shear_stress] of the fitted law, with its intervals."""
    law = shear_stress_to_dict(calibration.law)
    estimates = {one.name: one for one in calibration.estimates}
    source = Path(calibration.measured.source).name or "a measurement"
    lines = [
        f"# Fitted to {calibration.problem.points.speed.size} points of {source};",
        f"# intervals of {LEVEL:.0%} by profile likelihood, for this rubber on this surface.",
        "[conditions.shear_stress]",
        f'kind = "{law.pop("kind")}"',
    ]
    if calibration.law.kind == "gaussian" and law["activation_energy"] == 0.0:
        del law["activation_energy"], law["reference_temperature"]
        lines.insert(2, "# No activation energy: it holds at the temperature measured.")
    for name, value in law.items():
        lines.append(" ".join(_line(name, float(value), estimates.get(name))))
    return "\n".join(lines) + "\n"


def written(value: float, unit: str, digits: int | None = None) -> str:
    """Return a number of the law with its unit: six digits as far as they count, or `digits`."""
    convert, name = WRITTEN[unit]
    number = convert(value)
    text = f"{number:.6g}" if digits is None else f"{number:#.{digits}g}".rstrip(".")
    return f"{text} {name}".strip()


def interval(estimate: Estimate) -> str:
    """Return the interval of a parameter in words, in the unit it is written in."""
    low, high = (f"{written(end, estimate.unit, 3)}" for end in (estimate.low, estimate.high))
    if estimate.determined:
        return f"{low} to {high}"
    if math.isfinite(estimate.low):
        return f"from {low}, upper end not determined"
    if math.isfinite(estimate.high):
        return f"up to {high}, lower end not determined"
    return "not determined"


def _line(name: str, value: float, estimate: Estimate | None) -> Iterator[str]:
    unit = estimate.unit if estimate is not None else HELD_UNITS.get(name, "")
    text = written(value, unit)
    yield f"{name} = {text}" if not unit else f'{name} = "{text}"'
    yield f" # {'held' if estimate is None else interval(estimate)}"


# A calibration as a labelled Dataset: over measured points, parameters and what is left out.
#
# - over `measurement`: what was measured, the hysteresis, the area term, their sum and its band;
# - over `parameter`: estimate, standard error, interval (NaN where not determined), profile;
# - over `left_out`: the errors of the law fitted to the other points.

SOURCE = "gripscale calibrate"

HELD_OUT = {
    "points": "measured points left out",
    "rms_inside": "rms residual of the points that were fitted",
    "rms_outside": "rms error at the points left out",
    "rms_outside_in_spread": "the same, over the spread",
    "why_not": "why the other points cannot predict them, empty where they can",
}
"""Numbers of what was left out, with their meaning."""


def to_dataset(calibration: FittedLaw) -> xr.Dataset:
    """Return `calibration` as a Dataset."""
    data = {
        **measured_variables(calibration.measured),
        **_at_points(calibration),
        **_parameter_variables(calibration),
        **_left_out(calibration),
    }
    words = {
        "parameter": [one.name for one in calibration.estimates],
        "other_parameter": [one.name for one in calibration.estimates],
    }
    return xr.Dataset(
        data,
        coords=words,
        attrs={
            "title": "Area term fitted to measured friction",
            "law": json.dumps(shear_stress_to_dict(calibration.law)),
            "held": json.dumps(dict(calibration.problem.family.held)),
            "measured_source": calibration.measured.source,
            "level": LEVEL,
            "threshold": calibration.threshold,
            "held_out_by": calibration.held_out_by,
            "spread_known": int(calibration.spread_known),
            "sum_of_squares": calibration.optimum.sum_of_squares,
            "degrees_of_freedom": calibration.freedom,
            "scatter": calibration.scatter,
            **provenance.attributes(),
        },
    )


def _at_points(calibration: FittedLaw) -> dict[str, Any]:
    predicted, measured = calibration.predicted, calibration.measured
    apart = calibration.friction - measured.friction
    columns = {
        "nominal_pressure": (predicted.pressure, "Pa", "nominal pressure of the prediction"),
        "contact_temperature": (predicted.temperature, "K", "temperature in the contact"),
        "contact_fraction": (predicted.contact_fraction, "1", "real over nominal contact area"),
        "hysteresis": (predicted.friction, "1", "friction of the hysteresis"),
        "friction_outside_band": (
            predicted.outside_band,
            "1",
            "share of it that rests on the rubber outside the measured frequencies",
        ),
        "prediction_status": (np.array(predicted.status, dtype=object), "1", "converged, or why"),
        "area_term": (calibration.area_term, "1", "friction of the area term"),
        "friction": (calibration.friction, "1", "hysteresis and area term"),
        "friction_band": (calibration.band, "1", "half of its interval by the fit"),
        "difference": (apart, "1", "predicted less measured friction"),
        "difference_in_spread": (
            in_spread(apart, measured.spread),
            "1",
            "the same over the spread",
        ),
    }
    return {
        name: labelled("measurement", values, unit, text, SOURCE)
        for name, (values, unit, text) in columns.items()
    }


def _parameter_variables(calibration: FittedLaw) -> dict[str, Any]:
    estimates, profiles = calibration.estimates, calibration.profiles
    columns = {
        "estimate": "best value of the parameter, in its unit",
        "standard_error": "its standard error by the Jacobian",
        "low": "lower end of its interval by profile likelihood, NaN where not determined",
        "high": "upper end of it, NaN where not determined",
    }
    values = {
        name: [getattr(one, "value" if name == "estimate" else name) for one in estimates]
        for name in columns
    }
    data = {
        name: labelled("parameter", values[name], "1", columns[name], SOURCE) for name in values
    }
    units = [one.unit or "1" for one in estimates]
    data["unit"] = labelled("parameter", np.array(units, dtype=object), "1", "its unit", SOURCE)
    data["correlation"] = labelled(
        ("parameter", "other_parameter"), calibration.correlation, "1", "of the estimates", SOURCE
    )
    for at, (name, text) in enumerate(
        {
            "profile_value": "value at which the parameter is held",
            "profile_excess": "rise of the sum of squares, NaN where another parameter has no room",
        }.items()
    ):
        rows = [profiles[one.name][at] for one in estimates]
        data[name] = labelled(("parameter", "step"), rows, "1", text, SOURCE)
    return data


def _left_out(calibration: FittedLaw) -> dict[str, Any]:
    groups = calibration.held_out
    if not groups:
        return {}
    data = {
        name: labelled("left_out", [getattr(one, name) for one in groups], "1", text, SOURCE)
        for name, text in HELD_OUT.items()
    }
    data["left_out"] = labelled(
        "left_out", [one.value for one in groups], "1", "temperature [K] or decade [m/s]", SOURCE
    )
    return data
