"""Numbers above zero with a relative uncertainty, multiplied and divided.

    y = y_1^(+-1) y_2^(+-1) ...,      sigma^2 = sigma_1^2 + sigma_2^2 + ...

with sigma the standard deviation of log y: products of independent log-normal numbers (J. Aitchison
& J. A. C. Brown, The Lognormal Distribution (1957), sec. 2.3). A number between y exp(-sigma) and
y exp(sigma) is within one standard uncertainty.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Uncertain(NamedTuple):
    """A number and the standard deviation of its logarithm; NaN where that is not known."""

    value: float
    uncertainty: float = math.nan

    @property
    def low(self) -> float:
        """The number less one standard uncertainty."""
        return self.value * math.exp(-self.uncertainty)

    @property
    def high(self) -> float:
        """The number plus one standard uncertainty."""
        return self.value * math.exp(self.uncertainty)

    def times(self, other: Uncertain) -> Uncertain:
        """Return the product with an independent number."""
        return Uncertain(self.value * other.value, together([self.uncertainty, other.uncertainty]))

    def over(self, other: Uncertain) -> Uncertain:
        """Return the quotient by an independent number; NaN if that is zero."""
        value = self.value / other.value if other.value else math.nan
        return Uncertain(value, together([self.uncertainty, other.uncertainty]))


UNKNOWN = Uncertain(math.nan)
"""Nothing known."""


def together(uncertainties: Iterable[float]) -> float:
    """Return the root of the sum of squares of those known; NaN if none is."""
    known = [one for one in uncertainties if not math.isnan(one)]
    return math.hypot(*known) if known else math.nan


def of_mean(values: ArrayLike) -> float:
    """Return the standard deviation of the logarithm of the mean of `values`, from their scatter.

    NaN for fewer than two values and for values not above zero.
    """
    sample = np.asarray(values, dtype=float)
    if sample.size < 2 or not (sample > 0.0).all():
        return math.nan
    return float(np.std(sample, ddof=1) / math.sqrt(sample.size) / sample.mean())
