"""The chain: the pressure that leaves the contact of one wave is what the next wave receives.

With A_i the contact length of wave i projected on the mean plane (Lind & Wangenheim 2014,
IMECE2014-37998, equations 1 to 3):

    pressure     p_(i+1)  = p_i lambda_i / A_i
    real area    A_r/A_0  = prod A_i / lambda_i
    friction     mu_r     = sum mu_i

The friction sum conserves energy because p_i times the running area fraction is p_1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import ConvergenceError, InputError

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.rubber import Rubber
    from gripscale.scale import ScaleResult
    from gripscale.surface import SineStack

Array = NDArray[np.float64]
LoadTime = Literal["passage"] | float


Solver = Callable[..., "ScaleResult"]
"""Anything called like `solve_scale` or `solve_half_plane`: (rubber, *, wavelength, amplitude,
pressure, speed, load_time, **options) in SI units, returning a `ScaleResult`."""


@dataclass(frozen=True)
class Prediction:
    """Contact and friction of a stack of waves (m, Pa, m/s).

    A wave that did not converge is kept, last, with its status: the totals are then NaN.
    """

    rubber: Rubber
    sines: SineStack
    pressure: float
    """Nominal pressure on the largest wave [Pa]."""
    speed: float
    footprint: float
    """Length of the nominal contact [m]."""
    scales: list[ScaleResult]

    @property
    def converged(self) -> bool:
        """Whether every wave solved so far may be used."""
        return all(scale.converged for scale in self.scales)

    @property
    def running_contact_fraction(self) -> Array:
        """A_r/A_0 down to each wave (equation 2); NaN from a failed wave on."""
        each = self._of_converged([s.contact_fraction for s in self.scales])
        return np.asarray(np.cumprod(each), dtype=float)

    @property
    def running_friction(self) -> Array:
        """Friction coefficient down to each wave (equation 3); NaN from a failed wave on."""
        each = self._of_converged([s.friction for s in self.scales])
        return np.asarray(np.cumsum(each), dtype=float)

    @property
    def contact_fraction(self) -> float:
        """Real over nominal contact area, A_r/A_0, of all waves [-]."""
        return float(self.running_contact_fraction[-1]) if self.scales else math.nan

    @property
    def friction(self) -> float:
        """Friction coefficient of all waves [-]."""
        return float(self.running_friction[-1]) if self.scales else math.nan

    @property
    def friction_from_dissipation(self) -> float:
        """Friction coefficient of all waves from the energy lost in the rubber [-]."""
        each = self._of_converged([s.friction_from_dissipation for s in self.scales])
        return float(each.sum()) if self.scales else math.nan

    @property
    def angular_frequency(self) -> Array:
        """Fundamental excitation of each wave, w_i = 2 pi v / lambda_i [rad/s]."""
        wavelength = np.array([s.wavelength for s in self.scales])
        return 2.0 * math.pi * self.speed / wavelength

    @property
    def modulus(self) -> Array:
        """|E*(w_i)| of each wave [Pa]."""
        return np.abs(self._complex_modulus())

    @property
    def loss_factor(self) -> Array:
        """E''(w_i)/E'(w_i) of each wave [-]."""
        modulus = self._complex_modulus()
        return np.asarray(modulus.imag / modulus.real)

    @property
    def outside_band(self) -> NDArray[np.bool_]:
        """Whether a wave excites the rubber beyond what was measured, where it slides.

        Looked at are w_i and its harmonic as long as the contact, n_i = ceil(lambda_i/A_i).
        """
        if self.speed == 0.0:
            return np.zeros(len(self.scales), dtype=bool)
        fraction = np.array([s.contact_fraction for s in self.scales])
        harmonic = np.ceil(1.0 / np.where(fraction > 0.0, fraction, 1.0))
        first = self.rubber.outside_band(self.angular_frequency)
        return np.asarray(first | self.rubber.outside_band(harmonic * self.angular_frequency))

    def to_dataset(self) -> xr.Dataset:
        """Return everything as a labelled Dataset over the dimension `scale`."""
        from gripscale.dataset import from_prediction

        return from_prediction(self)

    def _complex_modulus(self) -> NDArray[np.complex128]:
        return np.asarray(self.rubber.complex_modulus(self.angular_frequency), dtype=complex)

    def _of_converged(self, values: list[float]) -> Array:
        usable = np.array([scale.converged for scale in self.scales], dtype=bool)
        return np.where(usable, np.array(values, dtype=float), math.nan)


class ChainError(ConvergenceError):
    """A wave of the chain did not converge; `partial` holds everything solved up to it.

    The last entry of `partial.scales` is the wave that failed, with its status.
    """

    def __init__(self, message: str, partial: Prediction) -> None:
        super().__init__(message)
        self.partial = partial


