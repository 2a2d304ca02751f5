"""Intervals: relative errors of a product, and the half width that holds the truth 9 times in 10.

An answer is a product of positive numbers, each with the standard error s_i of its logarithm
and n_i degrees of freedom of that error. The errors are independent, so that

    s^2 = sum(s_i^2),    n = s^4 / sum(s_i^4 / n_i)

(Welch & Satterthwaite: B. L. Welch, Biometrika 34 (1947) 28). The interval at level L is
y exp(-t s) to y exp(t s), with t the (1 + L)/2 quantile of Student's t for n; its half width over y
is sinh(t s).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

LEVEL = 0.9  # share of cases in which an interval holds the truth
UPPER_LIMITS = {"contact_fraction": 1.0}  # upper limits of numbers that have one


class LogError(NamedTuple):
    """Standard error of the logarithm of a number, and its degrees of freedom."""

    sigma: xr.DataArray  # [-]; NaN where it is not known
    freedom: xr.DataArray  # [-]; infinite where the error itself is certain


def combined(errors: Sequence[LogError]) -> LogError:
    """Return the error of a product of independent numbers; NaN if one of them is not known."""
    zero = xr.DataArray(0.0)
    variance = sum((error.sigma**2 for error in errors), zero)
    uncertain = sum(((error.sigma**4 / error.freedom).fillna(0.0) for error in errors), zero)
    freedom = (variance**2 / uncertain.where(uncertain > 0.0)).fillna(np.inf)
    return LogError(variance**0.5, freedom)


def half_width(error: LogError) -> xr.DataArray:
    """Return the half width of the interval of a number over the number; NaN if not known."""
    from scipy.special import stdtrit  # of scipy.stats, which takes half a second to import

    freedom = error.freedom.where(error.freedom >= 1.0)
    quantile = xr.apply_ufunc(lambda n: stdtrit(n, 0.5 * (1.0 + LEVEL)), freedom)
    width: xr.DataArray = quantile * error.sigma
    with np.errstate(over="ignore"):  # of a law far from where it holds
        return width.copy(data=np.sinh(width.values))


def interval_ends(
    value: xr.DataArray, half_width: xr.DataArray, most: float = math.inf
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return both ends of an interval of relative half width; NaN if it is not known.

    The upper is `most` at most: nothing is in contact with more than all of its area.
    """
    log = half_width.copy(data=np.arcsinh(half_width.values))
    return value * np.exp(-log), (value * np.exp(log)).clip(max=most)
