"""One scale: a rubber block pressed on, and slid over, one rigid sine wave."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from gripscale import _kernel, checks
from gripscale.errors import InputError

if TYPE_CHECKING:
    from gripscale.rubber import Rubber

DEFAULT_COLUMNS = 128
DEFAULT_ROWS = 20

LARGEST_STEP = 0.4
"""Largest change of the displacement gradient in one Newton iteration [-]."""

ITERATION_BUDGET = 500
"""Newton iterations allowed in one march of the pressure."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ScaleResult:
    """Contact and friction of one wave, with the evidence for them.

    All lengths in m, pressures in Pa, speeds in m/s, angular frequencies in rad/s.
    """

    wavelength: float
    amplitude: float
    pressure_received: float
    """Mean pressure this wave was given [Pa]."""
    speed: float
    load_time: float
    contact_fraction: float
    """Contact length projected on the mean plane over the wavelength [-]."""
    friction: float
    """Friction coefficient from the contact traction [-]."""
    friction_from_dissipation: float
    """Friction coefficient from the energy lost in the rubber per sliding distance [-]."""
    status: str
    """`converged`, or why the solution is not to be trusted."""
    newton_iterations: int
    residual: float
    """Residual force relative to the applied force [-]."""
    min_stretch: float
    max_stretch: float
    x: Array = field(repr=False)
    """Deformed abscissa of the surface nodes in the frame of the wave (crest at 0) [m]."""
    pressure: Array = field(repr=False)
    """Contact pressure at `x` [Pa], zero out of contact."""
    model: str = "finite_strain"
    """`finite_strain` (the FE block) or `half_plane` (small-strain reference)."""
    deformed_mesh: tuple[Array, Array] | None = field(default=None, repr=False)
    """Deformed node positions (x, z) [m], each (layers, columns + 1), or None."""
    details: dict[str, Any] = field(default_factory=dict, repr=False)
    """Further counts of the solver (load steps, mesh, indentation ...)."""
    contact_fraction_error: float = math.nan
    """Estimated discretisation error of the contact fraction [-], NaN if unknown."""
    friction_error: float = math.nan
    """Estimated discretisation error of the friction coefficient [-], NaN if unknown."""
    solution: _kernel.Solution | None = field(default=None, repr=False, compare=False)
    """The kernel's solution, from which another wave can start."""

    def __getstate__(self) -> dict[str, Any]:
        """Leave the kernel's solution behind when a result is pickled."""
        return {**self.__dict__, "solution": None}

    @property
    def contact_length(self) -> float:
        """Contact length projected on the mean plane [m]."""
        return self.contact_fraction * self.wavelength

    @property
    def converged(self) -> bool:
        """Whether the solution may be used."""
        return self.status == "converged"

    @property
    def friction_mismatch(self) -> float:
        """Relative difference of the two friction measures: the discretisation's own error."""
        scale = max(abs(self.friction), abs(self.friction_from_dissipation))
        difference = abs(self.friction - self.friction_from_dissipation)
        return difference / scale if scale > 0.0 else 0.0


