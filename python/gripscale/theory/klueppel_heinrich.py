"""The theory of Klueppel and Heinrich: hysteresis friction by the loss under a self-affine surface.

    mu     = 1/2 delta/(p_0 v) int dw w E''(w) S(w),     w = 2 pi v/lambda from xi_par to lambda_min
    S(w)   = S_0 (w/w_min)^(-(2H + 1)),   S_0 = H xi_perp^2/(2 pi v xi_par),   w_min = 2 pi v/xi_par

with delta = b z_p. M. Klueppel & G. Heinrich, Rubber Chem. Technol. 73 (2000) 578,
doi:10.5254/1.3547607. What could not be confirmed and the caller states: docs/theories.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from gripscale.core import Array, Checked, InputError, Quantity, checked, checks
from gripscale.model import Load, Model, OnProgress
from gripscale.rubber import Rubber
from gripscale.surface import HeightDifference, SelfAffineFit, fit_self_affine, height_difference
from gripscale.surface.profile import Profile
from gripscale.surface.surface import Surface, SurfacePart
from gripscale.theory.persson import (
    TheoryResult,
    answer_of,
    divided,
    followed_profiles,
    refine_intervals,
    running_integral,
)

if TYPE_CHECKING:
    import xarray as xr


# Share of the heights of a profile that counts, from the highest down: valleys have no contact.
_TOP_HEIGHT_FRACTION = 0.5
_TOLERANCE = 1e-6  # relative error of the integral below which a result is converged
_NODES = 33  # wavelengths of the running friction
_COARSEST, _FINEST = 4, 1024  # intervals between them, doubled from the first to the last


@dataclass(frozen=True, repr=False)
class KlueppelHeinrichResult(TheoryResult):
    """Hysteresis friction of a self-affine surface, down to each wavelength (m, Pa, m/s)."""

    name = "klueppel_heinrich"
    title = "Hysteresis friction of rubber on a self-affine surface, without softening and heat"
    source = "Klueppel & Heinrich 2000, Rubber Chem. Technol. 73, 578"
    variables = (
        ("wavelength", "scale", "m", "wavelength"),
        ("running_friction", "scale", "1", "friction coefficient so far"),
        ("layer_ratio", (), "1", "thickness of the strained layer over penetration depth"),
        ("penetration_depth", (), "m", "mean penetration depth"),
        ("friction_error", (), "1", "estimated error of the friction coefficient"),
    )

    surface: SelfAffineFit
    layer_ratio: float
    penetration_depth: float


def klueppel_heinrich(
    rubber: Rubber,
    surface: SelfAffineFit | HeightDifference | Profile | Sequence[Profile],
    *,
    pressure: Quantity,
    speed: Quantity,
    layer_ratio: float,
    penetration_depth: Quantity,
    smallest_wavelength: Quantity,
) -> KlueppelHeinrichResult:
    """Return the hysteresis friction of a self-affine surface by Klueppel and Heinrich.

    The `contact_fraction` is NaN. Raises `InputError` if an argument is out of its range, or the
    surface is not self-affine.

    Parameters
    ----------
    rubber : Rubber
        The sliding rubber.
    surface : SelfAffineFit, HeightDifference or Profile(s)
        Of profiles only the upper part counts, `_TOP_HEIGHT_FRACTION`; a correlation is taken
        as it is.
    pressure, speed : float
        Nominal pressure [Pa], above zero, and sliding speed [m/s]; at zero there is no friction.
    layer_ratio : float
        b, thickness of the strained layer over penetration depth [-]. A free parameter of the
        theory, fitted to friction measured with the same rubber and surface.
    penetration_depth : float
        Mean depth z_p to which the summits enter the rubber, at this load and speed [m].
    smallest_wavelength : float
        Smallest wave that counts [m].
    """
    if not isinstance(surface, SelfAffineFit | HeightDifference):
        surface = height_difference(surface, top_height_fraction=_TOP_HEIGHT_FRACTION)
    fit = surface if isinstance(surface, SelfAffineFit) else fit_self_affine(surface)
    checks.instance("rubber", rubber, Rubber)
    ratio = checks.positive("layer_ratio", layer_ratio)
    depth = checks.positive("penetration_depth", penetration_depth, unit="m")
    smallest = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    if smallest >= fit.xi_parallel:
        raise InputError(
            "smallest_wavelength must be below the cut-off length of the surface, "
            f"{fit.xi_parallel:.4g} m; got {smallest:.4g}"
        )
    load = Load(pressure, speed, fit.xi_parallel)
    wavelength = np.geomspace(fit.xi_parallel, smallest, _NODES)

    def at(intervals: int) -> tuple[Array]:
        log_q = divided(np.log(2.0 * np.pi / wavelength), intervals)
        q = np.exp(log_q)
        loss = rubber.complex_modulus(q * load.speed).imag
        # delta/(2 p v) w E'' S dw, with w = q v and the strain spectrum over q, S dw = v S dq
        work = 0.5 * ratio * depth / load.pressure * q * loss * strain_spectrum(q, fit)
        return (running_integral(work * q, log_q)[::intervals],)

    (friction,), (error,), status = refine_intervals(at, _COARSEST, _FINEST, _TOLERANCE)
    common = (rubber, load, status, wavelength, friction, error)
    return KlueppelHeinrichResult(*common, fit, ratio, depth)


def strain_spectrum(q: Array, fit: SelfAffineFit) -> Array:
    """Return v S [m] at wavenumbers `q` [rad/m]: the spectrum of the strain over the wavenumber."""
    first = 2.0 * np.pi / fit.xi_parallel
    level = fit.hurst * fit.xi_perpendicular**2 / (2.0 * np.pi * fit.xi_parallel)
    return np.asarray(level * (q / first) ** (-(2.0 * fit.hurst + 1.0)))


class KlueppelHeinrich(Checked, Model):
    """The theory of Klueppel and Heinrich for the upper part of the profiles."""

    name: ClassVar[str] = "klueppel_heinrich"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"measurement", "cut_off"})

    layer_ratio: float = checked(checks.positive)
    """Thickness of the strained layer over penetration depth [-]."""
    penetration_depth: float = checked(checks.positive, unit="m")
    """Mean penetration depth [m]; the same at every load."""
    smallest_wavelength: float | None = checked(checks.positive, unit="m", default=None)
    """Smallest wave that counts [m]; by default the end of the surface's sine waves."""

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer as a Dataset; `on_progress` gets the `KlueppelHeinrichResult`.

        Raises `InputError` if the surface was not measured or its upper part is not self-affine.
        """
        result = klueppel_heinrich(
            rubber,
            followed_profiles(surface, self.name),
            pressure=load.pressure,
            speed=load.speed,
            layer_ratio=self.layer_ratio,
            penetration_depth=self.penetration_depth,
            smallest_wavelength=self.smallest_wavelength or surface.cutoff_wavelength,
        )
        return answer_of(replace(result, load=load), on_progress)
