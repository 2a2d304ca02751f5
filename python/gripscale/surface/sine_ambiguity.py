"""The range of sine waves that follow a height difference correlation equally well.

C_z is smooth and known within its band only, so stacks with other numbers of waves and other
factors follow it as well. Their common properties are determined by the curve; where they differ,
the stack is a choice. With r the rms difference from the curve in decades, b the rms half width of
its band over the same lags, and r_0 the least r of all stacks tried, a stack is as good if

    r^2 <= r_0^2 + b^2.

The search tries 2 to 12 waves from first wavelengths half to twice the fitted one down to the same
last wave or cut-off, and fits all other unknowns.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from gripscale.core.errors import InputError
from gripscale.surface.height_difference import HeightDifference, log_weights
from gripscale.surface.sine_fit import FACTOR_RANGE, fit_sines
from gripscale.surface.sines import SineStack

NUMBERS = range(2, 13)
FIRST_WAVELENGTHS = np.geomspace(0.5, 2.0, 9)
"""First wavelengths tried, over the fitted one."""


class Span(NamedTuple):
    """Smallest and largest of a quantity."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class SineAmbiguity:
    """The stacks that follow C_z within its uncertainty."""

    tried: int
    """Stacks tried."""
    band: float
    """Rms half width of the band of 95 % nominal confidence of C_z [decades]; 0 if not known."""
    stacks: tuple[SineStack, ...] = field(repr=False)
    """The stacks that are as good as the best."""

    @property
    def waves(self) -> Span:
        """Fewest and most waves."""
        return self._span(len)

    @property
    def s_wavelength(self) -> Span:
        """Smallest and largest magnification factor of wavelength."""
        return self._span(lambda stack: stack.wavelength[0] / stack.wavelength[1])

    @property
    def first_wavelength(self) -> Span:
        """Smallest and largest first wavelength [m]."""
        return self._span(lambda stack: stack.wavelength[0])

    @property
    def first_amplitude(self) -> Span:
        """Smallest and largest amplitude of the first wave [m]."""
        return self._span(lambda stack: stack.amplitude[0])

    @property
    def rms_slope(self) -> Span:
        """Smallest and largest rms slope of all waves together [-], on which friction depends."""
        return self._span(lambda stack: stack.rms_slope)

    def _span(self, quantity: Callable[[SineStack], float]) -> Span:
        values = [float(quantity(stack)) for stack in self.stacks]
        return Span(min(values), max(values))


def sine_ambiguity(hdc: HeightDifference, sines: SineStack) -> SineAmbiguity:
    """Return the other stacks that follow `hdc` within its uncertainty.

    Raises `InputError` if `sines` has one wave, or was not fitted: it then has no range of lags.

    Parameters
    ----------
    hdc : HeightDifference
        The measured curve, with its band.
    sines : SineStack
        The waves fitted to it, which fix the range of lags, the first wavelength, and the cut-off
        or the last wavelength.
    """
    if sines.lag_range is None or len(sines) < 2:
        raise InputError(
            "sines must be two waves or more, fitted to hdc; got "
            f"{len(sines)}, {'not fitted' if sines.lag_range is None else 'fitted'}"
        )
    smallest_lag, largest_lag = sines.lag_range
    end = sines.cutoff_wavelength
    residuals, stacks = [], []
    for waves in NUMBERS:
        steps = waves - 1 if sines.cut_off is None else waves - 0.5
        for first in FIRST_WAVELENGTHS * float(sines.wavelength[0]):
            if not FACTOR_RANGE[0] <= (first / end) ** (1.0 / steps) <= FACTOR_RANGE[1]:
                continue
            stack = fit_sines(
                hdc,
                scales=waves,
                first_wavelength=float(first),
                smallest_wavelength=end if sines.cut_off is None else None,
                cut_off=sines.cut_off,
                smallest_lag=smallest_lag,
                largest_lag=largest_lag,
            )
            residuals.append(math.inf if stack.residual is None else stack.residual)
            stacks.append(stack)
    band = 0.0
    used = (hdc.lag >= smallest_lag) & (hdc.lag <= largest_lag) & np.isfinite(hdc.upper)
    if used.any():
        half = np.log10(hdc.upper[used] / hdc.value[used])
        band = float(np.sqrt(np.average(half**2, weights=log_weights(hdc.lag[used]))))
    limit = math.hypot(min(residuals), band)
    good = (stack for stack, r in zip(stacks, residuals, strict=True) if r <= limit)
    return SineAmbiguity(len(stacks), band, tuple(good))
