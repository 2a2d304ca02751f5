"""The finite-strain block on one period of a measured profile: all its waves in one solution.

The profile is made `gripscale.surface.periodic.one_period` and pressed into one block: no
separation of scales, no random phases, and no small strain.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber
from gripscale.rubber.material import require_load_bearing
from gripscale.surface import Profile
from gripscale.surface.periodic import one_period, without_short_waves
from gripscale.surface.resampling import fill_gaps
from gripscale.wave import kernel
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.problem import Mesh, SampledProfile, WaveLoad, WaveProblem
from gripscale.wave.result import ScaleResult

_COLUMNS = (128, 192, 256, 384, 512, 768, 1024, 1536, 2048, 3072, 4096)
"""Numbers of columns, all of which can be halved for the coarser meshes of a sequence."""
COLUMNS_PER_WAVE = 12
FEWEST_PER_WAVE = 6
ROW_GROWTH = 1.12
"""Ratio of heights of neighbouring rows, at most one as wide as high at the surface."""


_ROUND_OFF = 1e-12
"""Range of the heights after filtering, over that before, below which only round-off remains."""


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
    workers: int | None = None,
    start: ScaleResult | None = None,
    settings: Mapping[str, float] | None = None,
    **options: Any,
) -> ScaleResult:
    """Press a rubber block on one period of a profile, slide it, and find contact and friction.

    As `gripscale.solve_scale`, on sampled heights in place of one sine. Missing heights are
    interpolated linearly, and a profile that is not periodic is made so by
    `gripscale.half_space.one_period`, with flanks no steeper than 4.

    Raises `InputError` if a value is not a number or out of its range, the smallest wave needs more
    columns, or the pressure is more than ten times the modulus of the rubber: at rest the
    equilibrium modulus, which a melt does not have, else that at the highest frequencies.

    Parameters
    ----------
    rubber : Rubber
        The viscoelastic solid.
    profile : Profile
        Heights of one period [m]; the rubber slides along its x.
    pressure, speed, load_time, workers
        As in `gripscale.solve_scale`.
    smallest_wavelength : float, optional
        Shorter waves are left out [m]; by default none of a periodic profile, else those shorter
        than four steps.
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
    heights = _heights(profile, smallest_wavelength, periodic)
    if columns is None:
        if FEWEST_PER_WAVE * heights.waves > _COLUMNS[-1]:
            least = FEWEST_PER_WAVE * heights.wavelength / _COLUMNS[-1]
            raise InputError(
                f"smallest_wavelength must be at least {least:.4g} m, {FEWEST_PER_WAVE} of "
                f"{_COLUMNS[-1]} columns; got waves down to "
                f"{heights.wavelength / heights.waves:.4g} m"
            )
        wanted = COLUMNS_PER_WAVE * heights.waves
        columns = next((count for count in _COLUMNS if count >= wanted), _COLUMNS[-1])
    if rows is None:
        count = checks.positive("columns", columns)
        growth = float(kernel.default_settings()["row_exponent"])
        following = Mesh.rows * math.pow(count / Mesh.columns, growth)
        graded = math.log1p((ROW_GROWTH - 1.0) * depth * count) / math.log(ROW_GROWTH)
        rows = round(min(following, graded))
    block = FiniteStrainBlock.of(columns=columns, rows=rows, depth=depth, **options)
    thorough = {"rescue_columns": _COLUMNS[-1]}
    block = replace(block, settings={**block.settings, **thorough, **(settings or {})})
    problem = WaveProblem(rubber, heights, WaveLoad(pressure, speed, load_time))
    load = problem.load
    require_load_bearing(rubber, load.pressure, math.inf if load.speed == 0.0 else 0.0)
    result = block.solve(problem, start, workers=workers)
    in_contact = result.x[result.pressure > 0.0]
    further = {
        "missing_share": profile.missing / len(profile),
        "smallest_wavelength": heights.wavelength / heights.waves,
        "contact_slope": float(np.abs(heights.slope(in_contact)).max(initial=0.0)),
    }
    return replace(result, details={**result.details, **further})


def _heights(profile: Profile, smallest: float | None, periodic: bool) -> SampledProfile:
    """Return the heights of one period without waves below the smallest."""
    line = profile if periodic else one_period(profile, smallest)
    period, z = len(line) * line.step, fill_gaps(line.z, periodic=True)
    if smallest is not None:
        z = without_short_waves(Profile(line.x, z), smallest).z
    after, before = np.ptp(z), float(np.nanmax(profile.z) - np.nanmin(profile.z))
    if after <= _ROUND_OFF * before:
        raise InputError(
            "profile must have waves left without its tilt and those below smallest_wavelength; "
            f"got heights within {after:.3g} m of each other, {before:.3g} m before"
        )
    return SampledProfile(period, z)
