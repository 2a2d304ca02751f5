"""What matters most: the share of the variance of an answer that each source explains.

The first-order Sobol index (I. M. Sobol, Math. Comput. Simul. 55 (2001) 271,
doi:10.1016/S0378-4754(00)00270-6) of y, the logarithm of friction or contact fraction, from samples
that vary all sources at once: one least-squares fit, without what it explains by chance
(docs/derivations.md). Errors are those of the jackknife for independent samples.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gripscale.core.arrays import Array

# Standard errors by which a share must exceed zero: 95 %, one side.
SIGNIFICANCE = 1.645
SAMPLES_PER_TERM = 3  # samples there must be for each term of the fit


class Shares(NamedTuple):
    """Shares of the variance of an answer, source by source; arrays of shape (sources,)."""

    share: Array
    """S_k [-]; below zero by chance."""
    error: Array
    """Their standard errors [-]."""


def shares(answer: Array, coordinates: Mapping[str, Array]) -> Shares | None:
    """Return the shares of the sources in an answer, or None where it cannot tell.

    None if there are fewer than three samples for each term, an answer is not above zero, or all
    are equal.

    Parameters
    ----------
    answer : array, shape (samples,)
        Above zero. Samples that are NaN do not count.
    coordinates : mapping
        Of each source, shape (samples, numbers): logarithms.
    """
    valid = np.isfinite(answer)
    if not valid.any() or not coordinates:
        return None
    blocks = [_terms(values[valid]) for values in coordinates.values()]
    widths = [block.shape[1] for block in blocks]
    y = answer[valid]
    if len(y) < SAMPLES_PER_TERM * (1 + sum(widths)) or not (y > 0.0).all() or np.ptp(y) == 0.0:
        return None
    y = np.log(y)
    matrix, ends = np.hstack(blocks), np.cumsum([0, *widths])
    variances = _fit(matrix, y, ends)
    rest = np.arange(len(y))
    others = np.array([_fit(matrix[rest != i], y[rest != i], ends) for i in rest])
    others = (others / others.sum(axis=1, keepdims=True))[:, :-1]
    away = others - others.mean(axis=0)
    covariance = (len(y) - 1) / len(y) * away.T @ away
    return Shares(variances[:-1] / variances.sum(), np.sqrt(np.diag(covariance)))


def _terms(values: Array) -> Array:
    """Return the terms of one source, each of mean zero and variance one; none if it is fixed."""
    values = values[:, np.ptp(values, axis=0) > 0.0]
    if values.shape[1] == 1:
        column = _standard(values)
        values = np.hstack([column, column**2]) if len(np.unique(column)) > 2 else column
    return _standard(values)


def _standard(values: Array) -> Array:
    return np.asarray((values - values.mean(axis=0)) / values.std(axis=0))


def _fit(matrix: Array, y: Array, ends: NDArray[np.intp]) -> Array:
    """Return the variances V_k, last that of the rest."""
    centred, about = matrix - matrix.mean(axis=0), y - y.mean()
    inverse = np.linalg.pinv(centred.T @ centred)
    factors = inverse @ (centred.T @ about)
    free = len(y) - 1 - matrix.shape[1]
    noise = float(np.sum((about - centred @ factors) ** 2)) / free
    parts, by_chance = np.zeros((len(y), len(ends) - 1)), np.zeros(len(ends) - 1)
    for k, (first, end) in enumerate(pairwise(ends)):
        columns = centred[:, first:end]
        parts[:, k] = columns @ factors[first:end]
        by_chance[k] = np.sum(inverse[first:end, first:end] * (columns.T @ columns)) / len(y)
    return np.append(parts.var(axis=0) - noise * by_chance, noise)
