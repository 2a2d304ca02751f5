"""All sweeps onto one smooth curve at once, with the uncertainty of every shift.

Rows of sweep g are y_k + v_g = F_k(x + s_g) + scatter, with s = log10 a_T, v = log10 b_T and one
spline F_k a modulus: cubic B-splines with penalised second differences (P. H. C. Eilers & B. D.
Marx, Stat. Sci. 11 (1996) 89, doi:10.1214/ss/1038425655). s, v and the splines are the penalised
least squares of all rows together: Gauss-Newton in s and v, the splines eliminated (L. Kaufman, BIT
15 (1975) 49, doi:10.1007/BF01932995). What a row counts, the covariance, and the limit of steps
between neighbours are in docs/derivations.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.core.arrays import Array
from gripscale.rubber.sweeps import Sweeps

_DEGREE, _SPACING = 3, 0.5  # of the splines, and of their knots [decades]
_PENALTIES = tuple(10.0 ** np.arange(-2.0, 5.0))  # tried, over the mean trust of a row
# Penalty of the coefficients themselves, over the same: one row determines no straight line.
_RIDGE = 1e-9


def splines(x: Array) -> tuple[Array, Array, Array]:
    """Return values and slopes of B-splines at `x`, and second differences of their coefficients.

    The knots are at multiples of `_SPACING` and reach beyond `x`.
    """
    from scipy.interpolate import BSpline

    first, last = np.floor(x.min() / _SPACING), np.ceil(x.max() / _SPACING)
    if last - first < 1.0:
        last = first + 1.0
    knots = _SPACING * np.arange(first - _DEGREE, last + _DEGREE + 1.0)
    each = np.eye(len(knots) - _DEGREE - 1)
    curves = BSpline(knots, each, _DEGREE)
    values, slopes = (np.asarray(curves(x, nu=order, extrapolate=True)) for order in (0, 1))
    return values, slopes, np.diff(each, n=2, axis=0)


@dataclass(frozen=True)
class Smooth:
    """A fitted curve: coefficients, normal equations, penalty weight and effective freedoms."""

    coefficients: Array
    matrix: Array
    weight: float
    freedoms: float


def smooth(
    functions: Array, penalty: Array, values: Array, trust: Array, weight: float | None = None
) -> Smooth:
    """Return the curve through `values`, each counted `trust` times; the best `weight` if None."""
    normal = functions.T @ (trust[:, None] * functions)
    right = functions.T @ (trust * values)
    best, least = None, np.inf
    unit = float(trust.mean())
    ridge = _RIDGE * unit * np.eye(len(normal))
    for candidate in [unit * factor for factor in _PENALTIES] if weight is None else [weight]:
        matrix = np.asarray(normal + candidate * penalty.T @ penalty + ridge, dtype=np.float64)
        both = np.column_stack([right, normal])
        solved = np.asarray(np.linalg.solve(matrix, both), dtype=np.float64)
        freedoms = float(np.trace(solved[:, 1:]))
        error = values - functions @ solved[:, 0]
        remaining = max(float(trust.sum()) - freedoms, 1e-6)
        score = float(trust @ error**2) / remaining**2
        if score < least:
            least, best = score, Smooth(solved[:, 0], matrix, float(candidate), freedoms)
    assert best is not None
    return best


# What a shift may rest on. E''/E' is no third measurement beside E' and E''; alone it is what the
# shape of a specimen, a factor of both, does not change.
SHIFTED_MODULI = {
    "both": ("storage", "loss"),
    "storage": ("storage",),
    "loss": ("loss",),
    "loss_factor": ("loss_factor",),
}


@dataclass(frozen=True)
class Rows:
    """Decades of frequency and of each modulus, and the sweep of each row from the coldest."""

    x: Array  # log10 of the frequency over 1 Hz, shape (rows,)
    y: Array  # log10 of the moduli over 1 Pa, or of the loss factor, shape (moduli, rows)
    sweep: NDArray[np.intp]
    lifts: Array  # 1 for each modulus that b_T multiplies, 0 for the loss factor, shape (moduli,)

    @property
    def sweeps(self) -> int:
        """Number of sweeps."""
        return int(self.sweep[-1]) + 1

    def of(self, sweep: int) -> tuple[Array, Array]:
        """Return x and y of one sweep."""
        chosen = self.sweep == sweep
        return self.x[chosen], self.y[:, chosen]

    def step(
        self, shifts: Array, free: NDArray[np.intp], trust: Array, weights: tuple[float | None, ...]
    ) -> GaussNewtonStep:
        """Return the step of the free shifts; the splines are eliminated."""
        s, v = np.split(shifts, 2)
        functions, slopes, penalty = splines(self.x + s[self.sweep])
        # Neighbours are expected to have nearly the same log_b.
        apart = np.diff(np.eye(self.sweeps), axis=0) / _LIFT
        expected = np.zeros((2 * self.sweeps, 2 * self.sweeps))
        expected[self.sweeps :, self.sweeps :] = apart.T @ apart
        normal = _SOFT * np.eye(len(free)) + expected[np.ix_(free, free)]
        right = -(expected @ shifts)[free]
        residuals, curves, each = [], [], np.arange(len(self.x))
        for y, lift, count, weight in zip(self.y, self.lifts, trust, weights, strict=True):
            y = y + lift * v[self.sweep]
            curve = smooth(functions, penalty, y, count, weight)
            residual = y - functions @ curve.coefficients
            # Change of F_k - v with log_a and log_b of each sweep, shape (rows, 2 sweeps).
            by_shift = np.zeros((len(self.x), 2 * self.sweeps))
            by_shift[each, self.sweep] = slopes @ curve.coefficients
            by_shift[each, self.sweep + self.sweeps] = -lift
            by_shift = by_shift[:, free]
            cross = functions.T @ (count[:, None] * by_shift)
            solved = np.linalg.solve(curve.matrix, cross)
            normal += by_shift.T @ (count[:, None] * by_shift) - cross.T @ solved
            right += by_shift.T @ (count * residual) - solved.T @ (functions.T @ (count * residual))
            residuals.append(residual)
            curves.append(curve)
        inverse = np.asarray(np.linalg.pinv(normal, hermitian=True, rcond=1e-14), dtype=np.float64)
        freedoms = np.array([curve.freedoms for curve in curves]) + len(free) / len(curves)
        used = tuple(curve.weight for curve in curves)
        return GaussNewtonStep(inverse @ right, inverse, np.array(residuals), freedoms, used)

    def scatter(self, last: GaussNewtonStep, trust: Array) -> tuple[Array, Array]:
        """Return the scatter about each row and how far it is trusted, both like the residuals."""
        member = np.equal.outer(np.arange(self.sweeps), self.sweep).astype(float)
        near = np.abs(np.subtract.outer(np.arange(self.sweeps), np.arange(self.sweeps))) <= 1
        independent = np.maximum(1.0 - last.freedoms / len(self.x), 0.1)
        square = (trust * last.residual**2) @ member.T @ near / (trust @ member.T @ near)
        scatter = np.sqrt(square / independent[:, None])[:, self.sweep]
        scatter = np.maximum(scatter, _LEAST_SCATTER)
        return scatter, 1.0 / np.maximum(np.abs(last.residual) / (_FAR * scatter), 1.0)


@dataclass(frozen=True)
class GaussNewtonStep:
    """Changes of the free shifts with their covariance, and the residuals before them."""

    change: Array
    covariance: Array
    residual: Array
    freedoms: Array  # of each spline, and a share of the shifts, shape (moduli,)
    weights: tuple[float, ...]  # of the penalty of each spline over the scatter


def sweep_rows(sweeps: Sweeps, moduli: str) -> Rows:
    """Return the rows of `sweeps`, for the choice of `moduli` among `SHIFTED_MODULI`."""
    names = SHIFTED_MODULI[moduli]
    x = np.log10(sweeps.frequency)
    y = np.array([np.log10(getattr(sweeps, name)) for name in names])
    counts = [len(sweep) for sweep in sweeps]
    lifts = np.array([0.0 if name == "loss_factor" else 1.0 for name in names])
    return Rows(x, y, np.repeat(np.arange(len(counts)), counts), lifts)


_AT = 1e-9  # distance from a limit that is rounding [decades]
_MOST_ITERATIONS = 60
_FREE_PENALTY = 8  # iterations after which the weight of the penalty stays as it is
_LARGEST_STEP = 0.3  # by which a shift may change in an iteration [decades]
_CONVERGED = 1e-4
_FAR = 2.0  # standard deviations from which a row counts less
# Of a modulus [decades]: half a per cent, below which no laboratory repeats itself. With 1e-5 a
# pair that does not meet moved sweeps of exact moduli by decades.
_LEAST_SCATTER = 2e-3
_MOST_CORRELATED = 0.9
# How far log10 b_T of neighbours is expected apart [decades]; entropy and density say 0.01.
_LIFT = 0.02
_LEAST_SHARE = 0.1  # least overlap of neighbours, over the shorter of them
# Standard error of a step that is a bound [decades]: sweeps of 2.7 decades with a true step of 2.8
# were taken 0.4 decades too near.
_BOUND_ERROR = 1.0
# Weight that keeps a shift no row determines from being infinite: its error is 1000 decades.
_SOFT = 1e-6


@dataclass(frozen=True)
class Joint:
    """Shifts of all sweeps against the middle one."""

    log_a: Array
    log_b: Array
    covariance: Array  # of log_a, then log_b, shape (2 sweeps, 2 sweeps); zero for what is held
    # Of each modulus about the curve, in the median sweep [decades], shape (moduli,).
    scatter: Array


def align(rows: Rows, log_a: Array, log_b: Array, lifted: bool) -> Joint:
    """Return the best shifts near a start against the middle sweep; log_b only if `lifted`."""
    held = rows.sweeps // 2
    # limits of log_a of the colder less that of the warmer: neither may begin where the other ends
    ends = np.array([rows.of(sweep)[0][[0, -1]] for sweep in range(rows.sweeps)])
    least = _LEAST_SHARE * np.minimum(np.ptp(ends[1:], axis=1), np.ptp(ends[:-1], axis=1))
    low, high = ends[1:, 0] - ends[:-1, 1] + least, ends[1:, 1] - ends[:-1, 0] - least
    shifts = np.concatenate([log_a - log_a[held], log_b - log_b[held]])
    others = np.delete(np.arange(rows.sweeps, dtype=np.intp), held)
    free = np.concatenate([others, others + rows.sweeps]) if lifted else others
    trust = np.ones_like(rows.y)
    scatter = np.ones_like(rows.y)
    weights: tuple[float | None, ...] = (None,) * len(rows.y)
    for iteration in range(_MOST_ITERATIONS):
        last = rows.step(shifts, free, trust / scatter**2, weights)
        largest = float(np.abs(last.change).max(initial=0.0))
        shifts[free] += last.change * min(1.0, _LARGEST_STEP / max(largest, 1e-300))
        # no neighbours farther apart than where they hardly overlap
        steps = np.clip(-np.diff(shifts[: rows.sweeps]), low, high)
        total = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
        shifts[: rows.sweeps] = total - total[held]
        scatter, trust = rows.scatter(last, trust)
        if iteration >= _FREE_PENALTY:
            weights = last.weights
            if largest < _CONVERGED:
                break
    residual = np.sqrt(trust) * last.residual / scatter
    same = np.diff(rows.sweep) == 0
    r = 0.0
    if same.any():
        product = (residual[:, 1:] * residual[:, :-1])[:, same].mean(axis=1)
        r = float(np.mean(product / np.maximum((residual**2).mean(axis=1), 1e-30)))
    r = min(max(r, 0.0), _MOST_CORRELATED)
    covariance = np.zeros((2 * rows.sweeps, 2 * rows.sweeps))
    covariance[np.ix_(free, free)] = last.covariance * (1.0 + r) / (1.0 - r)
    log_a = shifts[: rows.sweeps]
    for colder in np.flatnonzero((-np.diff(log_a) <= low + _AT) | (-np.diff(log_a) >= high - _AT)):
        # all sweeps beyond the step, seen from the middle one
        beyond = others[(others <= colder) if colder < held else (others > colder)]
        covariance[np.ix_(beyond, beyond)] += _BOUND_ERROR**2
    return Joint(log_a, shifts[rows.sweeps :], covariance, np.median(scatter, axis=1))