def predict(
    rubber: Rubber,
    sines: SineStack,
    *,
    pressure: float,
    speed: float,
    footprint: float,
    solver: Solver | None = None,
    smallest_wavelength: float | None = None,
    max_scales: int | None = None,
    load_time: LoadTime = "passage",
    on_scale: Callable[[Prediction], None] | None = None,
    start: Prediction | None = None,
    **options: Any,
) -> Prediction:
    """Run the chain over the waves of `sines`, largest first.

    Parameters
    ----------
    rubber
        The rubber, handed to the solver.
    sines
        Waves in order of falling wavelength [m], amplitude = half peak-to-valley [m].
    pressure
        Nominal pressure on the largest wave [Pa], above zero.
    speed
        Sliding speed [m/s]; zero is static contact of the relaxed rubber.
    footprint
        Length of the nominal contact [m]; with `speed` it gives wave 1 its load time.
    solver
        Callable with the call shape of `solve_scale`, which is the default.
    smallest_wavelength
        Waves shorter than this are left out [m].
    max_scales
        Number of waves after which to stop.
    load_time
        "passage": wave i is loaded while the contact above it passes,
        t_1 = footprint/speed, t_i = A_(i-1)/speed. A number fixes it for every wave [s],
        infinity lets the mean state relax fully. Always infinite at zero speed.
    on_scale
        Called with the prediction so far after every wave.
    start
        A prediction at a neighbouring speed, pressure or rubber: each wave starts from its wave of
        the same number. The results are the same to the solver's residual, found sooner.
    **options
        Passed to the solver: columns, rows, depth ...

    Returns
    -------
    Prediction
        One `ScaleResult` per wave, with running area and friction.

    Raises
    ------
    InputError
        A value that cannot be used.
    ChainError
        A wave did not converge; a `ConvergenceError` whose `partial` is the prediction so far.
    """
    pressure = checks.positive("pressure", pressure, unit="Pa")
    speed = checks.not_negative("speed", speed, unit="m/s")
    footprint = checks.positive("footprint", footprint, unit="m")
    clock = _load_clock(load_time, speed)
    solve = solver if solver is not None else _finite_strain_solver()
    waves = select_waves(sines, smallest_wavelength=smallest_wavelength, max_scales=max_scales)

    result = Prediction(rubber, sines, pressure, speed, footprint, [])
    p, length = pressure, footprint
    for number, (wavelength, amplitude) in enumerate(waves):
        if start is not None and number < len(start.scales):
            options["start"] = start.scales[number]
        scale = solve(
            rubber,
            wavelength=wavelength,
            amplitude=amplitude,
            pressure=p,
            speed=speed,
            load_time=clock(length),
            **options,
        )
        result = replace(result, scales=[*result.scales, scale])
        if on_scale is not None:
            on_scale(result)
        _require_contact(scale, len(waves), result)
        p = p * wavelength / scale.contact_length  # equation 1; unchanged in full contact
        length = scale.contact_length
    return result


def select_waves(
    sines: SineStack,
    *,
    smallest_wavelength: float | None = None,
    max_scales: int | None = None,
) -> list[tuple[float, float]]:
    """Return (wavelength, amplitude) [m] of the waves the chain visits.

    Raises `InputError` if the limits leave none.
    """
    waves = [(float(w), float(a)) for w, a in zip(sines.wavelength, sines.amplitude, strict=True)]
    if not waves:
        raise InputError("sines must hold at least one wave; got none")
    if smallest_wavelength is not None:
        least = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
        largest = waves[0][0]
        waves = [wave for wave in waves if wave[0] >= least]
        if not waves:
            raise InputError(
                f"smallest_wavelength must not exceed the largest wave, {largest:g} m; "
                f"got {least:g} m"
            )
    if max_scales is not None:
        waves = waves[: checks.whole("max_scales", max_scales, least=1, most=1000)]
    return waves


def _finite_strain_solver() -> Solver:
    """Return `gripscale.scale.solve_scale`, imported late: it needs the compiled kernel."""
    from gripscale import scale

    return scale.solve_scale


def _load_clock(load_time: LoadTime, speed: float) -> Callable[[float], float]:
    """Return the function that turns the length of the contact above [m] into a load time [s]."""
    if isinstance(load_time, str):
        checks.one_of("load_time", load_time, ["passage"])
        if speed == 0.0:
            return lambda _: math.inf
        return lambda length: length / speed
    fixed = checks.positive("load_time", load_time, unit="s", infinite=True)
    return (lambda _: math.inf) if speed == 0.0 else (lambda _: fixed)


def _require_contact(scale: ScaleResult, total: int, partial: Prediction) -> None:
    """Raise `ChainError` unless the wave may hand its pressure on."""
    place = (
        f"wave {len(partial.scales)} of {total} (wavelength {scale.wavelength * 1e3:.4g} mm, "
        f"amplitude {scale.amplitude * 1e3:.4g} mm, pressure {scale.pressure_received:.4g} Pa, "
        f"speed {scale.speed:.4g} m/s)"
    )
    if not scale.converged:
        raise ChainError(
            f"{place} did not converge: {scale.status} after {scale.newton_iterations} Newton "
            f"iterations, residual {scale.residual:.2g}",
            partial,
        )
    if not 0.0 < scale.contact_fraction <= 1.0:
        raise ChainError(
            f"{place} has a contact fraction of {scale.contact_fraction:g}; "
            "expected more than 0 and at most 1",
            partial,
        )
