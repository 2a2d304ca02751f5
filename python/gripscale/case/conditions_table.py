"""The table [conditions] of a case: what changes the rubber beside the load, each effect by name.

Pressures in Pa, speeds in m/s, temperatures in K, energies of the area term in eV once read.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, InstanceOf, model_validator

from gripscale.case.quantity import (
    BondEnergy,
    Conductivity,
    Density,
    MovingSpeed,
    SpecificHeat,
    Strain,
    Stress,
    Temperature,
)
from gripscale.case.table import Table, by_kind
from gripscale.interface.area_term import InterfacialShearStress, shear_stress_from_dict
from gripscale.rubber.softening import Kraus

NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Share = Annotated[float, Field(gt=0.0, le=1.0)]


class SofteningSource(Table):
    """A law of softening, or where one was measured."""

    kind: str


class KrausTable(SofteningSource):
    """Kraus' law with its parameters."""

    kind: Literal["kraus"]
    storage_ratio: Share
    loss_ratio: Share
    critical_strain: Strain
    measured_at: Strain
    deformation: Literal["tension", "shear"]
    exponent: Positive = 0.5

    def law(self) -> Kraus:
        """Return the law of softening."""
        return Kraus(**self.model_dump(exclude={"kind"}))


class StrainSweeps(SofteningSource):
    """Measured strain sweeps, with what their files do not state."""

    kind: Literal["table"]
    files: list[str] = Field(min_length=1, description="files of strain sweeps")
    measured_at: Strain = Field(
        description='the strain of the DMA measurement, such as "0.1 %", where nothing is softened'
    )
    amplitude: Literal["single", "peak-to-peak"] | None = None
    strain_unit: Literal["1", "%"] | None = None
    modulus_unit: str | None = None
    modulus: Literal["E", "G"] | None = None
    temperature_unit: Literal["K", "C", "F"] | None = None


SOFTENING: dict[str, type[Table]] = {"kraus": KrausTable, "table": StrainSweeps}


class Heat(Table):
    """What the rubber does with the heat of its own friction."""

    conductivity: Conductivity = Field(description='such as "0.25 W/(m K)"')
    density: Density = Field(description='such as "1150 kg/m^3"')
    specific_heat: SpecificHeat = Field(description='such as "1500 J/(kg K)"')


class ShearStress(Table):
    """A law of the interfacial shear stress."""

    kind: str

    def law(self) -> InterfacialShearStress:
        """Return the law; raise `InputError` if its numbers do not fit together."""
        return shear_stress_from_dict(self.model_dump(exclude_none=True))


class Constant(ShearStress):
    """The same at every speed and temperature."""

    kind: Literal["constant"]
    stress_0: Stress


class Gaussian(ShearStress):
    """A bell in the logarithm of the speed."""

    kind: Literal["gaussian"]
    stress_0: Stress
    width: Positive
    speed_0: MovingSpeed
    activation_energy: BondEnergy = 0.0
    reference_temperature: Temperature | None = None

    @model_validator(mode="after")
    def _both_or_none(self) -> Gaussian:
        if (self.activation_energy > 0.0) != (self.reference_temperature is not None):
            raise ValueError("expected activation_energy and reference_temperature together")
        return self


class LeGalKlueppel(ShearStress):
    """Le Gal and Klueppel's."""

    kind: Literal["le_gal_klueppel"]
    stress_0: Stress
    ratio: NotNegative
    critical_speed: MovingSpeed
    exponent: Positive


class StressTable(ShearStress):
    """Measured at some speeds."""

    kind: Literal["table"]
    speed: list[MovingSpeed] = Field(min_length=2)
    stress_at: list[Stress] = Field(min_length=2)


SHEAR_STRESS: dict[str, type[Table]] = {
    "constant": Constant,
    "gaussian": Gaussian,
    "le_gal_klueppel": LeGalKlueppel,
    "table": StressTable,
}


class ConditionsTable(Table):
    """Effects beside the rubber as measured, each off unless asked for."""

    temperature: Temperature | None = None
    softening: Annotated[InstanceOf[SofteningSource], by_kind(SOFTENING)] | None = None
    strain_norm: Literal["slope", "stretch"] | None = None
    heat: Heat | None = None
    shear_stress: Annotated[InstanceOf[ShearStress], by_kind(SHEAR_STRESS)] | None = None

    @model_validator(mode="after")
    def _norm_of_softening(self) -> ConditionsTable:
        if self.strain_norm is not None and self.softening is None:
            raise ValueError("strain_norm belongs to softening, which is not asked for")
        return self

    @property
    def files(self) -> list[str]:
        """Names of the files it was measured in."""
        return list(self.softening.files) if isinstance(self.softening, StrainSweeps) else []
