"""The time-temperature shift of a case: a table of factors in a file, or a law with its numbers."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, InstanceOf

from gripscale.case.expected import Words
from gripscale.case.quantity import MolarEnergy, Temperature, TemperatureDifference
from gripscale.case.table import Table, a_table, by_kind
from gripscale.rubber.shift import Shift, shift_from_dict

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Range = Annotated[list[Temperature], Field(min_length=2, max_length=2)]


class ShiftLaw(Table):
    """A law of the shift, with the temperatures between which it was found."""

    kind: str
    valid_range: Range | None = None
    """Temperatures between which the law was found."""

    def law(self) -> Shift:
        """Return the shift; raise `InputError` if its numbers do not fit together."""
        return shift_from_dict(self.model_dump(exclude_none=True))


class WLFTable(ShiftLaw):
    """WLF, at the reference temperature of the rubber unless it states its own."""

    kind: Literal["wlf"]
    """Williams, Landel and Ferry's law."""
    c1: Positive
    """First constant of WLF."""
    c2: TemperatureDifference
    """Second constant of WLF."""
    reference_temperature: Temperature | None = None
    """Temperature the constants hold for; that of the rubber by default."""


class ArrheniusTable(ShiftLaw):
    """One activation energy."""

    kind: Literal["arrhenius"]
    """Arrhenius' law."""
    activation_energy: MolarEnergy
    """Its activation energy."""


class WLFArrheniusTable(ShiftLaw):
    """WLF above the glass transition, Arrhenius below."""

    kind: Literal["wlf_arrhenius"]
    """WLF above the glass transition, Arrhenius below."""
    c1: Positive
    """First constant of WLF."""
    c2: TemperatureDifference
    """Second constant of WLF."""
    activation_energy: MolarEnergy
    """Activation energy below the glass transition."""
    glass_temperature: Temperature
    """Where one gives way to the other."""
    reference_temperature: Temperature | None = None
    """Temperature the constants hold for; that of the rubber by default."""


LAWS: dict[str, type[Table]] = {
    "wlf": WLFTable,
    "arrhenius": ArrheniusTable,
    "wlf_arrhenius": WLFArrheniusTable,
}

_read = by_kind(LAWS).read


def _source(value: Any) -> Any:
    """Accept the name of a file, or a law."""
    return value if isinstance(value, str) else _read(value)


ShiftSource = Annotated[
    InstanceOf[ShiftLaw] | str,
    BeforeValidator(_source),
    Words(f"the name of a file or {a_table(LAWS)}"),
]
