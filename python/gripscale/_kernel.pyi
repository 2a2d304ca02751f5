from collections.abc import Callable, Mapping
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "GapExtension",
    "Line",
    "Map",
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
class GapExtension:
    @staticmethod
    def of_line(active: NDArray[np.bool_], reach: float | None) -> GapExtension: ...
    @staticmethod
    def of_map(active: NDArray[np.bool_], far: float) -> GapExtension: ...
    def extend(self, values: NDArray[np.float32]) -> None: ...

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
        extension: GapExtension,
        numbers: tuple[float, float, int],
    ) -> tuple[NDArray[np.float32], float, int]: ...

@final
class Map:
    def __new__(cls, rows: int, columns: int, threads: int, look: Callable[[], None]) -> Map: ...
    def filtered(
        self, values: NDArray[np.float32], factors: NDArray[np.complex64]
    ) -> NDArray[np.float32]: ...
    def close_gap(
        self,
        right: NDArray[np.float32],
        places: NDArray[np.int64],
        filters: list[NDArray[np.complex64]],
        extension: GapExtension,
        numbers: tuple[float, float, int],
    ) -> tuple[NDArray[np.float32], float, int]: ...

@final
class Solution:
    status: str
    residual: float
    newton_iterations: int
    jacobian_products: int
    load_steps: int
    load_reached: float
    approach: float
    contact_fraction: float
    contacts: list[tuple[float, float]]
    friction: float
    friction_from_dissipation: float
    lost_by_row: NDArray[np.float64]
    row_heights: NDArray[np.float64]
    contact_fraction_error: float
    friction_error: float
    friction_bound: float | None
    judged_by: int | None
    columns: int
    rows: int
    too_narrow: tuple[float, float] | None
    waves_carried: int | None
    min_stretch: float
    max_stretch: float
    x: NDArray[np.float64]
    pressure: NDArray[np.float64]
    mesh_x: NDArray[np.float64]
    mesh_z: NDArray[np.float64]

@final
class Run:
    status: str
    newton_iterations: int
    time: NDArray[np.float64]
    distance: NDArray[np.float64]
    speed: NDArray[np.float64]
    pressure: NDArray[np.float64]
    friction: NDArray[np.float64]
    contact_fraction: NDArray[np.float64]
    approach: NDArray[np.float64]

def solve_steady(
    problem: Mapping[str, Any],
    settings: Mapping[str, float],
    tolerance: float | None,
    start: Solution | None,
    work: Mapping[str, Any],
) -> Solution: ...
def solve_transient(
    problem: Mapping[str, Any],
    settings: Mapping[str, float],
    stages: list[tuple[float, float, float]],
    start: Solution | None,
    work: Mapping[str, Any],
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
