"""The finite-strain block: a rubber block pressed on, and slid over, one wave or profile.

A measured profile is made `gripscale.surface.low_pass.one_period` and pressed into one block, all
its waves in one solution: no separation of scales, no random phases, and no small strain.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np

from gripscale.core import Checked, InputError, Quantity, Status, checked, checks
from gripscale.rubber import Rubber
from gripscale.rubber.material import require_load_bearing
from gripscale.surface import Profile
from gripscale.surface.low_pass import low_pass, one_period
from gripscale.surface.profile import RESOLVED_STEPS
from gripscale.surface.resampling import fill_gaps
from gripscale.wave import kernel
from gripscale.wave.problem import Mesh, SampledProfile, Sine, WaveLoad, WaveProblem
from gripscale.wave.result import EQUILIBRIUM, ScaleResult

# Statuses of solutions that reached the whole pressure.
_SOLVED = (*EQUILIBRIUM, Status.CONTACT_TOO_NARROW)

# What a result has from the solution of the kernel as it is.
_NUMBERS = (
    *("contact_fraction", "contact_fraction_error", "friction", "friction_from_dissipation"),
    *("friction_error", "newton_iterations", "residual", "min_stretch", "max_stretch", "pressure"),
)


def _settings(name: str, value: Mapping[str, float]) -> Mapping[str, float]:
    """Return settings that differ from the defaults; the kernel checks their ranges."""
    checks.instance(name, value, Mapping)  # type: ignore[type-abstract]
    checks.allowed_names("setting", value, kernel.default_settings())
    return {setting: checks.number(setting, number) for setting, number in value.items()}


class FiniteStrainBlock(Checked):
    """Solver of one wave at finite strain.

    The columns of the `mesh` are doubled, to 256 at most, as long as the two frictions differ by
    more than the `friction_bound` of the result, or contacts of fewer than 4 nodes carry half of
    the load; with a `tolerance` the mesh has its proportions. `tolerance` and `time_limit` [s] are
    as in `gripscale.solve_scale`. Raises `InputError` if one of them is not above zero, or a
    setting is unknown or no number above zero.
    """

    name: ClassVar[str] = "finite_strain"

    mesh: Mesh = field(
        default_factory=Mesh, metadata={"check": partial(checks.instance, kind=Mesh)}
    )
    tolerance: float | None = checked(checks.positive, default=None)
    settings: Mapping[str, float] = field(default_factory=dict, metadata={"check": _settings})
    """Values that differ from `gripscale.wave.default_settings()`."""
    time_limit: float | None = checked(checks.positive, unit="s", default=None)

    @classmethod
    def of(
        cls, *, tolerance: float | None = None, time_limit: float | None = None, **options: Any
    ) -> FiniteStrainBlock:
        """Return the block of the keyword arguments of `solve_scale`; `InputError` for others."""
        of_kernel = ("max_iterations", "residual_tolerance")
        checks.allowed_names("option", options, (*Mesh.__dataclass_fields__, *of_kernel))
        settings = {name: options.pop(name, None) for name in of_kernel}
        chosen = {name: value for name, value in settings.items() if value is not None}
        return cls(Mesh(**options), tolerance, chosen, time_limit)

    def coarser(self) -> FiniteStrainBlock:
        """Return the block on half the columns and two thirds of the rows, a sixth of the work."""
        mesh = self.mesh
        columns, rows = max(mesh.columns // 2, 4), max(2 * mesh.rows // 3, 2)
        return replace(self, mesh=replace(mesh, columns=columns, rows=rows), tolerance=None)

    def solve(
        self, problem: WaveProblem, start: ScaleResult | None = None, *, workers: int | None = None
    ) -> ScaleResult:
        """Return contact and friction of `problem`.

        `start` is a first guess and may be of another rubber, wave or load. `workers` as for
        `gripscale.solve_scale`. Raises `InputError` if `start` is of another solver or was read
        from a file, or `workers` is not a whole number from 1 to 1024.
        """
        profile, load, mesh = problem.profile, problem.load, self.mesh
        length = profile.wavelength
        if problem.thickness is not None:
            mesh = replace(mesh, depth=min(mesh.depth, problem.thickness / length))
        first = None if start is None else kernel.solution_of(start)
        solution = kernel.solve_steady(
            problem, mesh, self.settings, self.tolerance, first, self.time_limit, workers
        )
        details = {
            "contact_edges": [(start * length, end * length) for start, end in solution.contacts],
            "load_steps": solution.load_steps,
            "load_reached": solution.load_reached,
            "indentation": solution.approach * length,
            "columns": solution.columns,
            "coarser_columns": solution.judged_by or 0,
            "rows": solution.rows,
            "depth": mesh.depth,
            "element_order": mesh.element_order,
        }
        if solution.too_narrow is not None:
            expected, smallest = solution.too_narrow
            details["expected_contact_width"] = expected * length
            details["smallest_contact_width"] = smallest * length
        if solution.waves_carried:
            details["smallest_wave_carried"] = length / solution.waves_carried
        if solution.judged_by is None:
            why = f"no coarser mesh than {solution.columns} columns was solved"
            if not math.isfinite(solution.friction):
                why = "nothing was solved"
            elif solution.status not in _SOLVED:
                why = f"the solution ended early, {solution.status}"
            details["no_error_estimate"] = why
        return ScaleResult(
            wavelength=length,
            amplitude=profile.amplitude,
            pressure_received=load.pressure,
            speed=load.speed,
            load_time=load.load_time,
            status=Status(solution.status),
            x=solution.x * length,
            rubber=problem.rubber,
            model=self.name,
            deformed_mesh=(solution.mesh_x * length, solution.mesh_z * length),
            details=details,
            **{name: getattr(solution, name) for name in _NUMBERS},
            friction_bound=math.nan if solution.friction_bound is None else solution.friction_bound,
            loss_by_depth=(
                length * np.append(0.0, np.cumsum(solution.row_heights)),
                solution.lost_by_row,
            ),
            solution=solution,
        )


def solve_scale(
    rubber: Rubber,
    *,
    wavelength: Quantity,
    amplitude: Quantity,
    pressure: Quantity,
    speed: Quantity,
    load_time: Quantity = math.inf,
    depth: float = Mesh.depth,
    columns: int = Mesh.columns,
    rows: int = Mesh.rows,
    element_order: int = Mesh.element_order,
    tolerance: float | None = None,
    time_limit: float | None = None,
    workers: int | None = None,
    start: ScaleResult | None = None,
    max_iterations: int | None = None,
    residual_tolerance: float | None = None,
) -> ScaleResult:
    """Press a rubber block on one rigid sine wave, slide it, and find contact and friction.

    The block is one wavelength wide and periodic, in plane strain at finite deformation: the
    rubber's permanent network plus one temporary network per Maxwell element (Lubliner, Mech. Res.
    Commun. 12 (1985) 93), frictionless unilateral contact with z = amplitude cos(2 pi x /
    wavelength). The steady state is one non-linear solve in the frame of the wave.

    The `status` of the result is `converged`, or the reason not to use the numbers. Raises
    `InputError` if a value is not a number or out of its range, or the pressure is more than ten
    times the modulus of the rubber: the equilibrium modulus at rest, else E(0).

        >>> load = {"pressure": "3 bar", "speed": "0.3 m/s"}
        >>> f"{gs.solve_scale(rubber, wavelength='8 mm', amplitude='0.5 mm', **load).friction:.3f}"
        '0.044'

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
        Relaxation time of the mean deformation so far [s]; infinity by default.
    depth, columns, rows, element_order
        As in `gripscale.wave.Mesh`.
    tolerance : float, optional
        Largest estimated discretisation error, absolute in contact fraction and relative in
        friction (to 0.04 of the slope 2 pi amplitude/wavelength where friction is less). The mesh
        is refined until it is met, from coarser than `columns` x `rows` to 2048 columns. By default
        the mesh is that of `columns` and `rows`, refined only where its two frictions differ by
        more than the `friction_bound` of the result or fewer than 4 nodes are in contact.
    time_limit : float, optional
        Seconds after which the solution ends with the status `time limit`, on the finest mesh that
        was solved, or at the pressure that was reached. None: no limit.
    workers : int, optional
        Threads for a large mesh; their number does not change the result by a bit. One per core by
        default, and one if gripscale solves several waves concurrently.
    start : ScaleResult, optional
        A result of another wave, pressure, speed or rubber to start from (a warm start).
    max_iterations : int, optional
        Newton iterations allowed in one load step.
    residual_tolerance : float, optional
        Largest residual force over the applied force, and gap over the amplitude [-].
    """
    load = WaveLoad(pressure, speed, load_time)
    problem = WaveProblem(rubber, Sine(wavelength, amplitude), load)
    require_load_bearing(rubber, load.pressure, math.inf if load.speed == 0.0 else 0.0)
    mesh = {"columns": columns, "rows": rows, "depth": depth, "element_order": element_order}
    of_kernel = {"max_iterations": max_iterations, "residual_tolerance": residual_tolerance}
    block = FiniteStrainBlock.of(tolerance=tolerance, time_limit=time_limit, **mesh, **of_kernel)
    return block.solve(problem, start, workers=workers)


# Numbers of columns, all of which can be halved for the coarser meshes of a sequence.
_COLUMNS = (128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 3072, 4096)
COLUMNS_PER_WAVE = 12
FEWEST_PER_WAVE = 6
# Ratio of heights of neighbouring rows, at most one as wide as high at the surface.
ROW_GROWTH = 1.12
# Range of the heights after filtering, over that before, below which only round-off remains.
_ROUND_OFF = 1e-12


def solve_profile(
    rubber: Rubber,
    profile: Profile,
    *,
    pressure: Quantity,
    speed: Quantity,
    load_time: Quantity = math.inf,
    smallest_wavelength: Quantity | None = None,
    periodic: bool = False,
    depth: float = Mesh.depth,
    columns: int | None = None,
    rows: int | None = None,
    workers: int | None = None,
    start: ScaleResult | None = None,
    settings: Mapping[str, float] | None = None,
    **options: Any,
) -> ScaleResult:
    """Press a rubber block on one period of a profile, slide it, and find contact and friction.

    As `gripscale.solve_scale`, on sampled heights in place of one sine. Missing heights are
    interpolated linearly, and a profile that is not periodic is made so by
    `gripscale.half_space.one_period`, with flanks no steeper than 4. Raises `InputError` if a value
    is not a number or out of its range, the smallest wave needs more columns, or the pressure is
    more than ten times the modulus of the rubber: at rest the equilibrium modulus, which a melt
    does not have, else that at the highest frequencies.

        >>> period = gs.solve_profile(rubber, sampled, pressure="3 bar", speed=0.3, periodic=True)
        >>> period.status == "converged"
        True

    Parameters
    ----------
    rubber : Rubber
        The viscoelastic solid.
    profile : Profile
        Heights of one period [m]; the rubber slides along its x.
    pressure, speed, load_time, workers
        As in `gripscale.solve_scale`.
    smallest_wavelength : float, optional
        Cut-off [m], see `gripscale.solve_rough_contact`; by default four steps, none of a periodic
        profile.
    periodic : bool
        Whether the profile is one period as it stands, its last point one step before the first of
        the next period.
    depth : float
        Height of the block in periods.
    columns, rows : int, optional
        Elements along and across the block; by default 12 columns along the smallest wave, rounded
        up to a number of few factors, from 128 to 4096, and a number of rows whose heights grow by
        12 % at most from one to the next. Columns are doubled, to 4096 at most, as long as the two
        frictions differ by more than the `friction_bound` of the result.
    start : ScaleResult, optional
        A result of the block to start from, of any profile, load and rubber.
    settings : mapping, optional
        Further settings of the kernel by name, see `gripscale.wave.default_settings`.
    **options
        `element_order`, `tolerance`, `time_limit`, `max_iterations` and `residual_tolerance` as in
        `gripscale.solve_scale`; the gap of the last over half the range of heights.

    Returns
    -------
    ScaleResult
        Its `wavelength` is the period, its `amplitude` half the range of heights; x starts at the
        first point. `details` also has the `contact_edges` [m], the `missing_share` of the points,
        the `smallest_wavelength` of the block's profile [m], and the `contact_slope`, the largest
        slope in the contact.
    """
    if not isinstance(profile, Profile):
        raise InputError(f"profile must be a gripscale.Profile; got {type(profile).__name__}")
    checks.flag("periodic", periodic)
    if smallest_wavelength is not None:
        smallest_wavelength = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    elif not periodic:
        smallest_wavelength = min(RESOLVED_STEPS * profile.step, len(profile) * profile.step)
    heights = _heights(profile, smallest_wavelength, periodic)
    smallest = smallest_wavelength or heights.wavelength / heights.waves
    waves = round(heights.wavelength / smallest)
    if columns is None:
        if FEWEST_PER_WAVE * waves > _COLUMNS[-1]:
            least = FEWEST_PER_WAVE * heights.wavelength / _COLUMNS[-1]
            raise InputError(
                f"smallest_wavelength must be at least {least:.4g} m, {FEWEST_PER_WAVE} of "
                f"{_COLUMNS[-1]} columns; got waves down to {smallest:.4g} m"
            )
        wanted = COLUMNS_PER_WAVE * waves
        columns = next((count for count in _COLUMNS if count >= wanted), _COLUMNS[-1])
    if rows is None:
        count = checks.positive("columns", columns)
        growth = float(kernel.default_settings()["row_exponent"])
        following = Mesh.rows * math.pow(count / Mesh.columns, growth)
        graded = math.log1p((ROW_GROWTH - 1.0) * depth * count) / math.log(ROW_GROWTH)
        rows = round(min(following, graded))
    block = FiniteStrainBlock.of(columns=columns, rows=rows, depth=depth, **options)
    chosen = {**block.settings, "rescue_columns": _COLUMNS[-1], **(settings or {})}
    block = replace(block, settings=chosen)
    load = WaveLoad(pressure, speed, load_time)
    problem = WaveProblem(rubber, heights, load)
    require_load_bearing(rubber, load.pressure, math.inf if load.speed == 0.0 else 0.0)
    result = block.solve(problem, start, workers=workers)
    in_contact = result.x[result.pressure > 0.0]
    further = {
        "missing_share": profile.missing / len(profile),
        "smallest_wavelength": smallest,
        "contact_slope": float(np.abs(heights.slope(in_contact)).max(initial=0.0)),
    }
    return replace(result, details={**result.details, **further})


def _heights(profile: Profile, smallest: float | None, periodic: bool) -> SampledProfile:
    """Return the heights of one period, with a cut-off [m] or all their waves."""
    if periodic:
        line = Profile(profile.x, fill_gaps(profile.z, periodic=True))
    else:
        line = one_period(profile)
    if smallest is not None:
        line = low_pass(line, smallest)
    period, z = len(line) * line.step, line.z
    after, before = np.ptp(z), float(np.nanmax(profile.z) - np.nanmin(profile.z))
    if after <= _ROUND_OFF * before:
        raise InputError(
            "profile must have waves left without its tilt and those below smallest_wavelength; "
            f"got heights within {after:.3g} m of each other, {before:.3g} m before"
        )
    return SampledProfile(period, z)
