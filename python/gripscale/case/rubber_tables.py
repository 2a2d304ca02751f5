"""[rubber] of a case: measured moduli with what their file does not state, or a known rubber.

Pressures in Pa and temperatures in K once read.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, InstanceOf, model_validator

from gripscale.case.schema import (
    BondEnergy,
    Column,
    Columns,
    Conductivity,
    Density,
    MolarEnergy,
    MovingSpeed,
    Pressure,
    SpecificHeat,
    Strain,
    Stress,
    Table,
    Temperature,
    TemperatureDifference,
    Words,
    a_table,
    by_kind,
    unit_of_file,
)
from gripscale.conditions.area_term import InterfacialShearStress, shear_stress_from_dict
from gripscale.io.text_table import MOST_LINES
from gripscale.rubber.shift import Shift, shift_from_dict
from gripscale.rubber.softening import Kraus
from gripscale.rubber.strain_energy import NeoHookean, StrainEnergy, strain_energy_from_dict

# The time-temperature shift of a case: a table of factors in a file, or a law with its numbers.

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


# The table [conditions] of a case: what changes the rubber beside the load, each effect by name.
#
# Pressures in Pa, speeds in m/s, temperatures in K, energies of the area term in eV once read.

NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Share = Annotated[float, Field(gt=0.0, le=1.0)]


class SofteningSource(Table):
    """A law of softening, or where one was measured."""

    kind: str


class KrausTable(SofteningSource):
    """Kraus' law with its parameters."""

    kind: Literal["kraus"]
    """Kraus' law of the Payne effect."""
    storage_ratio: Share
    """Storage modulus at large strain over that at small."""
    loss_ratio: Share
    """Loss modulus at large strain over its maximum."""
    critical_strain: Strain
    """Strain at which half of the storage modulus that breaks is broken."""
    measured_at: Strain
    """Strain of the DMA measurement, where nothing is softened."""
    deformation: Literal["tension", "shear"]
    """Kind of both strains."""
    exponent: Positive = 0.5
    """Exponent m of the law."""

    def law(self) -> Kraus:
        """Return the law of softening."""
        return Kraus(**self.model_dump(exclude={"kind"}))


class StrainSweeps(SofteningSource):
    """Measured strain sweeps, with what their files do not state."""

    kind: Literal["table"]
    """Measured strain sweeps."""
    files: list[str] = Field(min_length=1)
    """Files of strain sweeps."""
    measured_at: Strain
    """Strain of the DMA measurement, where nothing is softened."""
    amplitude: Literal["single", "peak-to-peak"] | None = None
    """What the strain column holds, where its title does not say."""
    strain_unit: Literal["1", "%"] | None = None
    """Unit of strains where the file does not name it."""
    modulus_unit: Annotated[str, unit_of_file("modulus")] | None = None
    """Unit of moduli where the file does not name it."""
    modulus: Literal["E", "G"] | None = None
    """Young's or shear moduli, where the file does not say."""
    temperature_unit: Literal["K", "C", "F"] | None = None
    """Unit of temperatures where the file does not name it."""


SOFTENING: dict[str, type[Table]] = {"kraus": KrausTable, "table": StrainSweeps}


class Heat(Table):
    """What the rubber does with the heat of its own friction."""

    conductivity: Conductivity
    """Thermal conductivity of the rubber."""
    density: Density
    """Its density."""
    specific_heat: SpecificHeat
    """Its specific heat."""


class ShearStress(Table):
    """A law of the interfacial shear stress."""

    kind: str

    def law(self) -> InterfacialShearStress:
        """Return the law; raise `InputError` if its numbers do not fit together."""
        return shear_stress_from_dict(self.model_dump(exclude_none=True))


class Constant(ShearStress):
    """The same at every speed and temperature."""

    kind: Literal["constant"]
    """The same at every speed and temperature."""
    stress_0: Stress
    """Interfacial shear stress."""


class Gaussian(ShearStress):
    """A bell in the logarithm of the speed."""

    kind: Literal["gaussian"]
    """A bell in the logarithm of the speed."""
    stress_0: Stress
    """Largest interfacial shear stress."""
    width: Positive
    """Factor c of the squared decades of speed: the larger, the narrower the bell."""
    speed_0: MovingSpeed
    """Speed of the largest stress, at the reference temperature."""
    activation_energy: BondEnergy = 0.0
    """How that speed shifts with the temperature; 0: not at all."""
    reference_temperature: Temperature | None = None
    """Temperature speed_0 holds for; needed with an activation energy."""

    @model_validator(mode="after")
    def _both_or_none(self) -> Gaussian:
        if (self.activation_energy > 0.0) != (self.reference_temperature is not None):
            raise ValueError("expected activation_energy and reference_temperature together")
        return self


class LeGalKlueppel(ShearStress):
    """Le Gal and Klueppel's."""

    kind: Literal["le_gal_klueppel"]
    """Le Gal and Klueppel's rise from one plateau to another."""
    stress_0: Stress
    """Interfacial shear stress at slow sliding."""
    ratio: NotNegative
    """What the stress gains at high speed, over stress_0."""
    critical_speed: MovingSpeed
    """Speed at which half of that is gained."""
    exponent: Positive
    """How steeply it is gained."""


class StressTable(ShearStress):
    """Measured at some speeds."""

    kind: Literal["table"]
    """Measured at some speeds."""
    speed: list[MovingSpeed] = Field(min_length=2)
    """The speeds, rising."""
    stress_at: list[Stress] = Field(min_length=2)
    """Interfacial shear stress at each."""


SHEAR_STRESS: dict[str, type[Table]] = {
    "constant": Constant,
    "gaussian": Gaussian,
    "le_gal_klueppel": LeGalKlueppel,
    "table": StressTable,
}


class ConditionsTable(Table):
    """Effects beside the rubber as measured, each off unless asked for."""

    temperature: Temperature | None = None
    """Temperature of the rubber before the contact; that of the master curve by default."""
    softening: Annotated[InstanceOf[SofteningSource], by_kind(SOFTENING)] | None = None
    """Softening by strain."""
    strain_norm: Literal["slope", "stretch"] | None = None
    """Half the rms slope in the contact (the default), or the largest stretch less one."""
    heat: Heat | None = None
    """The rubber warms by its own friction."""
    shear_stress: Annotated[InstanceOf[ShearStress], by_kind(SHEAR_STRESS)] | None = None
    """The area term: the real contact area sheared at this stress."""

    @model_validator(mode="after")
    def _norm_of_softening(self) -> ConditionsTable:
        if self.strain_norm is not None and self.softening is None:
            raise ValueError("strain_norm belongs to softening, which is not asked for")
        return self

    @property
    def iterated(self) -> bool:
        """Whether the rubber depends on what is solved."""
        return self.softening is not None or self.heat is not None

    @property
    def files(self) -> list[str]:
        """Names of the files it was measured in."""
        return list(self.softening.files) if isinstance(self.softening, StrainSweeps) else []
