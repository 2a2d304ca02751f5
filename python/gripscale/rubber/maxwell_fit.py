"""The linear least-squares problem behind a Prony fit: non-negative moduli on given times.

Minimise over E_inf > 0, E_i >= 0, with E_inf + sum E_i <= largest modulus,

    sum_rows w^2 [(E'_fit/E' - 1)^2 + weight^2 (E''_fit/E'' - 1)^2]
        + smoothing^2 sum_i (second diff. of h_i)^2 + shrinkage^2 sum_(slow i) h_i^2

where h_i = E_i / m(1/tau_i), m the measured E', continued beyond an end with the slope of E''
there. Sources: M. Baumgaertel & H. H. Winter, Rheol. Acta 28 (1989) 511, doi:10.1007/BF01332922;
J. Honerkamp & J. Weese, Continuum Mech. Thermodyn. 2 (1990) 17, doi:10.1007/BF01170953. Why so, how
the number of terms is chosen, and which rows are outliers is in docs/derivations.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from gripscale.core import Array, Mask, checks
from gripscale.rubber.admissible import AdmissibleSeries, loss_shape, storage_shape
from gripscale.rubber.material import Rubber

# E_inf is at least this share of the lowest storage modulus: a melt has none, a rubber must.
_LEAST_EQUILIBRIUM = 1e-3
# Weight of the limit on E_inf + sum E_i: kept to 1e-5 of it against rows of weight one.
_LIMIT_WEIGHT = 300.0
# Decades between relaxation times beyond the band, where the data resolve no more.
_LEAST_SPACING = 0.5
_FEWEST_FOR_SLOPE = 5


@dataclass(frozen=True)
class MaxwellSpectrum:
    """Moduli [Pa] on relaxation times [s]: E_inf, E_i and tau_i."""

    equilibrium: float
    moduli: Array
    times: Array

    def storage(self, omega: Array) -> Array:
        """Return E' [Pa] at `omega` [rad/s]."""
        return self.equilibrium + storage_shape(np.outer(omega, self.times)) @ self.moduli

    def loss(self, omega: Array) -> Array:
        """Return E'' [Pa] at `omega` [rad/s]."""
        return np.asarray(loss_shape(np.outer(omega, self.times)) @ self.moduli)

    def ratios(self, curve: Curve) -> tuple[Array, Array]:
        """Return E' and E'' over those of the rows of a curve [-]."""
        return self.storage(curve.omega) / curve.storage, self.loss(curve.omega) / curve.loss


@dataclass(frozen=True)
class Curve:
    """Rows of a master curve: `omega` [rad/s] ascending, `storage` and `loss` [Pa]."""

    omega: Array
    storage: Array
    loss: Array

    def rows(self, chosen: Mask) -> Curve:
        """Return the chosen rows."""
        return Curve(self.omega[chosen], self.storage[chosen], self.loss[chosen])

    def end_slope(self, end: int) -> float:
        """Return the slope of ln E'' over the first (0) or last (-1) decade, at most 1 in size."""
        position = np.log(self.omega)
        away = np.abs(position - position[end])
        near = away <= math.log(10.0)
        near[np.argsort(away, kind="stable")[:_FEWEST_FOR_SLOPE]] = True
        run = position[near] - position[near].mean()
        square = float(run @ run)
        slope = float(run @ np.log(self.loss)[near]) / square if square > 0.0 else 0.0
        return min(max(slope, -1.0), 1.0)


@dataclass(frozen=True)
class Prior:
    """What is known beside the rows, and how much each of their moduli weighs."""

    smoothing: float
    shrinkage: float
    largest_modulus: float  # upper limit of E_inf + sum E_i [Pa]
    storage_weight: Array | float = 1.0
    loss_weight: Array | float = 1.0


