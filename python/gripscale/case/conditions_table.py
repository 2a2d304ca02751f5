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
    modulus_unit: str | None = None
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
