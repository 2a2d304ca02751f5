"""The area term of a case: its measured friction beside the hysteresis of one of the models."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from gripscale import checks
from gripscale.calibration.fit import calibrate
from gripscale.calibration.held_out import WAYS
from gripscale.calibration.parameters import check_names
from gripscale.calibration.result import Calibration
from gripscale.case.read import CaseFile
from gripscale.case.results import CaseResults
from gripscale.case.run import prepare_case
from gripscale.errors import InputError
from gripscale.measured.friction import MeasuredFriction
from gripscale.measured.of_case import friction_of_case
from gripscale.measured.predicted import predictions_at
from gripscale.model import Model
from gripscale.rough.model import DirectContact
from gripscale.rubber.extrapolation import require_measured
from gripscale.study.store import store_in
from gripscale.study.threads import OnTask
from gripscale.units import parse_quantity

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
        As for `gripscale.study.solve_all`.

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
    with store_in(folder) as store:
        predicted = predictions_at(
            found,
            _model(model, results),
            results.rubber.rubber,
            results.surface,
            results.load,
            store,
            workers=workers,
            client=client,
            on_task=on_task,
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
            raise InputError(f"fixed must be name=value, each name once; got {checks.shown(text)}")
        found[name] = _value(name, value)
    return found


def _value(name: str, text: str) -> float:
    try:
        if name in KINDS_OF_QUANTITY:
            return parse_quantity(text, KINDS_OF_QUANTITY[name])
        return float(text)
    except ValueError as error:
        why = str(error) if name in KINDS_OF_QUANTITY else "expected a number"
        raise InputError(f"fixed {name} = {checks.shown(text)}: {why}") from error


def _model(name: str, results: CaseResults) -> Model:
    return results.chain if name == "chain" else DirectContact(conditions=results.conditions)


def _require_measured(results: CaseResults, measured: MeasuredFriction) -> None:
    for speed, kelvin in zip(measured.speed, measured.temperature, strict=True):
        before = results.rubber_before
        rubber = before if np.isnan(kelvin) else results.rubber.rubber.at(float(kelvin))
        require_measured(rubber, results.surface.sines.wavelength, float(speed))