@dataclass(frozen=True)
class Equations:
    """Rows `matrix` z = `right` of the fit, z >= 0: E_inf above its floor, h_i, the slack."""

    matrix: Array
    right: Array
    floor: float
    unit: float
    scale: Array
    times: Array

    def squares(self, solution: Array) -> float:
        """Return the sum of squares of a solution."""
        error = self.matrix @ solution - self.right
        return float(error @ error)

    def spectrum(self, solution: Array) -> MaxwellSpectrum:
        """Return the moduli a solution stands for."""
        equilibrium = self.floor + self.unit * float(solution[0])
        return MaxwellSpectrum(equilibrium, solution[1:-1] * self.scale, self.times)


def relaxation_times(omega: Array, terms: int, beyond: float) -> Array:
    """Return log-spaced times [s]: `terms` in the band of `omega` and others `beyond` [decades]."""
    low, high = -math.log10(omega.max()), -math.log10(omega.min())
    if terms == 1:
        return np.array([10.0 ** (0.5 * (low + high))])
    spacing = max((high - low) / (terms - 1), _LEAST_SPACING)
    outside = spacing * np.arange(1, round(beyond / spacing) + 1)
    inside = np.linspace(low, high, terms)
    return np.asarray(10.0 ** np.concatenate([low - outside[::-1], inside, high + outside]))


def fit_spectrum(curve: Curve, times: Array, prior: Prior) -> MaxwellSpectrum:
    """Return the best non-negative moduli on the given `times` [s]."""
    problem = fit_equations(curve, times, prior)
    return problem.spectrum(non_negative(problem.matrix, problem.right))


@dataclass(frozen=True)
class FitProblem:
    """What a series was fitted to, and with which weight of each row [-]."""

    rows: Curve
    times: Array
    prior: Prior
    row_weight: Array | float = 1.0

    def applied_to(self, rubber: Rubber) -> Rubber:
        """Return a rubber with the fitted series; the admissible ones stay those of the rows."""
        prior = self.prior
        storage, loss = (self.row_weight * w for w in (prior.storage_weight, prior.loss_weight))
        prior = replace(prior, storage_weight=storage, loss_weight=loss)
        admissible = rubber.admissible and replace(rubber.admissible, belongs_to="")
        return with_series(rubber, fit_spectrum(self.rows, self.times, prior), admissible)


def with_series(
    rubber: Rubber, spectrum: MaxwellSpectrum, admissible: AdmissibleSeries | None = None
) -> Rubber:
    """Return `rubber` with another series and what else fits, without elements of no weight."""
    present = spectrum.moduli > 1e-9 * spectrum.moduli.sum()
    return replace(
        rubber,
        equilibrium_modulus=spectrum.equilibrium,
        moduli=spectrum.moduli[present],
        relaxation_times=spectrum.times[present],
        admissible=admissible,
    )


def non_negative(matrix: Array, right: Array) -> Array:
    """Return the z >= 0 that minimises |matrix z - right|."""
    from scipy.optimize import nnls

    solution, _ = nnls(matrix, right, maxiter=100 * matrix.shape[1])
    return np.asarray(solution)


