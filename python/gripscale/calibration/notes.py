"""What must be said of a calibration beside its numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from gripscale.rubber.extrapolation import WORTH_SAYING

if TYPE_CHECKING:
    from gripscale.calibration.fitted import FittedLaw

UNLIKELY = 0.01
"""Chance of the sum of squares below which something must be wrong."""


def notes(calibration: FittedLaw) -> Iterator[str]:
    """Yield a sentence on each thing to know before the numbers are used."""
    yield from _of_fit(calibration)
    yield from _of_parameters(calibration)
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


def _of_parameters(calibration: FittedLaw) -> Iterator[str]:
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
