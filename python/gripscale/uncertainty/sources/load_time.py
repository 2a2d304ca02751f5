"""The source `load_time`: how long the mean state of a wave has had to relax.

That is the passage of the contact above, t_i = A_(i-1)/v: the order of a time, not its value.
Contacts are shorter and longer than their mean; a factor of two each way stands for that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.quantities import factor
from gripscale.uncertainty.range import Range
from gripscale.uncertainty.sources.source import Coordinate, NotHere, Stated

FACTOR = 2.0


@dataclass(frozen=True)
class LoadTimeSource:
    """The load time of every wave of a chain over its passage, by default 1/2 to 2."""

    name: ClassVar[str] = "load_time"
    label: ClassVar[str] = "load time of a wave"
    models: ClassVar[tuple[str, ...]] = ("chain",)
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "load_time_factor": Coordinate("1", "load time over that of the case")
    }

    range: Range

    @classmethod
    def of(cls, known: Measurement, stated: Stated) -> LoadTimeSource:
        """Return the source of a case; raise `NotHere` at rest or if the case states a time."""
        if known.speed == 0.0:
            raise NotHere("at rest it is infinite")
        if stated.values is not None:
            return cls(Range.read(cls.name, stated.values, factor))
        if known.load_time != "passage":
            raise NotHere("the case states it")
        return cls(Range.about(1.0, FACTOR))

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the factor at `place` of its range."""
        value = self.range.at(place)
        return replace(inputs, load_time_factor=value), {"load_time_factor": value}
