"""Fit sine waves whose height difference correlation matches a measured one.

Wave i has lambda_{i+1} = lambda_i / s_lambda and A_{i+1} = A_i / s_A; the unknowns are the first
wave (lambda_1, A_1) and the two factors. The fit minimises the rms difference of log10 C_z, decades
of lag counting alike (Lind & Wangenheim, ASME IMECE2014-37998). A road does not repeat: beyond a
quarter of its length the first wave enters by its mean over phases,

    C_fit(l) = A_1^2 g(l / lambda_1) + sum_{i > 1} A_i^2 (1 - cos(2 pi l / lambda_i)),
    g(u) = 1 - cos(2 pi u) for u < 1/4, else 1.

docs/derivations.md says which lags count, where a stack ends, and which stacks are as good.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gripscale.core import Array, InputError, Quantity, checks
from gripscale.surface.height_difference import HeightDifference, log_weights
from gripscale.surface.sines import (
    FACTOR_RANGE,
    FIRST_WAVELENGTH,
    S_WAVELENGTH,
    ClosestWaves,
    SineStack,
    TargetCurve,
    WaveTrial,
    search,
)

MOST_SINE_WAVES = 24  # waves beyond which a stack is refused
_NUMBERS = range(2, MOST_SINE_WAVES + 1)  # numbers of waves tried where none is stated


# C_z(m l) / (m^2 C_z(l)) above which lag l is inconsistent; sampling may exceed 1 a little.
_CONSISTENT = 1.05
_CUT_OFF_COUNTED = 0.25  # smallest lag that counts by default, in wavelengths of the cut-off
# Waves below a cut-off that count in the fit: factors of 2 take them below the lags that count.
_SHORTER_WAVES = 3
_AS_GOOD = 1.1  # ratio of a residual to the least one up to which fewer waves are preferred


def fit_sines(
    hdc: HeightDifference,
    *,
    scales: int | None = None,
    smallest_wavelength: Quantity | None = None,
    cut_off: float | None = None,
    s_wavelength: float | None = None,
    s_amplitude: float | None = None,
    first_wavelength: Quantity | None = None,
    first_amplitude: Quantity | None = None,
    single_factor: bool = False,
    smallest_lag: Quantity | None = None,
    largest_lag: Quantity | None = None,
) -> SineStack:
    """Fit superposed sine waves to a height difference correlation.

    Raises `InputError` if an argument is wrong, `scales`, `smallest_wavelength` and `cut_off` are
    all missing, or the curve has too few positive values in the range of lags.

        >>> gs.fit_sines(gs.height_difference(road), scales=4).wavelength.size
        4

    Parameters
    ----------
    scales : int, optional
        Number of waves, 1 to 24. At least one of `scales`, `smallest_wavelength` and `cut_off` is
        needed. With `scales` alone, no wave lies below `hdc.resolution_limit` if that is known
        and s_wavelength is not given.
    smallest_wavelength : float, optional
        Wavelength of the last wave [m], which may lie below what was measured. Given with
        `scales`, s_wavelength follows from it. Alone, the number of waves with the least residual
        is taken (of numbers as good within 10 %, the smallest). Where s_wavelength is given too,
        the last wave is the smallest one not below `smallest_wavelength`.
    cut_off : float, optional
        Shortest wavelength of the roughness the waves represent [m], in place of
        `smallest_wavelength`: the last wave is cut_off sqrt(s_wavelength).
    s_wavelength, s_amplitude : float, optional
        Magnification factors, both above 1, to fix them.
    first_wavelength, first_amplitude : float, optional
        The first wave [m], to fix it.
    single_factor : bool, optional
        One factor for both lengths, the comparison Lind & Wangenheim show to fail.
    smallest_lag, largest_lag : float, optional
        Range of lags that count [m]; see the top of this file for the defaults.
    """
    if scales is None and smallest_wavelength is None and cut_off is None:
        raise InputError("scales, smallest_wavelength or cut_off must be given; got none of them")
    if smallest_wavelength is not None and cut_off is not None:
        raise InputError(
            "give smallest_wavelength (the last wave) or cut_off (where the roughness ends); "
            f"got {smallest_wavelength:g} m and {cut_off:g} m"
        )
    checks.instance("hdc", hdc, HeightDifference)
    checks.flag("single_factor", single_factor)
    fixed = _fixed_logs(
        {
            "first_wavelength": first_wavelength,
            "first_amplitude": first_amplitude,
            "s_wavelength": s_wavelength,
            "s_amplitude": s_amplitude,
        },
        single_factor,
    )
    end = None
    if cut_off is not None:
        end = _End.of("cut_off", cut_off, 0.5)
    elif smallest_wavelength is not None:
        end = _End.of("smallest_wavelength", smallest_wavelength, 0.0)
    if end is not None and end.log >= fixed[FIRST_WAVELENGTH]:
        raise InputError(
            f"{end.name} must be below first_wavelength; got {np.exp(end.log):g} m "
            f"against {np.exp(fixed[FIRST_WAVELENGTH]):g} m"
        )
    if smallest_lag is None:
        smallest_lag = max(first_consistent_lag(hdc), _CUT_OFF_COUNTED * (cut_off or 0.0))
    target = TargetCurve.of(hdc, smallest_lag, largest_lag, int(np.isnan(fixed).sum()))
    if end is None:
        waves = checks.whole("scales", scales, least=1, most=MOST_SINE_WAVES)
        trial = WaveTrial(fixed, waves, single_factor)
        solution = search(target, trial)
        limit = -np.inf if hdc.resolution_limit is None else float(np.log(hdc.resolution_limit))
        free = waves > 1 and np.isnan(fixed[S_WAVELENGTH])
        unresolved = solution is not None and solution.last < limit
        if unresolved and free and not fixed[FIRST_WAVELENGTH] <= limit:
            solution = search(target, replace(trial, last=limit))
    elif not np.isnan(fixed[S_WAVELENGTH]):
        if scales is not None:
            raise InputError(f"give two of scales, {end.name} and s_wavelength; got three")
        solution = _search_with_factor(target, fixed, single_factor, end)
    elif scales is not None:
        waves = checks.whole("scales", scales, least=2, most=MOST_SINE_WAVES)
        solution = search(target, end.trial(fixed, waves, single_factor))
    else:
        first, trials = float(fixed[FIRST_WAVELENGTH]), []
        for waves in _NUMBERS:
            low, high = (end.spans(float(np.log(f)))[waves - 1][0] for f in FACTOR_RANGE)
            if np.isnan(first) or low <= first <= high:
                trials.append(end.trial(fixed, waves, single_factor))
        solution = _closest(target, trials, _AS_GOOD)
    if solution is None:
        raise InputError(
            "no sine waves fit the given number, factors and wavelengths: s_wavelength must lie "
            f"between {FACTOR_RANGE[0]:g} and {FACTOR_RANGE[1]:g}, and the first wavelength "
            f"between {2 * target.lag[0]:.3g} m and {400 * target.lag[-1]:.3g} m"
        )
    lag_range = float(target.lag[0]), float(target.lag[-1])
    return solution.stack(lag_range, 0.0 if end is None else end.beyond)


def as_fitted(sines: SineStack) -> SineStack:
    """Return the waves that count in a fit to C_z: with a cut-off these include shorter ones."""
    if sines.cut_off is None or sines.s_wavelength is None or sines.s_amplitude is None:
        return sines
    order = np.arange(1, _SHORTER_WAVES + 1)
    return replace(
        sines,
        wavelength=np.append(sines.wavelength, sines.wavelength[-1] / sines.s_wavelength**order),
        amplitude=np.append(sines.amplitude, sines.amplitude[-1] / sines.s_amplitude**order),
        cut_off=None,
    )


@dataclass(frozen=True)
class _End:
    """End of a stack: log of a wavelength, and the number of factors from the last wave to it."""

    name: str
    log: float
    beyond: float

    @classmethod
    def of(cls, name: str, length: float, beyond: float) -> _End:
        return cls(name, float(np.log(checks.positive(name, length, unit="m"))), beyond)

    @property
    def shorter(self) -> int:
        """Waves that the measured curve holds beyond the end."""
        return _SHORTER_WAVES if self.beyond > 0.0 else 0

    def trial(self, fixed: Array, waves: int, single_factor: bool) -> WaveTrial:
        """Return the search for `waves` waves down to the end."""
        return WaveTrial(fixed, waves, single_factor, self.log, self.beyond, shorter=self.shorter)

    def spans(self, factor: float) -> list[tuple[float, float]]:
        """Return logs of the first wavelength at which 1, 2, ... waves reach the end."""
        number = np.arange(1, MOST_SINE_WAVES + 2)
        logs = self.log + (number - 1 + self.beyond) * factor
        return list(pairwise(logs))


def _fixed_logs(values: dict[str, float | None], single_factor: bool) -> Array:
    """Return logarithms of the stated unknowns, NaN for the others."""
    logs = np.full(4, np.nan)
    for at, (name, value) in enumerate(values.items()):
        if value is None:
            continue
        logs[at] = np.log(checks.positive(name, value, unit="" if name.startswith("s_") else "m"))
        if at >= S_WAVELENGTH and logs[at] <= 0.0:
            raise InputError(f"{name} must be greater than 1; got {value:g}")
    factors = logs[S_WAVELENGTH:]
    if single_factor and not np.isnan(factors).all():
        if np.nanmin(factors) != np.nanmax(factors):
            raise InputError(
                "s_wavelength and s_amplitude must be equal where single_factor is set; got "
                f"{values['s_wavelength']} and {values['s_amplitude']}"
            )
        logs[S_WAVELENGTH:] = np.nanmin(factors)
    return logs


def first_consistent_lag(hdc: HeightDifference) -> float:
    """Return the first lag l with C_z(m l) <= m^2 C_z(l) for all whole m measured [m]."""
    for lag, value in zip(hdc.lag, hdc.value, strict=True):
        ratio = hdc.lag / lag
        multiple = (ratio > 1.5) & (np.abs(ratio - np.rint(ratio)) < 1e-6 * ratio)
        if (hdc.value[multiple] <= _CONSISTENT * ratio[multiple] ** 2 * value).all():
            return float(lag)
    return float(hdc.lag[0])  # not reached: the last lag has no multiples


def _search_with_factor(
    target: TargetCurve, fixed: Array, single_factor: bool, end: _End
) -> ClosestWaves | None:
    factor, first = float(fixed[S_WAVELENGTH]), float(fixed[FIRST_WAVELENGTH])
    if not np.isnan(first):
        waves = 1 + int((first - end.log) / factor - end.beyond + 1e-9)
        if waves > MOST_SINE_WAVES:
            raise InputError(
                f"{end.name} must need at most {MOST_SINE_WAVES} waves; "
                f"{np.exp(end.log):g} m needs {waves}"
            )
        return search(target, WaveTrial(fixed, waves, single_factor, shorter=end.shorter))
    trials = [
        WaveTrial(fixed, n, single_factor, first_range=span, shorter=end.shorter)
        for n, span in enumerate(end.spans(factor), start=1)
    ]
    return _closest(target, trials, 1.0)


def _closest(target: TargetCurve, trials: list[WaveTrial], as_good: float) -> ClosestWaves | None:
    """Return the trial with the fewest waves among those as good as the best."""
    solved = [(search(target, trial, refined=2), trial) for trial in trials]
    residuals = [(s.residual, trial) for s, trial in solved if s is not None]
    if not residuals:
        return None
    limit = as_good * min(residual for residual, _ in residuals)
    good = [trial for residual, trial in residuals if residual <= limit]
    return search(target, min(good, key=lambda trial: trial.waves))


_AMBIGUITY_WAVES = range(2, 13)  # numbers of waves tried for the range of stacks
_FIRST_WAVELENGTHS = np.geomspace(0.5, 2.0, 9)  # first wavelengths tried, over the fitted one


class Span(NamedTuple):
    """Smallest and largest of a quantity."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class SineAmbiguity:
    """The stacks that follow C_z within its uncertainty."""

    tried: int
    """Stacks tried."""
    band: float
    """Rms half width of the band of 95 % nominal confidence of C_z [decades]; 0 if not known."""
    stacks: tuple[SineStack, ...] = field(repr=False)
    """The stacks that are as good as the best."""

    @property
    def waves(self) -> Span:
        """Fewest and most waves."""
        return self._span(len)

    @property
    def s_wavelength(self) -> Span:
        """Smallest and largest magnification factor of wavelength."""
        return self._span(lambda stack: stack.wavelength[0] / stack.wavelength[1])

    @property
    def first_wavelength(self) -> Span:
        """Smallest and largest first wavelength [m]."""
        return self._span(lambda stack: stack.wavelength[0])

    @property
    def rms_slope(self) -> Span:
        """Smallest and largest rms slope of all waves together [-], on which friction depends."""
        return self._span(lambda stack: stack.rms_slope)

    def _span(self, quantity: Callable[[SineStack], float]) -> Span:
        values = [float(quantity(stack)) for stack in self.stacks]
        return Span(min(values), max(values))


