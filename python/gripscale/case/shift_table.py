"""The time-temperature shift of a case: a table of factors in a file, or a law with its numbers."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, InstanceOf

from gripscale.case.quantity import MolarEnergy, Temperature, TemperatureDifference
from gripscale.case.table import Table, by_kind
from gripscale.rubber.shift import Shift, shift_from_dict

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Range = Annotated[list[Temperature], Field(min_length=2, max_length=2)]


class ShiftLaw(Table):
    """A law of the shift, with the temperatures between which it was found."""

    kind: str
    valid_range: Range | None = None

    def law(self) -> Shift:
        """Return the shift; raise `InputError` if its numbers do not fit together."""
        return shift_from_dict(self.model_dump(exclude_none=True))


class WLFTable(ShiftLaw):
    """WLF, at the reference temperature of the rubber unless it states its own."""

    kind: Literal["wlf"]
    c1: Positive
    c2: TemperatureDifference
    reference_temperature: Temperature | None = None


class ArrheniusTable(ShiftLaw):
    """One activation energy."""

    kind: Literal["arrhenius"]
    activation_energy: MolarEnergy


class WLFArrheniusTable(ShiftLaw):
    """WLF above the glass transition, Arrhenius below."""

    kind: Literal["wlf_arrhenius"]
    c1: Positive
    c2: TemperatureDifference
    activation_energy: MolarEnergy
    glass_temperature: Temperature
    reference_temperature: Temperature | None = None


LAWS: dict[str, type[Table]] = {
    "wlf": WLFTable,
    "arrhenius": ArrheniusTable,
    "wlf_arrhenius": WLFArrheniusTable,
}

_read = by_kind(LAWS).func


def _source(value: Any) -> Any:
    """Accept the name of a file, or a law."""
    return value if isinstance(value, str) else _read(value)  # type: ignore[call-arg]


ShiftSource = Annotated[InstanceOf[ShiftLaw] | str, BeforeValidator(_source)]
