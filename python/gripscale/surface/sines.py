"""A surface as superposed sine waves, and the search for the waves closest to a curve.

Wave i is A_i cos(2 pi x / lambda_i), A_i being half its height from valley to peak. Waves of
unrelated phase add in the height difference correlation,

    C_z(l) = sum_i A_i^2 (1 - cos(2 pi l / lambda_i)),

and usually both lengths shrink by constant magnification factors, lambda_{i+1} = lambda_i /
s_lambda and A_{i+1} = A_i / s_A (Lind & Wangenheim, ASME IMECE2014-37998). The search starts from a
fixed grid, so that equal input gives equal output.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, InputError, checked, checks
from gripscale.surface.height_difference import (
    HeightDifference,
    find_plateau,
    log_weights,
    require_positive,
)

# Largest departure of a ratio from the mean ratio for waves to count as geometric.
_GEOMETRIC_TOLERANCE = 0.01


class SineStack(Checked, eq=False):
    """Superposed sine waves, largest first.

    Raises `InputError` if lengths differ, an entry is not above zero, wavelengths do not decrease,
    a factor contradicts the waves, or `cut_off` is above the last wave.

        >>> gs.SineStack(["8 mm", "2 mm"], ["0.5 mm", "0.1 mm"]).s_wavelength
        4.0
    """

    wavelength: Array = checked(checks.positive_vector, unit="m")
    """Wavelengths [m], shape (waves,), positive, strictly decreasing."""
    amplitude: Array = checked(checks.positive_vector, unit="m")
    """Amplitudes [m], shape (waves,), positive: half the height from valley to peak."""
    s_wavelength: float | None = checked(checks.positive, default=None)
    s_amplitude: float | None = checked(checks.positive, default=None)
    """Magnification factors between neighbouring waves. If not given they are the geometric mean of
    the ratios, or None where the ratios differ by more than 1 % or there is one wave."""
    residual: float | None = checked(checks.not_negative, default=None)
    """Rms difference from the curve the waves were fitted to, in decades of C_z."""
    lag_range: tuple[float, float] | None = None
    """Smallest and largest lag the waves were fitted to [m]."""
    cut_off: float | None = checked(checks.positive, unit="m", default=None)
    """Shortest wavelength of the roughness the waves represent [m], if it is not the last wave."""

    def __post_init__(self) -> None:
        super().__post_init__()
        wavelength, amplitude = self.wavelength, self.amplitude
        checks.same_length(1, wavelength=wavelength, amplitude=amplitude)
        rises = np.diff(wavelength, prepend=np.inf) >= 0.0
        checks.refuse_entries(wavelength, rises, "wavelength must decrease from wave to wave", " m")
        if self.cut_off is not None and self.cut_off > wavelength[-1]:
            raise InputError(
                f"cut_off must not exceed the last wave, {wavelength[-1]:g} m; "
                f"got {self.cut_off:g} m"
            )
        self._set(
            s_wavelength=_factor("s_wavelength", wavelength, self.s_wavelength),
            s_amplitude=_factor("s_amplitude", amplitude, self.s_amplitude),
        )

    def __len__(self) -> int:
        return int(self.wavelength.size)

    @property
    def slope(self) -> Array:
        """Largest slope of each wave, 2 pi A / lambda."""
        return np.asarray(2.0 * np.pi * self.amplitude / self.wavelength)

    @property
    def cutoff_wavelength(self) -> float:
        """Shortest wavelength of the roughness the waves represent [m]."""
        return float(self.wavelength[-1]) if self.cut_off is None else self.cut_off

    @property
    def rms_slope(self) -> float:
        """Root mean square slope of all waves together, sqrt(sum (2 pi A / lambda)^2 / 2)."""
        return float(np.sqrt(0.5 * np.sum(self.slope**2)))

    def height_difference(self, lag: ArrayLike) -> Array:
        """Return C_z [m^2] of the waves at lags [m]: sum A^2 (1 - cos(2 pi l / lambda))."""
        lags = checks.vector("lag", lag, unit="m")
        # 1 - cos(2a) = 2 sin(a)^2, which keeps its digits at small lags.
        half_phase = np.pi * lags[:, None] / self.wavelength
        return np.asarray(2.0 * np.sin(half_phase) ** 2 @ self.amplitude**2)


def _factor(name: str, lengths: Array, argument: float | None) -> float | None:
    """Return the common ratio of neighbours, checked against a stated one; None if it varies."""
    if lengths.size == 1:
        return argument
    ratios = lengths[:-1] / lengths[1:]
    mean = float(np.exp(np.log(ratios).mean()))
    factor = argument or mean
    if float(np.abs(ratios / factor - 1.0).max()) <= _GEOMETRIC_TOLERANCE:
        return factor
    if argument is None:
        return None
    raise InputError(
        f"{name} must be the ratio of neighbouring waves within {_GEOMETRIC_TOLERANCE:g}; "
        f"got {argument:g} for a mean ratio of {mean:g}"
    )


FIRST_WAVELENGTH, FIRST_AMPLITUDE, S_WAVELENGTH, S_AMPLITUDE = range(4)
FACTOR_RANGE = (1.5, 30.0)  # smallest and largest magnification of wavelength tried
AMPLITUDE_FACTOR_RANGE = (1.02, 60.0)  # smallest and largest magnification of amplitude tried
_NEAR = 1e-5  # tolerance of the fits of all starts, of which the closest goes on to 1e-11
_PLATEAU_COUNTED = 4.0  # largest lag that counts by default, in lags at which the plateau begins


@dataclass(frozen=True, eq=False)
class TargetCurve:
    """The curve to match: lags [m], C_z [m^2], and its plateau [m^2]."""

    lag: Array
    value: Array
    plateau: float

    @classmethod
    def of(
        cls, hdc: HeightDifference, smallest: float, largest: float | None, unknowns: int
    ) -> TargetCurve:
        """Return the part of a curve from the smallest to the largest lag [m] that counts."""
        require_positive(hdc)
        plateau = find_plateau(hdc)
        if largest is None:
            largest = float(hdc.lag[-1]) if plateau is None else _PLATEAU_COUNTED * plateau.lag
        low = checks.positive("smallest_lag", smallest, unit="m") * (1.0 - 1e-9)
        high = checks.positive("largest_lag", largest, unit="m") * (1.0 + 1e-9)
        used = (hdc.lag >= low) & (hdc.lag <= high)
        if used.sum() < max(unknowns, 1):
            raise InputError(
                "the height difference correlation must have at least "
                f"{max(unknowns, 1)} lags to fit {unknowns} unknowns; got "
                f"{used.sum()} from {low:g} m to {high:g} m"
            )
        highest = float(hdc.value[used].max())
        level = highest if plateau is None else min(plateau.level, highest)
        return cls(hdc.lag[used], hdc.value[used], level)

    @cached_property
    def weight(self) -> Array:
        """Roots of the weights of the squared residuals, decades of lag counting alike."""
        weight = log_weights(self.lag)
        return np.asarray(np.sqrt(weight / weight.sum()))

    @property
    def reach(self) -> float:
        """First lag [m] at which the curve is at half its plateau."""
        return float(self.lag[np.argmax(self.value >= 0.5 * self.plateau)])


@dataclass(frozen=True, eq=False)
class WaveTrial:
    """Fixed values of the four logarithms (NaN where free) and constraints on the others."""

    fixed: Array
    waves: int
    single_factor: bool = False
    last: float | None = None  # log of a wavelength at the end, which determines s_wavelength
    beyond: float = 0.0  # factors s_wavelength between the last wave and that wavelength
    shorter: int = 0  # waves below the last one that the curve holds and the stack leaves out
    first_range: tuple[float, float] | None = None  # limits of the first wavelength's log

    @property
    def steps(self) -> float:
        """Factors s_wavelength from the first wave to `last`."""
        return self.waves - 1 + self.beyond

    @property
    def free(self) -> list[int]:
        """Indices of the logarithms to search for."""
        tied = {S_WAVELENGTH, S_AMPLITUDE} if self.waves == 1 else set()
        tied |= {S_AMPLITUDE} if self.single_factor else set()
        tied |= {S_WAVELENGTH} if self.last is not None else set()
        return [i for i in range(4) if np.isnan(self.fixed[i]) and i not in tied]

    def fill(self, unknowns: Array) -> Array:
        """Return all four logarithms from the free ones."""
        p = self.fixed.copy()
        p[self.free] = unknowns
        if self.waves == 1:
            p[2:] = np.where(np.isnan(p[2:]), 0.0, p[2:])
        elif self.last is not None:
            p[S_WAVELENGTH] = (p[FIRST_WAVELENGTH] - self.last) / self.steps
        if self.single_factor:
            p[S_AMPLITUDE] = p[S_WAVELENGTH]
        return p

    def bounds(self, target: TargetCurve) -> tuple[Array, Array]:
        """Return limits of the free logarithms."""
        limits = np.log(
            [
                (2.0 * target.lag[0], 400.0 * target.lag[-1]),
                (1e-3 * np.sqrt(target.value.min()), 1e3 * np.sqrt(target.value.max())),
                FACTOR_RANGE,
                AMPLITUDE_FACTOR_RANGE,
            ]
        )
        if self.first_range is not None:
            limits[FIRST_WAVELENGTH] = self.first_range
        if self.last is not None:
            spans = self.last + self.steps * np.log(FACTOR_RANGE)
            low, high = limits[FIRST_WAVELENGTH]
            limits[FIRST_WAVELENGTH] = max(low, spans[0]), min(high, spans[1])
        return limits[self.free, 0], limits[self.free, 1]

    def starts(self, target: TargetCurve) -> list[Array]:
        """Return a grid of starts: first wavelengths, last wavelengths, and Hurst exponents."""
        starts = []
        for first, last, hurst in product((2.5, 4.0, 6.5, 10.0, 16.0), (1.0, 3.0, 9.0), (0.6, 0.9)):
            p = self.fixed.copy()
            if np.isnan(p[FIRST_WAVELENGTH]):
                p[FIRST_WAVELENGTH] = np.log(first * target.reach)
            if np.isnan(p[S_WAVELENGTH]):
                decades = p[FIRST_WAVELENGTH] - np.log(last * target.lag[0])
                p[S_WAVELENGTH] = np.clip(decades / max(self.waves - 1, 1), *np.log(FACTOR_RANGE))
            if np.isnan(p[S_AMPLITUDE]):
                p[S_AMPLITUDE] = hurst * p[S_WAVELENGTH]
            if np.isnan(p[FIRST_AMPLITUDE]):
                # The plateau is sum A_i^2, nearly the whole geometric series A_1^2/(1 - 1/s_A^2).
                share = 1.0 - np.exp(-2.0 * max(p[S_AMPLITUDE], 0.02))
                p[FIRST_AMPLITUDE] = 0.5 * np.log(target.plateau * share)
            starts.append(p[self.free])
        return starts


@dataclass(frozen=True, eq=False)
class ClosestWaves:
    """The closest waves: their four logarithms, number, and rms residual in decades."""

    logs: Array
    waves: int
    residual: float

    @property
    def last(self) -> float:
        """Logarithm of the smallest wavelength."""
        return float(self.logs[FIRST_WAVELENGTH] - (self.waves - 1) * self.logs[S_WAVELENGTH])

    def stack(self, lag_range: tuple[float, float], beyond: float) -> SineStack:
        """Return the waves; the roughness ends `beyond` factors below the last of them."""
        order = np.arange(self.waves)
        first_wavelength, first_amplitude, s_wavelength, s_amplitude = self.logs
        end = first_wavelength - (order[-1] + beyond) * s_wavelength
        return SineStack(
            wavelength=np.exp(first_wavelength - order * s_wavelength),
            amplitude=np.exp(first_amplitude - order * s_amplitude),
            s_wavelength=float(np.exp(s_wavelength)) if self.waves > 1 else None,
            s_amplitude=float(np.exp(s_amplitude)) if self.waves > 1 else None,
            residual=self.residual,
            lag_range=lag_range,
            cut_off=float(np.exp(end)) if beyond else None,
        )


def fitted_curve(logs: Array, waves: int, lag: Array) -> Array:
    """Return C_z [m^2] at lags [m], the first wave by its mean beyond a quarter wavelength."""
    order = np.arange(waves)
    limits = np.log(checks.LEAST), np.log(checks.MOST)  # beyond them squares are not finite
    wavelength = np.exp(np.clip(logs[FIRST_WAVELENGTH] - order * logs[S_WAVELENGTH], *limits))
    amplitude = np.exp(np.clip(logs[FIRST_AMPLITUDE] - order * logs[S_AMPLITUDE], *limits))
    turns = lag[:, None] / wavelength
    turns[:, 0] = np.minimum(turns[:, 0], 0.25)
    return np.asarray(2.0 * np.sin(np.pi * turns) ** 2 @ amplitude**2)


def search(target: TargetCurve, trial: WaveTrial, refined: int = 10) -> ClosestWaves | None:
    """Return the closest waves, refining the best `refined` starts; None if limits exclude all."""
    from scipy.optimize import least_squares

    target_logs = np.log10(target.value)

    def residuals(unknowns: Array) -> Array:
        curve = fitted_curve(trial.fill(unknowns), trial.waves + trial.shorter, target.lag)
        return np.asarray(target.weight * (np.log10(np.maximum(curve, 1e-300)) - target_logs))

    def distance(unknowns: Array) -> float:
        return float(np.linalg.norm(residuals(unknowns)))

    if not trial.free:
        return ClosestWaves(trial.fill(np.zeros(0)), trial.waves, distance(np.zeros(0)))
    low, high = trial.bounds(target)
    if (low >= high).any():
        return None
    grid = trial.starts(target)
    if S_AMPLITUDE in trial.free and np.isnan(trial.fixed[S_WAVELENGTH]):
        # two factors must not do worse than one factor for both lengths
        tied = search(target, replace(trial, single_factor=True), refined)
        grid += [] if tied is None else [tied.logs[trial.free]]
    starts = sorted((np.clip(q, low, high) for q in grid), key=distance)[:refined]
    refine = partial(least_squares, residuals, bounds=(low, high), gtol=1e-11)
    near = [
        refine(q, xtol=_NEAR, ftol=_NEAR)
        for q in dict.fromkeys(tuple(q) for q in starts)  # fixed values make starts equal
    ]
    closest = refine(min(near, key=lambda fit: float(fit.cost)).x, xtol=1e-11, ftol=1e-11)
    return ClosestWaves(trial.fill(closest.x), trial.waves, float(np.sqrt(2.0 * closest.cost)))