def fit_equations(curve: Curve, times: Array, prior: Prior) -> Equations:
    """Return the least-squares problem of a fit to `curve` on the given `times` [s]."""
    floor, unit = _LEAST_EQUILIBRIUM * float(curve.storage.min()), float(curve.storage.min())
    # m(w) at w = 1/tau: E' in the band, beyond it with the slope of E''
    measured, position = np.log(curve.omega), -np.log(times)
    below, above = np.minimum(position - measured[0], 0.0), np.maximum(position - measured[-1], 0.0)
    beyond = np.exp(curve.end_slope(0) * below + curve.end_slope(-1) * above)
    expected = np.interp(position, measured, curve.storage) * beyond
    scale = np.minimum(expected, prior.largest_modulus)
    nothing = np.zeros((len(curve.omega), 1))
    phase = np.outer(curve.omega, times)
    storage = np.hstack([nothing + unit, storage_shape(phase) * scale, nothing])
    loss = np.hstack([nothing, loss_shape(phase) * scale, nothing])
    limit = np.concatenate([[unit], scale, [prior.largest_modulus]]) / prior.largest_modulus
    slow = position < measured[0] - 1e-9
    # Second differences within the data, shrinkage beyond the slow end; E_inf and slack are free.
    terms = len(times)
    shrinking = np.eye(terms, terms + 2, 1)
    differences = np.diff(shrinking, 2, axis=0)[~slow[2:]]
    penalties = np.vstack([prior.smoothing * differences, prior.shrinkage * shrinking[slow]])
    matrix = np.vstack(
        [
            storage * (prior.storage_weight / curve.storage)[:, None],
            loss * (prior.loss_weight / curve.loss)[:, None],
            penalties,
            _LIMIT_WEIGHT * limit,
        ]
    )
    right = np.concatenate(
        [
            prior.storage_weight * (1.0 - floor / curve.storage),
            np.full(len(curve.loss), prior.loss_weight),
            np.zeros(len(penalties)),
            [_LIMIT_WEIGHT * (1.0 - floor / prior.largest_modulus)],
        ]
    )
    return Equations(matrix, right, floor, unit, scale, times)


_PER_DECADE = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
_LEAST_PER_DECADE = 1.25
_FOLDS = 5
_MOST_TERMS = 60
_SHARP_PER_DECADE = 16.0
_SHARP_SMOOTHING = 1e-2  # over that of the other candidates
# Its misfit over that of the best other one, from which on it is tried. Measured rubbers have 0.9.
_SHARP_GAIN = 0.75


@dataclass(frozen=True)
class Candidate:
    """A number of terms and what cross-validation says of it."""

    terms: int
    error: float
    """Root mean square relative error at rows held out [-]."""
    standard_error: float


def prior_for(terms: int, curve: Curve, prior: Prior) -> Prior:
    """Return the prior of a fit with so many relaxation times: very many are hardly smoothed."""
    if terms < _sharp(curve):
        return prior
    smoothing, shrinkage = (_SHARP_SMOOTHING * x for x in (prior.smoothing, prior.shrinkage))
    return replace(prior, smoothing=smoothing, shrinkage=shrinkage)


def _sharp(curve: Curve) -> int:
    return round(_SHARP_PER_DECADE * float(np.log10(curve.omega.max() / curve.omega.min()))) + 1


def choose_terms(
    curve: Curve, fit: Callable[[Curve, int], MaxwellSpectrum]
) -> tuple[int, tuple[Candidate, ...]]:
    """Return the number of terms and all candidates, from a `fit` to rows with so many terms."""
    decades = float(np.log10(curve.omega.max() / curve.omega.min()))
    numbers = [max(1, round(decades * density) + 1) for density in _PER_DECADE]
    least = max(1, round(decades * _LEAST_PER_DECADE) + 1)
    if len(curve.omega) < 2 * _FOLDS:
        return min(least, len(curve.omega)), ()
    fold = np.arange(len(curve.omega)) % _FOLDS
    candidates: list[Candidate] = []
    for terms in [*sorted({min(number, _MOST_TERMS) for number in numbers}), _sharp(curve)]:
        if terms == _sharp(curve):
            missed = math.sqrt(_squares(fit(curve, terms), curve).mean())
            if missed > _SHARP_GAIN * min(each.error for each in candidates):
                break
        squares = np.empty(len(fold))
        for held_out in range(_FOLDS):
            out = fold == held_out
            squares[out] = _squares(fit(curve.rows(~out), terms), curve.rows(out))
        error = float(np.sqrt(squares.mean()))
        most = max(float(squares.max()), np.finfo(float).tiny)  # its square may overflow
        spread = most * float((squares / most).std(ddof=1) / np.sqrt(len(squares)))
        candidates.append(Candidate(terms, error, 0.5 * spread / error if error > 0.0 else 0.0))
    best = min(candidates, key=lambda each: each.error)
    limit, fewest = best.error + best.standard_error, min(least, _MOST_TERMS)
    good = [each.terms for each in candidates if each.terms >= fewest and each.error <= limit]
    return min(good, default=best.terms), tuple(candidates)


