"""[rubber] and [conditions] of a case: a measured or named rubber, and what changes it on the way.

Once read, pressures are in Pa, temperatures in K and energies of the area term in eV. Laws are
those of the package: their fields say which keys a case states them with.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from gripscale.case_file import schema
from gripscale.conditions.area_term import SHEAR_STRESSES
from gripscale.conditions.conditions import OFF, Interface, water_film
from gripscale.conditions.flash_temperature import ThermalProperties
from gripscale.io.text_table import MOST_LINES
from gripscale.rubber.shift import SHIFTS, ShiftTable
from gripscale.rubber.softening import Kraus, SofteningTable, TypicalTread, softening_of_sweeps
from gripscale.rubber.strain_energy import STRAIN_ENERGIES, NeoHookean
from gripscale.rubber.strain_sweeps import read_strain_sweeps

NAMED_RUBBERS = ("styrene_butadiene",)
# Shifts a case states with their numbers; a table of factors is a file.
SHIFT_LAWS = {kind: law for kind, law in SHIFTS.items() if law is not ShiftTable}
# Keys of [rubber] that a named rubber may have.
OF_ANY_RUBBER = {
    *("file", "name", "assumed", "bulk_modulus", "strain_energy", "extrapolate"),
    *("shift", "thickness", "filled"),
}

_FILES = "the name of a file, or a list of names"


def _files(value: Any) -> Any:
    names = value if isinstance(value, list) else [value]
    if value is not None and not (names and all(isinstance(name, str) for name in names)):
        raise ValueError(f"expected {_FILES}")
    return value


class LayoutKeys(schema.CaseTable):
    """Where the numbers of a measured file stand and what they are, as `FileLayout` takes them."""

    columns: schema.Columns | None = None
    """Columns of frequency, storage and loss modulus, where their titles do not tell."""
    sheet: schema.ColumnKey | None = None
    """Sheet of an Excel file, where several hold numbers."""
    header: int | None = Field(default=None, ge=0, le=MOST_LINES)
    """Number of lines above the rows, where there are numbers among them."""
    frequency_unit: Annotated[str, schema.unit_of_file("frequency")] | None = None
    """Unit of frequencies where the file does not name it."""
    modulus_unit: Annotated[str, schema.unit_of_file("modulus")] | None = None
    """Unit of moduli where the file does not name it."""
    modulus: Literal["E", "G"] | None = None
    """Young's or shear moduli, where the file does not say."""
    temperature_unit: Annotated[str, schema.unit_of_file("temperature")] | None = None
    """Unit of temperatures where the file does not name it."""
    frequency: schema.Frequency | None = None
    """Frequency of all rows, as of a temperature ramp, where no column of the file holds it."""

    def layout(self) -> dict[str, Any]:
        """Return what is stated as keyword arguments of a reader."""
        return {name: getattr(self, name) for name in LayoutKeys.model_fields}


