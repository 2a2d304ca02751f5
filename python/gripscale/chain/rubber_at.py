"""Conditions that change the rubber on the way from wave to wave."""

from __future__ import annotations

from typing import Protocol

from gripscale.chain.prediction import Prediction
from gripscale.rubber import Rubber
from gripscale.wave.problem import Sine


class RubberAt(Protocol):
    """Conditions that change the rubber on the way: temperature, strain, what was solved so far."""

    def __call__(self, wave: Sine, so_far: Prediction) -> Rubber:
        """Return the rubber as it is on `wave`, next after those of `so_far`."""