def solve_scale(
    rubber: Rubber,
    *,
    wavelength: float,
    amplitude: float,
    pressure: float,
    speed: float,
    load_time: float = math.inf,
    depth: float = 1.5,
    columns: int = DEFAULT_COLUMNS,
    rows: int = DEFAULT_ROWS,
    element_order: int = 1,
    tolerance: float | None = None,
    start: ScaleResult | None = None,
    max_iterations: int = 40,
    residual_tolerance: float = 1e-8,
) -> ScaleResult:
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
        Elements along the block, an even number.
    rows : int
        Elements across the block.
    element_order : int
        1: bilinear with one pressure; 2: biquadratic with linear discontinuous pressure.
    tolerance : float, optional
        Largest estimated discretisation error, relative in friction and absolute in contact
        fraction. The mesh is refined until it is met, from coarser than `columns` x `rows` to
        512 columns; without it the mesh is the one given.
    start : ScaleResult, optional
        A result of another wave, pressure, speed or rubber to start from (a warm start).
    max_iterations : int
        Newton iterations allowed in one load step.
    residual_tolerance : float
        Largest residual force over the applied force, and gap over the amplitude [-].

    Returns
    -------
    ScaleResult
        Its `status` is `converged`, or says why the numbers are not to be trusted.

    Raises
    ------
    InputError
        If a value is not a number or out of its range.
    """
    inputs = kernel_inputs(
        rubber,
        wavelength=wavelength,
        amplitude=amplitude,
        pressure=pressure,
        speed=checks.not_negative("speed", speed, unit="m/s"),
        load_time=load_time,
        depth=depth,
        columns=columns,
        rows=rows,
        element_order=element_order,
        tolerance=tolerance,
        max_iterations=max_iterations,
        residual_tolerance=residual_tolerance,
    )
    try:
        solution = _kernel.solve_scale(inputs, start.solution if start is not None else None)
    except ValueError as error:
        raise InputError(str(error)) from error
    return _result(inputs, solution)


def kernel_inputs(
    rubber: Rubber,
    *,
    wavelength: float,
    amplitude: float,
    pressure: float,
    speed: float,
    load_time: float = math.inf,
    depth: float = 1.5,
    columns: int = DEFAULT_COLUMNS,
    rows: int = DEFAULT_ROWS,
    element_order: int = 1,
    tolerance: float | None = None,
    max_iterations: int = 40,
    residual_tolerance: float = 1e-8,
) -> _kernel.Inputs:
    """Check the arguments of `solve_scale` and put them as the kernel wants them.

    Raises
    ------
    InputError
        If a value is not a number or out of its range.
    """
    columns = checks.whole("columns", columns, least=4, most=1024)
    if columns % 2:
        raise InputError(f"columns must be even; got {columns}")
    return {
        "strain_energy": rubber.strain_energy.coefficients(),
        "equilibrium_modulus": rubber.equilibrium_modulus / 3.0,
        "moduli": (rubber.moduli / 3.0).tolist(),
        "relaxation_times": rubber.relaxation_times.tolist(),
        "bulk_modulus": rubber.bulk_modulus,
        "wavelength": checks.positive("wavelength", wavelength, unit="m"),
        "amplitude": checks.positive("amplitude", amplitude, unit="m"),
        "pressure": checks.positive("pressure", pressure, unit="Pa"),
        "speed": speed,
        "load_time": checks.not_negative("load_time", load_time, unit="s", infinite=True),
        "depth": checks.positive("depth", depth),
        "columns": columns,
        "rows": checks.whole("rows", rows, least=2, most=256),
        "order": checks.whole("element_order", element_order, least=1, most=2),
        "tolerance": None if tolerance is None else checks.positive("tolerance", tolerance),
        "iterations": checks.whole("max_iterations", max_iterations, least=1, most=1000),
        "budget": ITERATION_BUDGET,
        "residual_tolerance": checks.positive("residual_tolerance", residual_tolerance),
        "step": LARGEST_STEP,
    }


def _result(inputs: _kernel.Inputs, solution: _kernel.Solution) -> ScaleResult:
    wavelength = inputs["wavelength"]
    return ScaleResult(
        wavelength=wavelength,
        amplitude=inputs["amplitude"],
        pressure_received=inputs["pressure"],
        speed=inputs["speed"],
        load_time=inputs["load_time"],
        contact_fraction=solution.contact_fraction,
        friction=solution.friction,
        friction_from_dissipation=solution.friction_from_dissipation,
        status=_status(solution),
        newton_iterations=solution.newton_iterations,
        residual=solution.residual,
        min_stretch=solution.min_stretch,
        max_stretch=solution.max_stretch,
        x=solution.x * wavelength,
        pressure=solution.pressure,
        deformed_mesh=(solution.mesh_x * wavelength, solution.mesh_z * wavelength),
        details={
            "load_steps": solution.load_steps,
            "load_reached": solution.load_reached,
            "indentation": solution.approach * wavelength,
            "columns": solution.columns,
            "rows": solution.rows,
            "depth": inputs["depth"],
            "element_order": inputs["order"],
        },
        contact_fraction_error=solution.contact_fraction_error,
        friction_error=solution.friction_error,
        solution=solution,
    )


def _status(solution: _kernel.Solution) -> str:
    if solution.status == "converged":
        return "converged"
    return f"{solution.status} at {100.0 * solution.load_reached:.3g} % of the pressure"
