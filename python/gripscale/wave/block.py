"""The finite-strain block: a rubber block pressed on, and slid over, one rigid sine wave."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from gripscale.core import checks
from gripscale.rubber import Rubber
from gripscale.rubber.material import require_load_bearing
from gripscale.wave import kernel
from gripscale.wave.kernel import face_of
from gripscale.wave.problem import Load, Mesh, Sine, Status, WaveProblem
from gripscale.wave.result import WaveResult

SOLVED = (
    Status.CONVERGED,
    Status.TOLERANCE_NOT_MET,
    Status.FRICTIONS_DISAGREE,
    Status.CONTACT_TOO_NARROW,
)
"""Endings at the whole pressure."""


@dataclass(frozen=True)
class FiniteStrainBlock:
    """Solver of one wave at finite strain.

    Parameters
    ----------
    mesh : Mesh
        The mesh, or with a tolerance the one whose proportions are kept. Its columns are doubled,
        to 256 at most, as long as the two frictions differ by more than the `friction_bound` of
        the result, or contacts of fewer than 4 nodes carry half of the load.
    tolerance : float, optional
        Largest estimated discretisation error, absolute in contact fraction and relative in
        friction (to 0.04 of the slope 2 pi amplitude/wavelength where friction is less). The mesh
        is refined until it is met, from coarser than `mesh` to 2048 columns.
    settings : mapping
        What differs from `gripscale.wave.default_settings()`.
    time_limit : float, optional
        Seconds after which the solution ends early, as `time limit`: with the finest mesh that was
        solved, or where there is none with the pressure reached. None: as long as it takes.

    Raises
    ------
    InputError
        If tolerance or time limit is not above zero, or a setting is unknown or no number above
        zero.
    """

    name: ClassVar[str] = "finite_strain"

    mesh: Mesh = field(default_factory=Mesh)
    tolerance: float | None = None
    settings: Mapping[str, float] = field(default_factory=dict)
    time_limit: float | None = None

    def __post_init__(self) -> None:
        checks.instance("mesh", self.mesh, Mesh)
        if self.tolerance is not None:
            object.__setattr__(self, "tolerance", checks.positive("tolerance", self.tolerance))
        if self.time_limit is not None:
            limit = checks.positive("time_limit", self.time_limit, unit="s")
            object.__setattr__(self, "time_limit", limit)
        object.__setattr__(self, "settings", kernel.checked_settings(self.settings))

    @classmethod
    def of(
        cls,
        *,
        tolerance: float | None = None,
        time_limit: float | None = None,
        max_iterations: int | None = None,
        residual_tolerance: float | None = None,
        **mesh: Any,
    ) -> FiniteStrainBlock:
        """Return the block of the keyword arguments of `solve_scale`; others are refused."""
        checks.allowed_names("option", mesh, Mesh.__dataclass_fields__)
        stated = {"max_iterations": max_iterations, "residual_tolerance": residual_tolerance}
        settings = {name: value for name, value in stated.items() if value is not None}
        return cls(Mesh(**mesh), tolerance, settings, time_limit)

    def coarser(self) -> FiniteStrainBlock:
        """Return the block on half the columns and two thirds of the rows, a sixth of the work."""
        mesh = self.mesh
        columns, rows = max(mesh.columns // 2, 4), max(2 * mesh.rows // 3, 2)
        return replace(self, mesh=replace(mesh, columns=columns, rows=rows), tolerance=None)

    def solve(
        self,
        problem: WaveProblem,
        start: WaveResult | None = None,
        *,
        workers: int | None = None,
    ) -> WaveResult:
        """Return contact and friction of `problem`.

        `start` may be of another rubber, wave or load: it is only a first guess. `workers` is that
        of `gripscale.solve_scale`.

        Raises `InputError` if `start` is of another solver or was read from a file, or `workers`
        is not a whole number from 1 to 1024.
        """
        first = None if start is None else kernel.solution_of(start)
        solution = kernel.solve_steady(
            problem, self.mesh, self.settings, self.tolerance, first, self.time_limit, workers
        )
        return _result(problem, self.mesh, solution)


@face_of(FiniteStrainBlock)
def solve_scale(
    rubber: Rubber,
    *,
    wavelength: float,
    amplitude: float,
    pressure: float,
    speed: float,
    load_time: float = math.inf,
    depth: float = Mesh.depth,
    columns: int = Mesh.columns,
    rows: int = Mesh.rows,
    element_order: int = Mesh.element_order,
    tolerance: float | None = None,
    time_limit: float | None = None,
    workers: int | None = None,
    start: WaveResult | None = None,
    max_iterations: int | None = None,
    residual_tolerance: float | None = None,
) -> WaveResult:
    """Press a rubber block on one rigid sine wave, slide it, and find contact and friction.

    The block is one wavelength wide and periodic, in plane strain at finite deformation: the
    rubber's permanent network plus one temporary network per Maxwell element (Lubliner, Mech. Res.
    Commun. 12 (1985) 93), frictionless unilateral contact with z = amplitude cos(2 pi x /
    wavelength). The steady state is found in one non-linear solve in the frame of the wave
    (Wriggers & Reinelt, Comput. Methods Appl. Mech. Engrg. 198 (2009) 1996, treat it in time).

    Parameters
    ----------
    rubber : Rubber
        The viscoelastic solid.
    wavelength, amplitude : float
        Wavelength and half peak-to-valley height of the wave [m].
    pressure : float
        Mean pressure on the lid [Pa].
    speed : float
        Sliding speed [m/s]; 0 is static contact of the fully relaxed rubber.
    load_time : float
        Time the mean deformation has had to relax [s]; infinity by default.
    depth : float
        Height of the block in wavelengths.
    columns : int
        Elements along the block.
    rows : int
        Elements across the block.
    element_order : int
        1: bilinear with one pressure; 2: biquadratic with linear discontinuous pressure.
    tolerance : float, optional
        Largest estimated discretisation error, absolute in contact fraction and relative in
        friction (to 0.04 of the slope 2 pi amplitude/wavelength where friction is less). The mesh
        is refined until it is met, from coarser than `columns` x `rows` to 2048 columns; without it
        the mesh is the one given, refined only where its two frictions differ by more than the
        `friction_bound` of the result or fewer than 4 nodes touch.
    time_limit : float, optional
        Seconds after which the solution ends early, as `time limit`: with the finest mesh that was
        solved, or where there is none with the pressure reached. None: as long as it takes.
    workers : int, optional
        Threads that share the work of a large mesh, of which none changes a bit of the result; one
        per core by default, and one where gripscale solves several waves side by side.
    start : WaveResult, optional
        A result of another wave, pressure, speed or rubber to start from (a warm start).
    max_iterations : int, optional
        Newton iterations allowed in one load step.
    residual_tolerance : float, optional
        Largest residual force over the applied force, and gap over the amplitude [-].

    Returns
    -------
    WaveResult
        Its `status` is `converged`, or says why the numbers are not to be trusted.

    Raises
    ------
    InputError
        If a value is not a number or out of its range.
    """
    problem = WaveProblem(rubber, Sine(wavelength, amplitude), Load(pressure, speed, load_time))
    if problem.load.speed == 0.0:
        require_load_bearing(rubber, problem.load.pressure, math.inf)
    block = FiniteStrainBlock.of(
        columns=columns,
        rows=rows,
        depth=depth,
        element_order=element_order,
        tolerance=tolerance,
        time_limit=time_limit,
        max_iterations=max_iterations,
        residual_tolerance=residual_tolerance,
    )
    return block.solve(problem, start, workers=workers)


def _result(problem: WaveProblem, mesh: Mesh, solution: kernel.Solution) -> WaveResult:
    profile, load = problem.profile, problem.load
    return WaveResult(
        wavelength=profile.wavelength,
        amplitude=profile.amplitude,
        pressure_received=load.pressure,
        speed=load.speed,
        load_time=load.load_time,
        contact_fraction=solution.contact_fraction,
        friction=solution.friction,
        friction_from_dissipation=solution.friction_from_dissipation,
        status=Status(solution.status),
        newton_iterations=solution.newton_iterations,
        residual=solution.residual,
        min_stretch=solution.min_stretch,
        max_stretch=solution.max_stretch,
        x=solution.x * profile.wavelength,
        pressure=solution.pressure,
        rubber=problem.rubber,
        model=FiniteStrainBlock.name,
        deformed_mesh=(
            solution.mesh_x * profile.wavelength,
            solution.mesh_z * profile.wavelength,
        ),
        details=_no_estimate(solution)
        | {
            "contact_edges": [
                (start * profile.wavelength, end * profile.wavelength)
                for start, end in solution.contacts
            ],
            "load_steps": solution.load_steps,
            "load_reached": solution.load_reached,
            "indentation": solution.approach * profile.wavelength,
            "columns": solution.columns,
            "coarser_columns": solution.judged_by or 0,
            "rows": solution.rows,
            "depth": mesh.depth,
            "element_order": mesh.element_order,
            **_widths(profile.wavelength, solution.too_narrow),
            **_carried(profile.wavelength, solution.waves_carried),
        },
        contact_fraction_error=solution.contact_fraction_error,
        friction_error=solution.friction_error,
        friction_bound=math.nan if solution.friction_bound is None else solution.friction_bound,
        loss_by_depth=(
            profile.wavelength * np.append(0.0, np.cumsum(solution.row_heights)),
            solution.lost_by_row,
        ),
        solution=solution,
    )


def _widths(wavelength: float, too_narrow: tuple[float, float] | None) -> dict[str, float]:
    """Return contact widths [m], expected and smallest, where there was nothing to solve."""
    if too_narrow is None:
        return {}
    expected, smallest = too_narrow
    return {
        "expected_contact_width": expected * wavelength,
        "smallest_contact_width": smallest * wavelength,
    }


def _carried(period: float, waves: int | None) -> dict[str, float]:
    """Return the smallest wave [m] with which a profile that is too rough carried the load."""
    return {"smallest_wave_carried": period / waves} if waves else {}


def _no_estimate(solution: kernel.Solution) -> dict[str, Any]:
    """Return why there is no estimate of the errors, as a detail, where there is none."""
    if solution.judged_by is not None:
        return {}
    if not math.isfinite(solution.friction):
        why = "nothing was solved"
    elif solution.status not in SOLVED:
        why = f"the solution ended early, {solution.status}"
    else:
        why = f"no coarser mesh than {solution.columns} columns was solved"
    return {"no_error_estimate": why}
