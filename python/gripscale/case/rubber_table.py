"""[rubber] of a case: measured moduli with what their file does not state, or a known rubber.

Pressures in Pa and temperatures in K once read.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, InstanceOf, model_validator

from gripscale.case.columns import Column, Columns
from gripscale.case.expected import Words
from gripscale.case.quantity import Pressure, Temperature, TemperatureDifference, unit_of_file
from gripscale.case.shift_table import ShiftSource
from gripscale.case.table import Table
from gripscale.rubber.strain_energy import NeoHookean, StrainEnergy, strain_energy_from_dict
from gripscale.textfile import MOST_LINES

NAMED_RUBBERS = ("styrene_butadiene",)

STRAIN_ENERGY = 'a table such as { kind = "mooney_rivlin", share = 0.2 }'


def _strain_energy(value: Any) -> StrainEnergy:
    """Accept a table such as { kind = "yeoh", second = -0.1, third = 0.02 }."""
    if isinstance(value, StrainEnergy):
        return value
    if not isinstance(value, dict):
        raise ValueError(f"expected {STRAIN_ENERGY}")
    return strain_energy_from_dict(value)


class RubberSource(Table):
    """Measured moduli, with what their file does not state, or a rubber known by name.

    The file is a master curve, or sweeps at several temperatures to make one of.
    """

    file: str | None = None
    """A measured master curve, or sweeps at several temperatures."""
    name: Literal["styrene_butadiene"] | None = None
    """A rubber known by name, in place of a file."""
    frequency_unit: Annotated[str, unit_of_file("frequency")] | None = None
    """Unit of frequencies where the file does not name it."""
    modulus_unit: Annotated[str, unit_of_file("modulus")] | None = None
    """Unit of moduli where the file does not name it."""
    modulus: Literal["E", "G"] | None = None
    """Young's or shear moduli, where the file does not say."""
    columns: Columns | None = None
    """Columns of frequency, storage and loss modulus, where their titles do not tell."""
    sheet: Column | None = None
    """Sheet of an Excel file, where several hold numbers."""
    header: int | None = Field(default=None, ge=0, le=MOST_LINES)
    """Number of lines above the rows, where there are numbers among them."""
    temperature_unit: Annotated[str, unit_of_file("temperature")] | None = None
    """Unit of temperatures where the file does not name it."""
    temperature_step: TemperatureDifference | None = None
    """Of temperature ramps: moduli are interpolated at multiples of this."""
    reference_temperature: Temperature | None = None
    """Temperature the master curve holds for, or sweeps are shifted to."""
    shift: ShiftSource | None = None
    """Time-temperature shift, needed away from the reference temperature."""
    vertical: bool = False
    """Find a vertical shift of sweeps, too."""
    source: str = ""
    """Where the rubber comes from, carried into the results."""
    terms: int | None = Field(default=None, ge=1, le=200)
    """Number of Maxwell elements; chosen from the data by default."""
    outlier_threshold: float | None = Field(default=None, gt=0.0)
    """Times the typical scatter beyond which a measured row is left out of the fit."""
    bulk_modulus: Pressure | None = None
    """Bulk modulus, which a DMA measurement does not give."""
    extrapolate: Literal["say", "refuse"] = "say"
    """Waves beyond the measured frequencies: solved and said, or refused."""
    strain_energy: Annotated[
        InstanceOf[StrainEnergy], BeforeValidator(_strain_energy), Words(STRAIN_ENERGY)
    ] = NeoHookean()
    """Law of the permanent network at large strain."""

    @model_validator(mode="after")
    def _one_source(self) -> RubberSource:
        if (self.file is None) == (self.name is None):
            raise ValueError(
                f"expected either file (a master curve) or name ({', '.join(NAMED_RUBBERS)})"
            )
        foreign = self.model_fields_set - {
            "name",
            "bulk_modulus",
            "strain_energy",
            "extrapolate",
            "shift",
            "file",
        }
        if self.name is not None and foreign:
            raise ValueError(f"{min(foreign)} belongs to a measured file, not to a named rubber")
        if self.vertical and self.shift is not None:
            raise ValueError("expected either shift (given) or vertical (found from the sweeps)")
        return self

    @property
    def files(self) -> list[str]:
        """Names of the files it was measured in."""
        shift = [self.shift] if isinstance(self.shift, str) else []
        return [*filter(None, [self.file]), *shift]
