"""The source `cut_off`: where the roughness ends that the rubber feels.

Nobody knows it better than to an octave: by default it is spread over one about that of the case,
evenly in its logarithm, as d ln mu / d ln(cut-off) is nearly constant.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.quantities import length
from gripscale.uncertainty.range import Range
from gripscale.uncertainty.sources.source import Coordinate, NotHere, Stated


@dataclass(frozen=True)
class CutOffSource:
    """The cut-off of the case, or its last wave where it states none: an octave about it."""

    name: ClassVar[str] = "cut_off"
    label: ClassVar[str] = "cut-off"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "cut_off": Coordinate("m", "cut-off, or last wave, of the roughness")
    }

    range: Range

    @classmethod
    def of(cls, known: Measurement, stated: Stated) -> CutOffSource:
        """Return the source of a case; raise `NotHere` where its waves are stated by hand."""
        if not known.fitted:
            raise NotHere("the waves are stated by hand")
        if stated.values is not None:
            return cls(Range.read(cls.name, stated.values, length))
        return cls(Range.about(known.surface.sines.roughness_end, math.sqrt(2.0)))

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the end of the roughness at `place` of its range."""
        value = self.range.at(place)
        return inputs.ended_at(value), {self.name: value}
