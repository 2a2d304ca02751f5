"""The finite-strain block on one period of a measured profile: every wave of it at once.

The profile is made periodic, cut off below the smallest wavelength, and pressed into one block:
no separation of scales, no random phases, and no small strain.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gripscale import model
from gripscale.core import checks, provenance
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber
from gripscale.rubber.material import require_load_bearing
from gripscale.surface import PreparedSurface, Profile, SurfacePart
from gripscale.surface.resampling import filled
from gripscale.wave import kernel
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.problem import Load, Mesh, SampledProfile, WaveProblem
from gripscale.wave.result import WaveResult

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber


Array = NDArray[np.float64]

COLUMNS = (128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 3072, 4096)
"""Columns to choose from: all can be halved for the coarser meshes of a sequence."""
COLUMNS_PER_WAVE = 12
FEWEST_PER_WAVE = 6
ROW_GROWTH = 1.12
"""Ratio of heights of neighbouring rows, at most one as wide as high at the surface."""


ROUND_OFF = 1e-12
"""Share of the range of heights below which what is left of them is no profile."""


def solve_profile(
    rubber: Rubber,
    profile: Profile,
    *,
    pressure: float,
    speed: float,
    load_time: float = math.inf,
    smallest_wavelength: float | None = None,
    periodic: bool = False,
    depth: float = Mesh.depth,
    columns: int | None = None,
    rows: int | None = None,
    element_order: int = Mesh.element_order,
    tolerance: float | None = None,
    time_limit: float | None = None,
    workers: int | None = None,
    start: WaveResult | None = None,
    max_iterations: int | None = None,
    residual_tolerance: float | None = None,
) -> WaveResult:
    """Press a rubber block on one period of a profile, slide it, and find contact and friction.

    As `gripscale.solve_scale`, on sampled heights in place of one sine. Missing heights are
    interpolated linearly.

    Parameters
    ----------
    rubber : Rubber
        The viscoelastic solid.
    profile : Profile
        Heights of one period [m]; the rubber slides along its x.
    pressure : float
        Mean pressure on the lid [Pa].
    speed : float
        Sliding speed [m/s]; 0 is static contact of the fully relaxed rubber.
    load_time : float
        Time the mean deformation has had to relax [s]; infinity by default.
    smallest_wavelength : float, optional
        Shorter waves are left out [m]; by default all that the profile holds are kept.
    periodic : bool
        Whether the profile is one period as it stands, its last point one step before the first of
        the next period. Otherwise the line through its end points, which then coincide, is
        subtracted.
    depth : float
        Height of the block in periods.
    columns, rows : int, optional
        Elements along and across the block; by default 12 columns along the smallest wave, rounded
        up to a number of few factors, from 128 to 4096, and rows to suit: no more than grow by 12 %
        from one to the next.
    element_order : int
        1: bilinear with one pressure; 2: biquadratic with linear discontinuous pressure.
    tolerance, time_limit : float, optional
        As in `gripscale.solve_scale`.
    workers : int, optional
        As in `gripscale.solve_scale`.
    start : WaveResult, optional
        A result of the block to start from, of any profile, load and rubber.
    max_iterations : int, optional
        Newton iterations allowed in one load step.
    residual_tolerance : float, optional
        Largest residual force over the applied force, and gap over half the range of heights [-].

    Returns
    -------
    WaveResult
        Its `wavelength` is the period, its `amplitude` half the range of heights; x starts at the
        first point. `details` also has the `contact_edges` [m], `missing_share` of the points, the
        `smallest_wavelength` that was kept [m], and the `contact_slope`, the largest slope under
        the rubber.

    Raises
    ------
    InputError
        If a value is not a number or out of its range, the smallest wave needs more columns, or
        the rubber at rest is a melt: the pressure is more than ten times the equilibrium modulus.
    """
    if not isinstance(profile, Profile):
        raise InputError(f"profile must be a gripscale.Profile; got {type(profile).__name__}")
    checks.flag("periodic", periodic)
    heights = _one_period(profile, smallest_wavelength, periodic)
    chosen = _columns(heights) if columns is None else columns
    block = FiniteStrainBlock.of(
        columns=chosen,
        rows=_rows(checks.positive("columns", chosen), depth) if rows is None else rows,
        depth=depth,
        element_order=element_order,
        tolerance=tolerance,
        time_limit=time_limit,
        max_iterations=max_iterations,
        residual_tolerance=residual_tolerance,
    )
    problem = WaveProblem(rubber, heights, Load(pressure, speed, load_time))
    if problem.load.speed == 0.0:
        require_load_bearing(rubber, problem.load.pressure, math.inf)
    result = block.solve(problem, start, workers=workers)
    pressed = result.x[result.pressure > 0.0]
    told = {
        "missing_share": profile.missing / len(profile),
        "smallest_wavelength": heights.wavelength / heights.waves,
        "contact_slope": float(np.abs(heights.slope(pressed)).max(initial=0.0)),
    }
    return replace(result, details={**result.details, **told})


def _one_period(profile: Profile, smallest: float | None, periodic: bool) -> SampledProfile:
    """Return the heights without gaps and tilt, and without waves below the smallest."""
    period = len(profile) * profile.step if periodic else profile.length
    z = filled(profile.z, periodic=periodic)
    if not periodic:
        z = (z - np.linspace(z[0], z[-1], z.size))[:-1]
    if smallest is not None:
        z = _cut_off(z, period, smallest)
    left, there = np.ptp(z), float(np.nanmax(profile.z) - np.nanmin(profile.z))
    if left <= ROUND_OFF * there:
        raise InputError(
            "profile must have waves left without its tilt and those below smallest_wavelength; "
            f"got heights within {left:.3g} m of each other, {there:.3g} m before"
        )
    return SampledProfile(period, z)


def _cut_off(z: Array, period: float, smallest: float) -> Array:
    """Return heights of the same period without waves below the smallest."""
    cut = checks.positive("smallest_wavelength", smallest, unit="m")
    # Round-off must not drop a wave that is exactly the smallest.
    waves = math.floor(min(period / cut * (1.0 + 1e-9), z.size))
    if waves < 1:
        raise InputError(
            f"smallest_wavelength must be at most the period {period:g} m; got {cut:g} m"
        )
    kept = np.fft.rfft(z)[: waves + 1]
    count = max(4 * (kept.size - 1), 16)
    return np.asarray(np.fft.irfft(kept, count) * (count / z.size))


def _rows(columns: float, depth: float) -> int:
    """Return rows that follow the columns, no more than a gentle grading over the depth takes."""
    grows = float(kernel.default_settings()["row_exponent"])
    following = Mesh.rows * math.pow(columns / Mesh.columns, grows)
    graded = math.log1p((ROW_GROWTH - 1.0) * depth * columns) / math.log(ROW_GROWTH)
    return round(min(following, graded))


def _columns(heights: SampledProfile) -> int:
    """Return 12 columns along the smallest wave, rounded up, or all there are if they suffice."""
    if FEWEST_PER_WAVE * heights.waves > COLUMNS[-1]:
        least = FEWEST_PER_WAVE * heights.wavelength / COLUMNS[-1]
        raise InputError(
            f"smallest_wavelength must be at least {least:.4g} m, {FEWEST_PER_WAVE} of "
            f"{COLUMNS[-1]} columns; got waves down to {heights.wavelength / heights.waves:.4g} m"
        )
    wanted = COLUMNS_PER_WAVE * heights.waves
    return next((count for count in COLUMNS if count >= wanted), COLUMNS[-1])


# The block on whole profiles as one of the models that can be compared, varied and reported.


@dataclass(frozen=True)
class BlockOnProfile(model.Model):
    """Every cleaned profile in one finite-strain block, averaged by length.

    The profiles must be short: a block carries a hundred waves or so (see
    `gripscale.half_space.windows`). A place is loaded for the time of the load, while the
    footprint passes.

    Parameters
    ----------
    smallest_wavelength, periodic, tolerance
        See `gripscale.solve_profile`.
    """

    name: ClassVar[str] = "block_on_profile"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement"})

    smallest_wavelength: float | None = None
    periodic: bool = False
    tolerance: float | None = None

    def __post_init__(self) -> None:
        if self.smallest_wavelength is not None:
            checks.positive("smallest_wavelength", self.smallest_wavelength, unit="m")
        checks.flag("periodic", self.periodic)
        if self.tolerance is not None:
            checks.positive("tolerance", self.tolerance)

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer, with each profile over `profile`; `on_progress` gets each result.

        Raises
        ------
        InputError
            If the surface has no profile, or one with more waves than a block carries.
        """
        results = []
        for line in _lines(surface):
            results.append(self._solve(rubber, line, load))
            if on_progress is not None:
                on_progress(results[-1])
        why_not = ["" if result.converged else result.why for result in results]
        return _answer(results, why_not, load)

    def _solve(self, rubber: Rubber, line: Profile, load: NominalLoad) -> WaveResult:
        return solve_profile(
            rubber,
            line,
            pressure=load.pressure,
            speed=load.speed,
            load_time=load.time_under(load.footprint),
            smallest_wavelength=self.smallest_wavelength,
            periodic=self.periodic,
            tolerance=self.tolerance,
        )


def _answer(results: list[WaveResult], why_not: list[str], load: NominalLoad) -> xr.Dataset:
    from gripscale.wave.result import waves_to_dataset

    data = waves_to_dataset(results).drop_vars("scale").rename(scale="profile")
    data = data.assign_attrs(title="Profiles in the finite-strain block", **provenance.attributes())
    lengths = [result.wavelength for result in results]
    return model.answer_by_length(data, results, why_not, lengths, BlockOnProfile.name, load)


def _lines(surface: PreparedSurface) -> list[Profile]:
    if surface.measured is None:
        raise InputError(
            "the block on a profile needs a profile; got sine waves stated by hand, which have "
            "none (gripscale.half_space.surface_of_sines makes one)"
        )
    return surface.measured.cleaned