class RubberSource(LayoutKeys):
    """Measured moduli, with what their file does not state, or a rubber known by name.

    The file is a master curve, or sweeps at several temperatures to make one of.
    """

    file: Annotated[str | list[str] | None, schema.Reading(_FILES, _files)] = None
    """A measured master curve, or sweeps at several temperatures, in one file or several."""
    name: Literal["styrene_butadiene"] | None = None
    """A rubber known by name, in place of a file."""
    temperature_step: schema.TemperatureDifference | None = None
    """Of temperature ramps: moduli are interpolated at multiples of this."""
    reference_temperature: schema.Temperature | None = None
    """Temperature the master curve holds for, or sweeps are shifted to."""
    shift: Annotated[Any, schema.stated_law(SHIFT_LAWS, or_file=True)] = None
    """Time-temperature shift, needed away from the reference temperature."""
    vertical: bool = False
    """Find a vertical shift of sweeps, too."""
    source: str = ""
    """Where the rubber comes from, carried into the results."""
    assumed: list[str] | None = None
    """What `gripscale new` proposed because no file states it, each a doubt of the answer."""
    terms: int | None = Field(default=None, ge=1, le=200)
    """Number of Maxwell elements; chosen from the data by default."""
    outlier_threshold: float | None = Field(default=None, gt=0.0)
    """Times the typical scatter beyond which a measured row is left out of the fit."""
    bulk_modulus: schema.Pressure | None = None
    """Bulk modulus, which a DMA measurement does not give."""
    filled: bool | None = None
    """Whether the rubber is filled (carbon black, silica), as of every tread; without a word the
    answer has both numbers. Filled rubber with no softening of its own is a typical tread."""
    thickness: schema.Length | None = None
    """Thickness of the rubber on a rigid base; without it the rubber has no end."""
    extrapolate: Literal["warn", "refuse"] = "warn"
    """Waves beyond the measured frequencies: solved with a warning, or refused."""
    strain_energy: Annotated[Any, schema.stated_law(STRAIN_ENERGIES)] = NeoHookean()
    """Law of the permanent network at large strain."""

    @model_validator(mode="after")
    def _one_source(self) -> RubberSource:
        if (self.file is None) == (self.name is None):
            raise ValueError(
                f"expected either file (a master curve) or name ({', '.join(NAMED_RUBBERS)})"
            )
        foreign = self.model_fields_set - OF_ANY_RUBBER
        if self.name is not None and foreign:
            raise ValueError(f"{min(foreign)} belongs to a measured file, not to a named rubber")
        if self.vertical and self.shift is not None:
            raise ValueError("expected either shift (given) or vertical (found from the sweeps)")
        return self

    @property
    def measured_files(self) -> list[str]:
        """Names of the files with its moduli."""
        return [self.file] if isinstance(self.file, str) else self.file or []


class StrainSweeps(LayoutKeys):
    """Measured strain sweeps, with what their files do not state."""

    kind: Literal["table"]
    """Measured strain sweeps."""
    files: list[str] = Field(min_length=1)
    """Files of strain sweeps."""
    measured_at: schema.Strain | None = None
    """Strain of the DMA measurement, where nothing is softened; 0.1 % by default."""
    deformation: Literal["tension", "shear"] | None = None
    """What the strain is, where its title does not say; half-way between by default."""
    amplitude: Literal["single", "peak-to-peak"] | None = None
    """What the strain column holds, where its title does not say."""
    strain_unit: Annotated[str, schema.unit_of_file("strain")] | None = None
    """Unit of strains where the file does not name it."""

    def softening(self, resolve: Callable[[str], Path] = Path) -> SofteningTable:
        """Return the law of the sweeps; `resolve` turns the name of a file into its path."""
        options = self.model_dump(exclude={"kind", "files", "measured_at"})
        sweeps = read_strain_sweeps([resolve(name) for name in self.files], **options)
        return softening_of_sweeps(sweeps, measured_at=self.measured_at)


# How a case states softening: a law with its numbers, or where one was measured.
SOFTENING: dict[str, type] = {
    "kraus": Kraus,
    "table": StrainSweeps,
    TypicalTread.kind: TypicalTread,
}


class ConditionsTable(schema.CaseTable):
    """Effects beside the rubber as measured."""

    temperature: schema.Temperature | None = None
    """Temperature of the rubber before the contact; that of the master curve by default."""
    softening: Annotated[Any, schema.stated_law(SOFTENING, off=OFF)] = None
    """Softening by strain; that of a typical tread for filled rubber by default, or "none"."""
    strain_norm: Literal["slope", "stretch"] | None = None
    """Of a wave: by the rms slope in its contact (the default), or the largest stretch less one."""
    heat: Annotated[Any, schema.stated_law(ThermalProperties, off=OFF)] = None
    """The rubber warms by its own friction, with typical constants by default where it has a
    temperature shift, or "none"."""
    counterface: Annotated[Any, schema.stated_law(ThermalProperties)] = None
    """What takes up heat through the contact; stone by default, of a floor concrete and of a
    counterface steel."""
    interface: Interface | None = None
    """A dry interface: the real contact area is sheared at the stress of typical treads, unless
    shear_stress states another. Without it the friction is that of the hysteresis alone."""
    shear_stress: Annotated[Any, schema.stated_law(SHEAR_STRESSES)] = None
    """The area term: the real contact area sheared at this stress."""
    water: Annotated[Any, schema.Reading('"flooded" or a length', water_film)] = None
    """Water on a measured map that contact can trap: flooded, or a film of this thickness."""
