"""Fit sine waves whose height difference correlation matches a measured one.

Wave i has lambda_{i+1} = lambda_i / s_lambda and A_{i+1} = A_i / s_A; the unknowns are the first
wave (lambda_1, A_1) and the two factors. The fit minimises the rms difference of log10 C_z, decades
of lag counting alike (Lind & Wangenheim, ASME IMECE2014-37998). Which lags count, and how:

**Large lags.** C_z of a sine falls back to zero at each whole wavelength. A road does not repeat:
its long waves fill a band of wavelengths and its C_z stays on the plateau, twice the variance of
the heights. So beyond lambda_1 / 4 the first wave enters the fit by its mean over phases, A_1^2,
the value it reaches there:

    C_fit(l) = A_1^2 g(l / lambda_1) + sum_{i > 1} A_i^2 (1 - cos(2 pi l / lambda_i)),
    g(u) = 1 - cos(2 pi u) for u < 1/4, else 1.

The waves then carry the variance of the road, about sum A_i^2 / 2. (Following the cosine to its
top at lambda_1 / 2 instead would halve the variance of the first wave.) Lags up to four times the
one where the plateau begins count: without them a first wave several times too large fits the rise
as well, and at still larger lags C_z scatters for want of independent heights. To fit the curve of
a few pure sines, which does fall back, give `largest_lag` = lambda_1 / 4.

The first wave rises as l^2, faster than a rough surface, which makes the amplitudes of the smaller
waves fall faster: of profiles of exponent H, log s_A / log s_lambda comes out 0.04 above H = 0.8,
0.13 above 0.9 and 0.24 above 0.95, so that they matter little there (docs/method.md, sec. 1).

**Small lags.** Any profile has |z(x + m l) - z(x)| <= the sum of its m differences over l, hence
C_z(m l) <= m^2 C_z(l). Spike removal marks both points of steep neighbours as missing, so steep
flanks count at lags that span the gap but not at smaller ones: C_z then breaks this rule, and no
sum of waves can follow. Lags before the first one that keeps the rule do not count by default.

**The end of the stack.** Each wave represents a band of wavelengths, from its own over
sqrt(s_lambda) to its own times sqrt(s_lambda). A last wave of the wavelength l therefore brings in
roughness down to l / sqrt(s_lambda), and the slope of the stack is larger than that of a profile
without the waves shorter than l. `cut_off` states where the roughness ends: the last wave is then
cut_off sqrt(s_lambda). The measured C_z holds the shorter waves too, so that three more of them, by
the same factors, count in the fit and are left out of the stack. Lags below cut_off / 4, which they
decide, do not count. Where s_wavelength is given, whole waves end at cut_off or above it: the stack
holds its own cut-off. `smallest_wavelength` states the last wave itself, as Lind & Wangenheim do.

**The search.** The unknowns are natural logarithms of the first wavelength and amplitude and of the
two magnification factors; each may be fixed, and the factors may be tied to each other or to a
smallest wavelength. Least squares start from a fixed grid, so that equal input gives equal output.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise, product

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.surface.height_difference import (
    HeightDifference,
    find_plateau,
    log_weights,
    require_positive,
)
from gripscale.surface.sines import SineStack

FIRST_WAVELENGTH, FIRST_AMPLITUDE, S_WAVELENGTH, S_AMPLITUDE = range(4)

FACTOR_RANGE = (1.5, 30.0)
"""Smallest and largest magnification of wavelength tried."""

AMPLITUDE_FACTOR_RANGE = (1.02, 60.0)
"""Smallest and largest magnification of amplitude tried."""


@dataclass(frozen=True, eq=False)
class Target:
    """The curve to match: lags [m], C_z [m^2], and its plateau [m^2]."""

    lag: Array
    value: Array
    plateau: float

    @classmethod
    def of(
        cls, hdc: HeightDifference, smallest: float, largest: float | None, unknowns: int
    ) -> Target:
        """Return the part of a curve from the smallest to the largest lag [m] that counts."""
        require_positive(hdc)
        plateau = find_plateau(hdc)
        if largest is None:
            largest = float(hdc.lag[-1]) if plateau is None else PLATEAU_COUNTED * plateau.lag
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
class Trial:
    """The fixed ones of the four logarithms (NaN where free), and the ties of the others."""

    fixed: Array
    waves: int
    single_factor: bool = False
    last: float | None = None  # log of a wavelength at the end, which determines s_wavelength
    beyond: float = 0.0  # how many factors s_wavelength it lies below the last wave
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

    def bounds(self, target: Target) -> tuple[Array, Array]:
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

    def starts(self, target: Target) -> list[Array]:
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
class Solution:
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


def search(target: Target, trial: Trial, refined: int = 10) -> Solution | None:
    """Return the closest waves, refining the best `refined` starts; None if limits exclude all."""
    from scipy.optimize import least_squares

    target_logs = np.log10(target.value)

    def residuals(unknowns: Array) -> Array:
        curve = fitted_curve(trial.fill(unknowns), trial.waves + trial.shorter, target.lag)
        return np.asarray(target.weight * (np.log10(np.maximum(curve, 1e-300)) - target_logs))

    def distance(unknowns: Array) -> float:
        return float(np.linalg.norm(residuals(unknowns)))

    if not trial.free:
        return Solution(trial.fill(np.zeros(0)), trial.waves, distance(np.zeros(0)))
    low, high = trial.bounds(target)
    if (low >= high).any():
        return None
    grid = trial.starts(target)
    if S_AMPLITUDE in trial.free and np.isnan(trial.fixed[S_WAVELENGTH]):
        # two factors must not do worse than one factor for both lengths
        tied = search(target, replace(trial, single_factor=True), refined)
        grid += [] if tied is None else [tied.logs[trial.free]]
    starts = sorted((np.clip(q, low, high) for q in grid), key=distance)[:refined]
    fits = [
        least_squares(residuals, q, bounds=(low, high), xtol=1e-11, ftol=1e-11, gtol=1e-11)
        for q in dict.fromkeys(tuple(q) for q in starts)  # fixed values make starts equal
    ]
    closest = min(fits, key=lambda fit: float(fit.cost))
    return Solution(trial.fill(closest.x), trial.waves, float(np.sqrt(2.0 * closest.cost)))


MOST_WAVES = 24
"""Waves beyond which a stack is refused."""

NUMBERS = range(2, MOST_WAVES + 1)
"""Numbers of waves tried where none is stated."""

PLATEAU_COUNTED = 4.0
"""Largest lag that counts by default, in lags at which the plateau begins."""

CONSISTENT = 1.05
"""C_z(m l) / (m^2 C_z(l)) above which lag l is inconsistent; sampling may exceed 1 a little."""

CUT_OFF_COUNTED = 0.25
"""Smallest lag that counts by default, in wavelengths of the cut-off."""

SHORTER_WAVES = 3
"""Waves below a cut-off that count in the fit: factors of 2 take them below the lags that count."""

AS_GOOD = 1.1
"""Ratio of a residual to the least one up to which fewer waves are preferred."""


def fit_sines(
    hdc: HeightDifference,
    *,
    scales: int | None = None,
    smallest_wavelength: float | None = None,
    cut_off: float | None = None,
    s_wavelength: float | None = None,
    s_amplitude: float | None = None,
    first_wavelength: float | None = None,
    first_amplitude: float | None = None,
    single_factor: bool = False,
    smallest_lag: float | None = None,
    largest_lag: float | None = None,
) -> SineStack:
    """Fit superposed sine waves to a height difference correlation.

    Raises `InputError` if an argument is wrong, `scales`, `smallest_wavelength` and `cut_off` are
    all missing, or the curve has too few positive values in the range of lags.

    Parameters
    ----------
    hdc : HeightDifference
        The measured curve.
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
        smallest_lag = max(first_consistent_lag(hdc), CUT_OFF_COUNTED * (cut_off or 0.0))
    target = Target.of(hdc, smallest_lag, largest_lag, int(np.isnan(fixed).sum()))
    if end is None:
        waves = checks.whole("scales", scales, least=1, most=MOST_WAVES)
        trial = Trial(fixed, waves, single_factor)
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
        waves = checks.whole("scales", scales, least=2, most=MOST_WAVES)
        solution = search(target, end.trial(fixed, waves, single_factor))
    else:
        first, trials = float(fixed[FIRST_WAVELENGTH]), []
        for waves in NUMBERS:
            low, high = (end.spans(float(np.log(f)))[waves - 1][0] for f in FACTOR_RANGE)
            if np.isnan(first) or low <= first <= high:
                trials.append(end.trial(fixed, waves, single_factor))
        solution = _closest(target, trials, AS_GOOD)
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
    order = np.arange(1, SHORTER_WAVES + 1)
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
        return SHORTER_WAVES if self.beyond > 0.0 else 0

    def trial(self, fixed: Array, waves: int, single_factor: bool) -> Trial:
        """Return the search for `waves` waves down to the end."""
        return Trial(fixed, waves, single_factor, self.log, self.beyond, shorter=self.shorter)

    def spans(self, factor: float) -> list[tuple[float, float]]:
        """Return logs of the first wavelength at which 1, 2, ... waves reach the end."""
        number = np.arange(1, MOST_WAVES + 2)
        logs = self.log + (number - 1 + self.beyond) * factor
        return list(pairwise(logs))


