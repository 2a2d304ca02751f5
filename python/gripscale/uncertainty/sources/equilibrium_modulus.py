"""The source `equilibrium_modulus`: what is left of the modulus after infinite time.

A DMA measurement does not reach it, and the source `modulus` varies it as far as the slow end of
the data leaves it open. Somebody who knows it better, or less, states it: it has no default.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.quantities import modulus
from gripscale.uncertainty.range import Range
from gripscale.uncertainty.sources.source import Coordinate, NotHere, Stated


@dataclass(frozen=True)
class EquilibriumModulusSource:
    """The equilibrium modulus, where somebody states it."""

    name: ClassVar[str] = "equilibrium_modulus"
    label: ClassVar[str] = "equilibrium modulus"
    models: ClassVar[tuple[str, ...]] = ("chain", "direct")
    coordinates: ClassVar[Mapping[str, Coordinate]] = {
        "equilibrium_modulus": Coordinate("Pa", "equilibrium modulus")
    }

    range: Range

    @classmethod
    def of(cls, known: Measurement, stated: Stated) -> EquilibriumModulusSource:
        """Return the source of a case; raise `NotHere` where nobody states it."""
        if stated.values is None:
            raise NotHere("no range is given; modulus varies it as far as the data leave it open")
        return cls(Range.read(cls.name, stated.values, modulus))

    def draw(
        self, place: float, random: np.random.Generator, inputs: Inputs
    ) -> tuple[Inputs, Mapping[str, float]]:
        """Return the inputs with the equilibrium modulus at `place` of its range."""
        value = self.range.at(place)
        rubber = replace(inputs.rubber, equilibrium_modulus=value, admissible=None)
        return replace(inputs, rubber=rubber), {self.name: value}
