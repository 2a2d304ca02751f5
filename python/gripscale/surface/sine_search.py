"""Search for the sine waves closest to a curve: least squares from many fixed starts.

The unknowns are natural logarithms of the first wavelength and amplitude and of the two
magnification factors; each may be given, and the factors may be tied to each other or to a
smallest wavelength. Starts are a fixed grid, so that equal input gives equal output.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from gripscale import checks
from gripscale.surface.plateau import log_weights
from gripscale.surface.profile import FloatArray

FIRST_WAVELENGTH, FIRST_AMPLITUDE, S_WAVELENGTH, S_AMPLITUDE = range(4)

FACTOR_RANGE = (1.5, 30.0)
"""Smallest and largest magnification of wavelength tried."""

AMPLITUDE_FACTOR_RANGE = (1.02, 60.0)
"""Smallest and largest magnification of amplitude tried."""


@dataclass(frozen=True, eq=False)
class Target:
    """The curve to match: lags [m], C_z [m^2], and the plateau [m^2] it goes to."""

    lag: FloatArray
    value: FloatArray
    plateau: float
    weight: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        weight = log_weights(self.lag)
        object.__setattr__(self, "weight", np.sqrt(weight / weight.sum()))

    @property
    def reach(self) -> float:
        """First lag [m] at which the curve is at half its plateau."""
        return float(self.lag[np.argmax(self.value >= 0.5 * self.plateau)])


@dataclass(frozen=True, eq=False)
class Trial:
    """What is given of the four logarithms (NaN where free), and how the others are tied."""

    given: FloatArray
    waves: int
    single_factor: bool = False
    last: float | None = None  # log of a wavelength at the end, from which s_wavelength follows
    beyond: float = 0.0  # how many factors s_wavelength it lies below the last wave
    shorter: int = 0  # waves below the last one that the curve holds and the stack leaves out
    first_range: tuple[float, float] | None = None  # limits of the first wavelength's log

    @property
    def steps(self) -> float:
        """Factors s_wavelength from the first wave to `last`."""
        return self.waves - 1 + self.beyond

    @property
    def free(self) -> list[int]:
        """Which of the four are searched for."""
        tied = {S_WAVELENGTH, S_AMPLITUDE} if self.waves == 1 else set()
        tied |= {S_AMPLITUDE} if self.single_factor else set()
        tied |= {S_WAVELENGTH} if self.last is not None else set()
        return [i for i in range(4) if np.isnan(self.given[i]) and i not in tied]

    def fill(self, unknowns: FloatArray) -> FloatArray:
        """Return all four logarithms from the free ones."""
        p = self.given.copy()
        p[self.free] = unknowns
        if self.waves == 1:
            p[2:] = np.where(np.isnan(p[2:]), 0.0, p[2:])
        elif self.last is not None:
            p[S_WAVELENGTH] = (p[FIRST_WAVELENGTH] - self.last) / self.steps
        if self.single_factor:
            p[S_AMPLITUDE] = p[S_WAVELENGTH]
        return p

    def bounds(self, target: Target) -> tuple[FloatArray, FloatArray]:
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


@dataclass(frozen=True, eq=False)
class Found:
    """The closest waves: their four logarithms, number, and rms residual in decades."""

    logs: FloatArray
    waves: int
    residual: float

    @property
    def last(self) -> float:
        """Logarithm of the smallest wavelength."""
        return float(self.logs[FIRST_WAVELENGTH] - (self.waves - 1) * self.logs[S_WAVELENGTH])


def fitted_curve(logs: FloatArray, waves: int, lag: FloatArray) -> FloatArray:
    """Return C_z [m^2] at lags [m], the first wave by its mean beyond a quarter wavelength."""
    order = np.arange(waves)
    wavelength = _size(logs[FIRST_WAVELENGTH] - order * logs[S_WAVELENGTH])
    amplitude = _size(logs[FIRST_AMPLITUDE] - order * logs[S_AMPLITUDE])
    turns = lag[:, None] / wavelength
    turns[:, 0] = np.minimum(turns[:, 0], 0.25)
    return np.asarray(2.0 * np.sin(np.pi * turns) ** 2 @ amplitude**2)


def _size(log: FloatArray) -> FloatArray:
    """Return the length of a logarithm; one beyond reason is kept where its square is finite."""
    return np.asarray(np.exp(np.clip(log, np.log(checks.LEAST), np.log(checks.MOST))))


def search(target: Target, trial: Trial, refined: int = 10) -> Found | None:
    """Return the closest waves, refining the best `refined` starts; None if limits exclude all."""
    from scipy.optimize import least_squares

    logs_wanted = np.log10(target.value)

    def residuals(unknowns: FloatArray) -> FloatArray:
        curve = fitted_curve(trial.fill(unknowns), trial.waves + trial.shorter, target.lag)
        return np.asarray(target.weight * (np.log10(np.maximum(curve, 1e-300)) - logs_wanted))

    def distance(unknowns: FloatArray) -> float:
        return float(np.linalg.norm(residuals(unknowns)))

    if not trial.free:
        return Found(trial.fill(np.zeros(0)), trial.waves, distance(np.zeros(0)))
    low, high = trial.bounds(target)
    if (low >= high).any():
        return None
    grid = _starts(target, trial) + _tied_start(target, trial, refined)
    starts = sorted((np.clip(q, low, high) for q in grid), key=distance)[:refined]
    fits = [
        least_squares(residuals, q, bounds=(low, high), xtol=1e-11, ftol=1e-11, gtol=1e-11)
        for q in dict.fromkeys(tuple(q) for q in starts)  # what is given makes starts equal
    ]
    closest = min(fits, key=lambda fit: float(fit.cost))
    return Found(trial.fill(closest.x), trial.waves, float(np.sqrt(2.0 * closest.cost)))


def _tied_start(target: Target, trial: Trial, refined: int) -> list[FloatArray]:
    """Return the solution with one factor for both lengths: two factors must not do worse."""
    if S_AMPLITUDE not in trial.free or not np.isnan(trial.given[S_WAVELENGTH]):
        return []
    tied = search(target, replace(trial, single_factor=True), refined)
    return [] if tied is None else [tied.logs[trial.free]]


def _starts(target: Target, trial: Trial) -> list[FloatArray]:
    """Return a grid of starts: first wavelengths, last wavelengths, and Hurst exponents."""
    starts = []
    for first, last, hurst in product((2.5, 4.0, 6.5, 10.0, 16.0), (1.0, 3.0, 9.0), (0.6, 0.9)):
        p = trial.given.copy()
        if np.isnan(p[FIRST_WAVELENGTH]):
            p[FIRST_WAVELENGTH] = np.log(first * target.reach)
        if np.isnan(p[S_WAVELENGTH]):
            decades = p[FIRST_WAVELENGTH] - np.log(last * target.lag[0])
            p[S_WAVELENGTH] = np.clip(decades / max(trial.waves - 1, 1), *np.log(FACTOR_RANGE))
        if np.isnan(p[S_AMPLITUDE]):
            p[S_AMPLITUDE] = hurst * p[S_WAVELENGTH]
        if np.isnan(p[FIRST_AMPLITUDE]):
            # The plateau is sum A_i^2, nearly the whole geometric series A_1^2 / (1 - 1/s_A^2).
            share = 1.0 - np.exp(-2.0 * max(p[S_AMPLITUDE], 0.02))
            p[FIRST_AMPLITUDE] = 0.5 * np.log(target.plateau * share)
        starts.append(p[trial.free])
    return starts
