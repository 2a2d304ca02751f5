"""How a prediction changes with the smallest wavelength of the roughness that counts.

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
from numpy.typing import ArrayLike

from gripscale.core.arrays import Array

OCTAVE = 2.0  # ratio of the wavelengths that are compared, where there are waves so far apart


@dataclass(frozen=True)
class CutOffExponents:
    """Exponents of contact fraction and friction; NaN if not known."""

    contact_fraction: float  # d ln(A_r/A_0) / d ln(cut-off) [-]
    friction: float  # d ln(friction coefficient) / d ln(cut-off) [-]
    why_not: str = ""  # why one of them is not known; empty if both are


# Of a model that answers for one cut-off only.
NOT_TOLD = CutOffExponents(math.nan, math.nan, "the model does not tell it")
NOT_CONVERGED = CutOffExponents(math.nan, math.nan, "not converged")


def between(
    ratio: float, contact_fraction: Sequence[float], friction: Sequence[float], *, moving: bool
) -> CutOffExponents:
    """Return the exponents from two solutions, whose cut-offs have a `ratio` above 1.

    Both contact fractions and frictions [-] are NaN where not known.
    """
    area, mu = (
        math.log(before / last) / math.log(ratio) if before > 0.0 and last > 0.0 else math.nan
        for before, last in (contact_fraction, friction)
    )
    if math.isnan(area):
        why_not = "the model does not tell the contact area by wavelength"
    elif not moving:
        why_not = "no friction at rest"
    else:
        why_not = "friction not above zero" if math.isnan(mu) else ""
    return CutOffExponents(area, mu if moving else math.nan, why_not)


def of_curve(
    wavelength: ArrayLike, contact_fraction: ArrayLike, friction: ArrayLike, *, moving: bool
) -> CutOffExponents:
    """Return the exponents of a model that tells area and friction to each falling wavelength."""
    lengths = np.asarray(wavelength, dtype=float)
    if lengths.size < 2:
        return CutOffExponents(math.nan, math.nan, "only one wave")
    ratio = min(OCTAVE, float(lengths[0] / lengths[-1]))
    area, mu = np.asarray(contact_fraction, dtype=float), np.asarray(friction, dtype=float)
    # at `ratio` times the last wavelength
    logs, at = -np.log(lengths), -np.log(lengths[-1] * ratio)
    with np.errstate(divide="ignore", invalid="ignore"):
        before = math.exp(np.interp(at, logs, np.log(area)))
    frictions = float(np.interp(at, logs, mu)), float(mu[-1])
    return between(ratio, (before, float(area[-1])), frictions, moving=moving)


def of_mean(
    parts: Sequence[CutOffExponents], contact_fraction: ArrayLike, friction: ArrayLike
) -> CutOffExponents:
    """Return the exponents of a mean to which each of `parts` adds these numbers [-].

    d ln(sum x_i) = sum x_i d ln x_i / sum x_i, NaN where the numbers add up to nothing.
    """
    if not parts:
        return NOT_TOLD
    area, mu = (
        _mean([getattr(part, name) for part in parts], np.asarray(added, dtype=float))
        for name, added in (("contact_fraction", contact_fraction), ("friction", friction))
    )
    return CutOffExponents(area, mu, next((part.why_not for part in parts if part.why_not), ""))


def _mean(values: Sequence[float], weight: Array) -> float:
    total = float(weight.sum())
    return float(weight @ np.asarray(values)) / total if total else math.nan
