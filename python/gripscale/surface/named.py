"""Surfaces made from stated statistics, for studies where no second measured road is at hand."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from gripscale.surface.height_difference import height_difference
from gripscale.surface.prepared import Measured, PreparedSurface
from gripscale.surface.profile import Profile
from gripscale.surface.sine_fit import fit_sines
from gripscale.surface.synthetic import self_affine_profile


@dataclass(frozen=True)
class Statistics:
    """Self-affine statistics of a synthetic surface, and how it is drawn and described (m)."""

    hurst: float
    xi_parallel: float
    xi_perpendicular: float
    length: float
    step: float
    seed: int
    waves: int
    smallest_wavelength: float


SYNTHETIC_SURFACES = {
    "synthetic_dense_asphalt": Statistics(
        hurst=0.8,
        xi_parallel=2e-3,
        xi_perpendicular=0.6e-3,
        length=1.6,
        step=37.5e-6,
        seed=2014,
        waves=7,
        smallest_wavelength=0.1e-3,
    )
}
"""By name. The numbers are of the order of a dense asphalt's; no road was measured for them."""


def synthetic_profile(name: str) -> Profile:
    """Return the profile of a synthetic surface."""
    made = SYNTHETIC_SURFACES[name]
    return self_affine_profile(
        made.hurst, made.xi_parallel, made.xi_perpendicular, made.length, made.step, made.seed
    )


def with_profile(name: str) -> PreparedSurface:
    """Return a synthetic surface as if its profile had been measured, with as many waves."""
    surface = synthetic_surface(name)
    fit = {**surface.fit, "scales": SYNTHETIC_SURFACES[name].waves}
    return replace(surface, fit=fit, measured=Measured.of([synthetic_profile(name)]))


@lru_cache(maxsize=4)
def synthetic_surface(name: str) -> PreparedSurface:
    """Return a synthetic surface, with what it is made of as its source."""
    made = SYNTHETIC_SURFACES[name]
    correlation = height_difference(synthetic_profile(name))
    sines = fit_sines(correlation, scales=made.waves, smallest_wavelength=made.smallest_wavelength)
    source = (
        f"{name}: synthetic, self-affine, H = {made.hurst:g}, "
        f"xi_parallel = {made.xi_parallel * 1e3:g} mm, "
        f"xi_perpendicular = {made.xi_perpendicular * 1e3:g} mm, "
        f"{made.length:g} m in steps of {made.step * 1e6:g} um, seed {made.seed}"
    )
    fit = {"smallest_wavelength": float(sines.wavelength[-1])}
    return PreparedSurface(sines, source, correlation, fit)