def _fixed_logs(values: dict[str, float | None], single_factor: bool) -> Array:
    """Return logs of the stated ones of the four unknowns, NaN for the others."""
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
    """Return the first lag l with C_z(m l) <= m^2 C_z(l) for all whole m measured [m].

    That C_z keeps this rule follows from the triangle inequality for root mean squares.
    """
    for lag, value in zip(hdc.lag, hdc.value, strict=True):
        ratio = hdc.lag / lag
        multiple = (ratio > 1.5) & (np.abs(ratio - np.rint(ratio)) < 1e-6 * ratio)
        if (hdc.value[multiple] <= CONSISTENT * ratio[multiple] ** 2 * value).all():
            return float(lag)
    return float(hdc.lag[0])  # not reached: the last lag has no multiples


def _search_with_factor(
    target: Target, fixed: Array, single_factor: bool, end: _End
) -> Solution | None:
    """Search with s_wavelength fixed: as many waves as fit above the end."""
    factor, first = float(fixed[S_WAVELENGTH]), float(fixed[FIRST_WAVELENGTH])
    if not np.isnan(first):
        waves = 1 + int((first - end.log) / factor - end.beyond + 1e-9)
        if waves > MOST_WAVES:
            raise InputError(
                f"{end.name} must need at most {MOST_WAVES} waves; "
                f"{np.exp(end.log):g} m needs {waves}"
            )
        return search(target, Trial(fixed, waves, single_factor, shorter=end.shorter))
    trials = [
        Trial(fixed, n, single_factor, first_range=span, shorter=end.shorter)
        for n, span in enumerate(end.spans(factor), start=1)
    ]
    return _closest(target, trials, 1.0)


def _closest(target: Target, trials: list[Trial], as_good: float) -> Solution | None:
    """Return the closest of all trials; of those as good, that with the fewest waves."""
    solved = [(search(target, trial, refined=2), trial) for trial in trials]
    residuals = [(s.residual, trial) for s, trial in solved if s is not None]
    if not residuals:
        return None
    limit = as_good * min(residual for residual, _ in residuals)
    good = [trial for residual, trial in residuals if residual <= limit]
    return search(target, min(good, key=lambda trial: trial.waves))
