from collections.abc import Callable, Mapping
from typing import Literal, TypedDict, final, type_check_only

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Line",
    "Run",
    "Solution",
    "default_settings",
    "gmres",
    "relaxing_moduli",
    "solve_steady",
    "solve_transient",
    "statuses",
    "strain_energies",
]

@final
class Line:
    def __new__(cls, points: int) -> Line: ...
    def filtered(
        self, values: NDArray[np.float32], factors: NDArray[np.complex64]
    ) -> NDArray[np.float32]: ...
    def close_gap(
        self,
        right: NDArray[np.float32],
        places: NDArray[np.int64],
        filters: list[NDArray[np.complex64]],
        extension: tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float32]],
        numbers: tuple[float, float, int],
    ) -> tuple[NDArray[np.float32], float, int]: ...

@final
class Solution:
    @property
    def status(self) -> str: ...
    @property
    def residual(self) -> float: ...
    @property
    def newton_iterations(self) -> int: ...
    @property
    def jacobian_products(self) -> int: ...
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
    def lost_by_row(self) -> NDArray[np.float64]: ...
    @property
    def row_heights(self) -> NDArray[np.float64]: ...
    @property
    def contact_fraction_error(self) -> float: ...
    @property
    def friction_error(self) -> float: ...
    @property
    def friction_bound(self) -> float | None: ...
    @property
    def judged_by(self) -> int | None: ...
    @property
    def columns(self) -> int: ...
    @property
    def rows(self) -> int: ...
    @property
    def too_narrow(self) -> tuple[float, float] | None: ...
    @property
    def waves_carried(self) -> int | None: ...
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

@final
class Run:
    @property
    def status(self) -> str: ...
    @property
    def newton_iterations(self) -> int: ...
    @property
    def time(self) -> NDArray[np.float64]: ...
    @property
    def distance(self) -> NDArray[np.float64]: ...
    @property
    def speed(self) -> NDArray[np.float64]: ...
    @property
    def pressure(self) -> NDArray[np.float64]: ...
    @property
    def friction(self) -> NDArray[np.float64]: ...
    @property
    def contact_fraction(self) -> NDArray[np.float64]: ...
    @property
    def approach(self) -> NDArray[np.float64]: ...

@type_check_only
class Rubber(TypedDict):
    equilibrium_modulus: float
    moduli: list[float]
    relaxation_times: list[float]
    bulk_modulus: float
    strain_energy: tuple[str, dict[str, float]]

@type_check_only
class Sine(TypedDict):
    kind: Literal["sine"]
    wavelength: float
    amplitude: float

@type_check_only
class Sampled(TypedDict):
    kind: Literal["sampled"]
    wavelength: float
    heights: list[float]

@type_check_only
class Load(TypedDict):
    pressure: float
    speed: float
    load_time: float

@type_check_only
class Mesh(TypedDict):
    columns: int
    rows: int
    depth: float
    element_order: int

@type_check_only
class Body(TypedDict):
    rubber: Rubber
    profile: Sine | Sampled
    mesh: Mesh

@type_check_only
class Problem(Body):
    load: Load

@type_check_only
class Work(TypedDict):
    workers: int
    time_limit: float | None
    look: Callable[[], object]

def solve_steady(
    problem: Problem,
    settings: Mapping[str, float],
    tolerance: float | None,
    start: Solution | None,
    work: Work,
) -> Solution: ...
def solve_transient(
    problem: Body,
    settings: Mapping[str, float],
    stages: list[tuple[float, float, float]],
    start: Solution | None,
    work: Work,
) -> Run: ...
def default_settings() -> list[tuple[str, float, str]]: ...
def statuses() -> list[tuple[str, str, str]]: ...
def strain_energies() -> dict[str, list[str]]: ...
def relaxing_moduli(
    omega: NDArray[np.float64], moduli: NDArray[np.float64], times: NDArray[np.float64]
) -> NDArray[np.complex128]: ...
def gmres(
    operator: Callable[[NDArray[np.float32]], NDArray[np.float32]],
    right: NDArray[np.float32],
    target: float,
    most: int,
) -> tuple[NDArray[np.float32], float, int]: ...