def _squares(spectrum: MaxwellSpectrum, curve: Curve) -> Array:
    """Return the mean square relative error of both moduli of each row."""
    storage, loss = spectrum.ratios(curve)
    return np.asarray(0.5 * (storage - 1.0) ** 2 + 0.5 * (loss - 1.0) ** 2)


_NEIGHBOURS = 8
_PASSES = 10
LEAST_SCATTER = 0.02  # scatter below this (2 %, a good laboratory) is not believed
_FEWEST_ROWS = _NEIGHBOURS + 3


@dataclass(frozen=True)
class Screening:
    """Which rows are kept, and how the data scatter."""

    kept: Mask
    storage_scatter: float  # robust relative scatter of E' about its local trend [-]
    loss_scatter: float

    @property
    def believed_scatter(self) -> tuple[float, float]:
        """Scatter of E' and E'' [-], at least what a good laboratory has."""
        return max(self.storage_scatter, LEAST_SCATTER), max(self.loss_scatter, LEAST_SCATTER)


def screen_outliers(curve: Curve, times: Array, prior: Prior, threshold: float) -> Screening:
    """Return which rows belong to `curve`, beside Maxwell fits on the given `times` [s]."""
    kept = np.ones(len(curve.omega), dtype=bool)
    position = np.log(curve.omega)
    measured = np.log([curve.storage, curve.loss])
    for _ in range(_PASSES):
        spectrum = fit_spectrum(curve.rows(kept), times, prior)
        # A fit may have no loss at all where it is far off.
        fitted = [spectrum.storage(curve.omega), spectrum.loss(curve.omega)]
        relative = measured - np.log(np.maximum(fitted, checks.LEAST))
        raw = [_deviation(position, values, kept) for values in measured]
        smoothed = [_deviation(position, values, kept) for values in relative]
        scores = [
            np.minimum(*(np.abs(part) / max(_spread(part[kept]), LEAST_SCATTER) for part in both))
            for both in zip(raw, smoothed, strict=True)
        ]
        new = np.maximum(*scores) <= threshold
        if len(kept) < _FEWEST_ROWS or new.sum() < _FEWEST_ROWS or (new == kept).all():
            break
        kept = new
    return Screening(kept, *(_spread(deviation[kept]) for deviation in raw))


def _deviation(position: Array, value: Array, kept: Mask) -> Array:
    """Return each value minus the straight line through its nearest kept neighbours."""
    members, rows = np.flatnonzero(kept), np.arange(len(value))
    # Half of the neighbours on each side, more where one side ends.
    split, others = np.searchsorted(members, rows), members.size - kept
    start = np.clip(split - _NEIGHBOURS // 2, 0, np.maximum(others - _NEIGHBOURS, 0))
    order = start[:, None] + np.arange(min(_NEIGHBOURS, int(others.min())))
    near = members[order + (kept[:, None] & (order >= split[:, None]))]  # without the row itself
    run, rise = position[near] - position[:, None], value[near]
    across = run[:, :, None] - run[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = (rise[:, :, None] - rise[:, None]) / across
    slopes = np.sort(np.where(across > 0.0, slopes, np.nan).reshape(len(rows), -1))
    pairs = (across > 0.0).sum(axis=(1, 2))  # none where all frequencies are the same
    middle = [slopes[rows, np.maximum(at, 0) // 2] for at in (pairs - 1, pairs)]
    slope = np.where(pairs > 0, 0.5 * (middle[0] + middle[1]), 0.0)
    return np.asarray(value - np.median(rise - slope[:, None] * run, axis=1))


def _spread(deviation: Array) -> float:
    return float(1.4826 * np.median(np.abs(deviation)))
