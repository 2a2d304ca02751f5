"""How many Maxwell elements a master curve supports, by cross-validation.

Five folds, each holding out every fifth row; the error is the relative error of E' and E'' at the
rows held out. Taken is the smallest number within one standard error of the best (T. Hastie,
R. Tibshirani, J. Friedman, The Elements of Statistical Learning, 2nd ed. 2009, sec. 7.10), but not
fewer than 1.25 per decade: for a smooth spectrum, elements log-spaced by d (in natural logarithm)
make E'' ripple by 2 sech(pi^2/d), 6 % at one per decade and 2 % at 1.25 per decade (first Fourier
coefficient of the periodic sum of sech).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber.maxwell_fit import Spectrum

Array = NDArray[np.float64]

_PER_DECADE = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
_LEAST_PER_DECADE = 1.25
_FOLDS = 5
_MOST_TERMS = 60


@dataclass(frozen=True)
class Candidate:
    """A number of terms and what cross-validation says of it."""

    terms: int
    error: float
    """Root mean square relative error at rows held out [-]."""
    standard_error: float


def choose_terms(
    omega: Array,
    storage: Array,
    loss: Array,
    fit: Callable[[NDArray[np.bool_], int], Spectrum],
) -> tuple[int, tuple[Candidate, ...]]:
    """Return the number of terms and all candidates tried.

    `fit` is the Maxwell fit to a choice of rows with a number of terms; `omega` [rad/s], `storage`
    and `loss` [Pa] have shape (rows,).
    """
    decades = float(np.log10(omega.max() / omega.min()))
    numbers = sorted({min(_terms(decades, density), _MOST_TERMS) for density in _PER_DECADE})
    if len(omega) < 2 * _FOLDS:
        return min(_terms(decades, _LEAST_PER_DECADE), len(omega)), ()
    candidates = tuple(_cross_validate(omega, storage, loss, fit, n) for n in numbers)
    best = min(candidates, key=lambda candidate: candidate.error)
    least = min(_terms(decades, _LEAST_PER_DECADE), _MOST_TERMS)
    good = [
        candidate.terms
        for candidate in candidates
        if candidate.terms >= least and candidate.error <= best.error + best.standard_error
    ]
    return min(good, default=best.terms), candidates


def _terms(decades: float, density: float) -> int:
    return max(1, round(decades * density) + 1)


def _cross_validate(
    omega: Array,
    storage: Array,
    loss: Array,
    fit: Callable[[NDArray[np.bool_], int], Spectrum],
    terms: int,
) -> Candidate:
    fold = np.arange(len(omega)) % _FOLDS
    squares = np.empty(len(omega))
    for held_out in range(_FOLDS):
        out = fold == held_out
        spectrum = fit(~out, terms)
        squares[out] = 0.5 * (spectrum.storage(omega[out]) / storage[out] - 1.0) ** 2
        squares[out] += 0.5 * (spectrum.loss(omega[out]) / loss[out] - 1.0) ** 2
    error = float(np.sqrt(squares.mean()))
    most = max(float(squares.max()), np.finfo(float).tiny)  # its square may overflow
    spread = most * float((squares / most).std(ddof=1) / np.sqrt(len(squares)))
    return Candidate(terms, error, 0.5 * spread / error if error > 0.0 else 0.0)
