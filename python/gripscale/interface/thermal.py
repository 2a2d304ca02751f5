"""What a rubber does with heat: conductivity, density, specific heat."""

from __future__ import annotations

from dataclasses import dataclass

from gripscale import checks


@dataclass(frozen=True)
class ThermalProperties:
    """Thermal properties of a rubber; there are no defaults, they are measured or looked up.

    Parameters
    ----------
    conductivity : float
        Thermal conductivity [W/(m K)], above zero.
    density : float
        [kg/m^3], above zero.
    specific_heat : float
        [J/(kg K)], above zero.

    Raises
    ------
    InputError
        If a value is no finite number above zero.
    """

    conductivity: float
    density: float
    specific_heat: float

    def __post_init__(self) -> None:
        units = {"conductivity": "W/(m K)", "density": "kg/m^3", "specific_heat": "J/(kg K)"}
        for name, unit in units.items():
            object.__setattr__(self, name, checks.positive(name, getattr(self, name), unit=unit))

    @property
    def diffusivity(self) -> float:
        """D = conductivity / (density x specific heat) [m^2/s]."""
        return self.conductivity / (self.density * self.specific_heat)