def sine_ambiguity(hdc: HeightDifference, sines: SineStack) -> SineAmbiguity:
    """Return the other stacks that follow `hdc` within the uncertainty that its band states.

    The waves fitted to it, `sines`, fix the range of lags, the first wavelength, and the cut-off or
    the last wavelength. Raises `InputError` if they are one wave, or were not fitted.
    """
    if sines.lag_range is None or len(sines) < 2:
        raise InputError(
            "sines must be two waves or more, fitted to hdc; got "
            f"{len(sines)}, {'not fitted' if sines.lag_range is None else 'fitted'}"
        )
    smallest_lag, largest_lag = sines.lag_range
    end = sines.cutoff_wavelength
    residuals, stacks = [], []
    for waves in _AMBIGUITY_WAVES:
        steps = waves - 1 if sines.cut_off is None else waves - 0.5
        for first in _FIRST_WAVELENGTHS * float(sines.wavelength[0]):
            if not FACTOR_RANGE[0] <= (first / end) ** (1.0 / steps) <= FACTOR_RANGE[1]:
                continue
            stack = fit_sines(
                hdc,
                scales=waves,
                first_wavelength=float(first),
                smallest_wavelength=end if sines.cut_off is None else None,
                cut_off=sines.cut_off,
                smallest_lag=smallest_lag,
                largest_lag=largest_lag,
            )
            residuals.append(math.inf if stack.residual is None else stack.residual)
            stacks.append(stack)
    band = 0.0
    used = (hdc.lag >= smallest_lag) & (hdc.lag <= largest_lag) & np.isfinite(hdc.upper)
    if used.any():
        half = np.log10(hdc.upper[used] / hdc.value[used])
        band = float(np.sqrt(np.average(half**2, weights=log_weights(hdc.lag[used]))))
    limit = math.hypot(min(residuals), band)
    good = (stack for stack, r in zip(stacks, residuals, strict=True) if r <= limit)
    return SineAmbiguity(len(stacks), band, tuple(good))
