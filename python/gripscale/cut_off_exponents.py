"""How much a prediction changes with the smallest wavelength that counts.

    d ln(A_r/A_0) / d ln(lambda_min),    d ln(mu) / d ln(lambda_min)

by the difference over the last octave: ln(mu(lambda_min) / mu(2 lambda_min)) / ln(1/2). Negative
where shorter waves add: at -0.3 half the wavelength means 2^0.3 = 1.23 times the friction. Where
waves are further apart than an octave, ln A and mu are taken to be linear in ln(lambda) between
them: areas multiply from wave to wave, frictions add.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

OCTAVE = 2.0
"""Ratio of the wavelengths that are compared, where there are waves so far apart."""


@dataclass(frozen=True)
class CutOffExponents:
    """Logarithmic derivatives by the cut-off length, over its last octave; NaN if not known."""

    contact_fraction: float
    """d ln(A_r/A_0) / d ln(cut-off) [-]."""
    friction: float
    """d ln(friction coefficient) / d ln(cut-off) [-]."""
    why_not: str = ""
    """Why one of them is not known; empty if both are."""


AT_REST = "no friction at rest"
NO_AREA = "the model does not tell the contact area by wavelength"
NO_SLIDING = "friction not above zero"
NOT_TOLD = CutOffExponents(math.nan, math.nan, "the model does not tell it")
"""Of a model that answers for one cut-off only."""
NOT_CONVERGED = CutOffExponents(math.nan, math.nan, "not converged")


def between(
    ratio: float, contact_fraction: Sequence[float], friction: Sequence[float], *, moving: bool
) -> CutOffExponents:
    """Return the exponents from two solutions.

    Parameters
    ----------
    ratio : float
        Cut-off of the first over that of the second, above 1.
    contact_fraction, friction : two float
        Of both solutions [-]; NaN where not known.
    moving : bool
        Whether it slides.
    """
    area, mu = (_exponent(ratio, *pair) for pair in (contact_fraction, friction))
    mu = mu if moving else math.nan
    reasons = [
        NO_AREA if math.isnan(area) else "",
        AT_REST if not moving else "",
        NO_SLIDING if math.isnan(mu) else "",
    ]
    return CutOffExponents(area, mu, next(filter(None, reasons), ""))


def of_curve(
    wavelength: ArrayLike, contact_fraction: ArrayLike, friction: ArrayLike, *, moving: bool
) -> CutOffExponents:
    """Return the exponents of a model that tells area and friction down to each wavelength.

    Parameters
    ----------
    wavelength : array_like, shape (n,)
        Falling [m]; only their ratios count. Less than an octave apart in all, all of them do.
    contact_fraction, friction : array_like, shape (n,)
        Of the waves not shorter [-].
    moving : bool
        Whether it slides.
    """
    lengths = np.asarray(wavelength, dtype=float)
    if lengths.size < 2:
        return CutOffExponents(math.nan, math.nan, "only one wave")
    ratio = min(OCTAVE, float(lengths[0] / lengths[-1]))
    area, mu = np.asarray(contact_fraction, dtype=float), np.asarray(friction, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        before = math.exp(_at(ratio, lengths, np.log(area)))
    return between(
        ratio, (before, float(area[-1])), (_at(ratio, lengths, mu), float(mu[-1])), moving=moving
    )


def of_mean(
    parts: Sequence[CutOffExponents], contact_fraction: ArrayLike, friction: ArrayLike
) -> CutOffExponents:
    """Return the exponents of a mean to which each of `parts` adds these numbers [-].

    d ln(sum x_i) = sum x_i d ln x_i / sum x_i.
    """
    if not parts:
        return NOT_TOLD
    area = _mean([one.contact_fraction for one in parts], contact_fraction)
    mu = _mean([one.friction for one in parts], friction)
    reasons = (one.why_not for one in parts if one.why_not)
    return CutOffExponents(area, mu, next(reasons, ""))


def _mean(values: Sequence[float], weight: ArrayLike) -> float:
    """Return the weighted mean, NaN where the weights add up to nothing."""
    each = np.asarray(weight, dtype=float)
    total = float(each.sum())
    return float(each @ np.asarray(values)) / total if total else math.nan


def _exponent(ratio: float, before: float, last: float) -> float:
    """Return ln(before/last) / ln(ratio), NaN unless both are above zero."""
    if not (before > 0.0 and last > 0.0):
        return math.nan
    return math.log(before / last) / math.log(ratio)


def _at(ratio: float, lengths: NDArray[np.float64], values: NDArray[np.float64]) -> float:
    """Return a value at `ratio` times the last wavelength, linear in the log of wavelength."""
    place = np.log(lengths[-1] * ratio)
    return float(np.interp(-place, -np.log(lengths), values))
