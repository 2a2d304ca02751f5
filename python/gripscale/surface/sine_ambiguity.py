"""How far a height difference correlation determines the sine waves that stand for it.

C_z is smooth and known within its band only, so stacks with other numbers of waves and other
factors follow it as well as it is known. What they agree on the curve determines; where they
differ, the stack is a choice. With r the rms difference from the curve in decades, b the rms half
width of its band over the same lags, and r_0 the least r of all stacks tried, a stack is as good if

    r^2 <= r_0^2 + b^2.

Tried are 2 to 12 waves from first wavelengths half to twice the fitted one down to the same last
wave or cut-off, all else fitted.
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
"""Tried, over the fitted one."""


class Span(NamedTuple):
    """Smallest and largest of a quantity."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class SineAmbiguity:
    """The stacks that follow C_z as well as it is known.

    Attributes
    ----------
    tried : int
        Stacks tried.
    band : float
        Rms half width of the band of 95 % nominal confidence of C_z [decades]; 0 if not known.
    stacks : tuple of SineStack
        Those that are as good as the best.
    """

    tried: int
    band: float
    stacks: tuple[SineStack, ...] = field(repr=False)

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
        """Smallest and largest rms slope of all waves together [-]; friction goes with it."""
        return self._span(lambda stack: stack.rms_slope)

    def _span(self, quantity: Callable[[SineStack], float]) -> Span:
        values = [float(quantity(stack)) for stack in self.stacks]
        return Span(min(values), max(values))


def sine_ambiguity(hdc: HeightDifference, sines: SineStack) -> SineAmbiguity:
    """Return what other stacks follow `hdc` as well as it is known.

    Parameters
    ----------
    hdc : HeightDifference
        The measured curve, with its band.
    sines : SineStack
        What was fitted to it: says the lags that count, the first wavelength, and the cut-off or,
        without one, the last wavelength.

    Raises
    ------
    InputError
        If `sines` has one wave, or was not fitted: it then has no range of lags.
    """
    if sines.lag_range is None or len(sines) < 2:
        raise InputError(
            "sines must be two waves or more, fitted to hdc; got "
            f"{len(sines)}, {'not fitted' if sines.lag_range is None else 'fitted'}"
        )
    firsts = FIRST_WAVELENGTHS * float(sines.wavelength[0])
    tried = [_fitted(hdc, sines, n, float(first)) for n in NUMBERS for first in firsts]
    found = [one for one in tried if one is not None]
    band = _band(hdc, *sines.lag_range)
    limit = math.hypot(min(residual for residual, _ in found), band)
    good = tuple(stack for residual, stack in found if residual <= limit)
    return SineAmbiguity(len(found), band, good)


def _fitted(
    hdc: HeightDifference, sines: SineStack, waves: int, first: float
) -> tuple[float, SineStack] | None:
    """Return residual and stack of so many waves from a first wavelength [m].

    None where the factor would leave its limits.
    """
    cut_off, end = sines.cut_off, sines.roughness_end
    steps = waves - 1 if cut_off is None else waves - 0.5
    if not FACTOR_RANGE[0] <= (first / end) ** (1.0 / steps) <= FACTOR_RANGE[1]:
        return None
    smallest_lag, largest_lag = sines.lag_range or (None, None)
    stack = fit_sines(
        hdc,
        scales=waves,
        first_wavelength=first,
        smallest_wavelength=end if cut_off is None else None,
        cut_off=cut_off,
        smallest_lag=smallest_lag,
        largest_lag=largest_lag,
    )
    return (math.inf if stack.residual is None else stack.residual), stack


def _band(hdc: HeightDifference, smallest: float, largest: float) -> float:
    """Return the rms half width of the band over a range of lags [decades]."""
    used = (hdc.lag >= smallest) & (hdc.lag <= largest) & np.isfinite(hdc.upper)
    if not used.any():
        return 0.0
    half = np.log10(hdc.upper[used] / hdc.value[used])
    return float(np.sqrt(np.average(half**2, weights=log_weights(hdc.lag[used]))))
