"""What a study can vary: the inputs with their units, and one of them with its values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gripscale.chain.pressure import MOST_CLASSES
from gripscale.shown import KEYS, Shown, shown
from gripscale.surface.cut_off import RmsSlope
from gripscale.surface.sine_fit import MOST_WAVES

QUANTITIES = {
    "speed": "speed",
    "pressure": "pressure",
    "temperature": "temperature",
    "smallest_wavelength": "length",
    "cut_off": "length",
}
"""Axes of numbers, with the kind of quantity."""

COUNTS = {"waves": MOST_WAVES, "pressure_classes": MOST_CLASSES}
"""Axes of whole numbers, with the largest."""

NUMBERS = (*QUANTITIES, *COUNTS, "upper_share")
"""Axes whose values are numbers."""

UNITS = {
    "speed": "m/s",
    "pressure": "Pa",
    "temperature": "K",
    "smallest_wavelength": "m",
    "cut_off": "m",
    "upper_share": "1",
    "waves": "1",
    "pressure_classes": "1",
    "factors": "1",
    "effects": "1",
    "rubber": "1",
    "surface": "1",
}
"""All axes, with the units of their values."""

LONG_NAMES = {
    "speed": "sliding speed",
    "pressure": "nominal pressure",
    "temperature": "temperature of the rubber before the contact",
    "smallest_wavelength": "smallest wavelength",
    "cut_off": "shortest wavelength of the roughness",
    "upper_share": "share of the heights that counts",
    "waves": "number of waves",
    "pressure_classes": "number of pressure classes",
    "factors": "magnification factors of wavelength and amplitude",
    "effects": "effects of the conditions on the rubber",
    "rubber": "rubber",
    "surface": "surface",
}


@dataclass(frozen=True)
class Axis:
    """One varied input: its values as the study uses them, and what they are called."""

    name: str
    values: tuple[Any, ...]
    labels: tuple[str, ...]
    unit: str = ""
    """The unit the values were given in; empty for plain numbers."""

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers, in the unit of `UNITS`."""
        return self.name in NUMBERS and not any(
            isinstance(value, str | RmsSlope) for value in self.values
        )

    @property
    def coordinate(self) -> list[Any]:
        """Values along the axis of a Dataset: numbers, or labels."""
        return list(self.values) if self.numeric else list(self.labels)

    def shown(self, case: str) -> Shown | None:
        """Return how its values are shown, in a study of this text of a case; None of no length."""
        if not self.numeric or self.name not in KEYS:
            return None
        return shown(self.name, case, self.unit)

    def called(self, i: int, case: str) -> str:
        """Return what value `i` is called in a study of this text of a case."""
        how = self.shown(case)
        return self.labels[i] if how is None else how.text(self.values[i])
