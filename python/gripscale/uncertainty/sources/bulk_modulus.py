"""The source `bulk_modulus`: hardly ever measured together with a master curve.

Of rubbers it lies between 1 and 3 GPa (A. N. Gent, Engineering with Rubber, 3rd ed. (2012), ch. 1);
1.5 times more or less than the usual 2 GPa covers that range.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.quantities import modulus
from gripscale.uncertainty.range import Range
from gripscale.uncertainty.sources.source import Coordinate, Stated

FACTOR = 1.5


@dataclass(frozen=True)
class BulkModulusSource:
    """The bulk modulus, by default 1.5 times more or less than that of the case."""

    name: ClassVar[str] = "bulk_modulus"
    label: ClassVar[str] = "bulk modulus"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "bulk_modulus": Coordinate("Pa", "bulk modulus")
    }

    range: Range

    @classmethod
    def of(cls, known: Measurement, stated: Stated) -> BulkModulusSource:
        """Return the source of a case."""
        if stated.values is None:
            return cls(Range.about(known.rubber.bulk_modulus, FACTOR))
        return cls(Range.read(cls.name, stated.values, modulus))

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the bulk modulus at `place` of its range."""
        value = self.range.at(place)
        rubber = replace(inputs.rubber, bulk_modulus=value)
        return replace(inputs, rubber=rubber), {self.name: value}
