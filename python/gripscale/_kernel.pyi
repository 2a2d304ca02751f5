from typing import TypedDict, final, type_check_only

import numpy as np
from numpy.typing import NDArray

__all__ = ["Solution", "run_stages", "solve_scale"]

@final
class Solution:
    @property
    def status(self) -> str: ...
    @property
    def residual(self) -> float: ...
    @property
    def newton_iterations(self) -> int: ...
    @property
    def load_steps(self) -> int: ...
    @property
    def load_reached(self) -> float: ...
    @property
    def approach(self) -> float: ...
    @property
    def contact_fraction(self) -> float: ...
    @property
    def contacts(self) -> list[tuple[float, float]]: ...
    @property
    def friction(self) -> float: ...
    @property
    def friction_from_dissipation(self) -> float: ...
    @property
    def contact_fraction_error(self) -> float: ...
    @property
    def friction_error(self) -> float: ...
    @property
    def columns(self) -> int: ...
    @property
    def rows(self) -> int: ...
    @property
    def min_stretch(self) -> float: ...
    @property
    def max_stretch(self) -> float: ...
    @property
    def x(self) -> NDArray[np.float64]: ...
    @property
    def pressure(self) -> NDArray[np.float64]: ...
    @property
    def mesh_x(self) -> NDArray[np.float64]: ...
    @property
    def mesh_z(self) -> NDArray[np.float64]: ...

@type_check_only
class Inputs(TypedDict):
    strain_energy: tuple[str, float, float]
    equilibrium_modulus: float
    moduli: list[float]
    relaxation_times: list[float]
    bulk_modulus: float
    wavelength: float
    amplitude: float
    pressure: float
    speed: float
    load_time: float
    depth: float
    columns: int
    rows: int
    order: int
    tolerance: float | None
    iterations: int
    budget: int
    residual_tolerance: float
    step: float

def solve_scale(inputs: Inputs, start: Solution | None) -> Solution: ...
def run_stages(
    inputs: Inputs, stages: list[tuple[float, float, float]], start: Solution | None
) -> tuple[str, int, NDArray[np.float64]]: ...
