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
from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gripscale.errors import InputError
from gripscale.surface.height_difference import HeightDifference
from gripscale.surface.plateau import log_weights
from gripscale.surface.sine_fit import fit_sines
from gripscale.surface.sine_search import FACTOR_RANGE
from gripscale.surface.sines import SineStack

NUMBERS = range(2, 13)
FIRST_WAVELENGTHS = np.geomspace(0.5, 2.0, 9)
"""Tried, over the fitted one."""


class Span(NamedTuple):
    """Smallest and largest of a quantity."""

    low: float
    high: float


@dataclass(frozen=True)
class SineAmbiguity:
    """The stacks that follow C_z as well as it is known.

    Attributes
    ----------
    tried, as_good : int
        Stacks tried, and those that are as good as the best.
    band : float
        Rms half width of the band of 95 % nominal confidence of C_z [decades]; 0 if not known.
    waves, s_wavelength, s_amplitude : Span
        Number of waves and magnification factors among those as good.
    first_wavelength, first_amplitude, last_amplitude : Span
        Of the first and last wave among those as good [m].
    rms_slope : Span
        Root of sum (2 pi A / lambda)^2 / 2 among those as good [-]; friction goes with it.
    """

    tried: int
    as_good: int
    band: float
    waves: Span
    s_wavelength: Span
    s_amplitude: Span
    first_wavelength: Span
    first_amplitude: Span
    last_amplitude: Span
    rms_slope: Span


def sine_ambiguity(
    hdc: HeightDifference, sines: SineStack, *, cut_off: float | None = None
) -> SineAmbiguity:
    """Return what other stacks follow `hdc` as well as it is known.

    Parameters
    ----------
    hdc : HeightDifference
        The measured curve, with its band.
    sines : SineStack
        What was fitted to it: says the lags that count, the first and the last wavelength.
    cut_off : float, optional
        Where the roughness ends [m], if `sines` were fitted with it; else all end in the same wave.

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
    end = {"smallest_wavelength": float(sines.wavelength[-1])} if cut_off is None else {}
    common = dict(zip(("smallest_lag", "largest_lag"), sines.lag_range, strict=True)) | end
    firsts = FIRST_WAVELENGTHS * float(sines.wavelength[0])
    tried = [_fitted(hdc, n, float(first), cut_off, common) for n in NUMBERS for first in firsts]
    found = [stack for stack in tried if stack is not None]
    band = _band(hdc, *sines.lag_range)
    limit = math.hypot(min(residual for residual, _ in found), band)
    good = [stack for residual, stack in found if residual <= limit]

    def span(values: Iterable[float]) -> Span:
        listed = list(values)
        return Span(float(min(listed)), float(max(listed)))

    return SineAmbiguity(
        tried=len(found),
        as_good=len(good),
        band=band,
        waves=span(len(stack) for stack in good),
        s_wavelength=span(stack.wavelength[0] / stack.wavelength[1] for stack in good),
        s_amplitude=span(stack.amplitude[0] / stack.amplitude[1] for stack in good),
        first_wavelength=span(stack.wavelength[0] for stack in good),
        first_amplitude=span(stack.amplitude[0] for stack in good),
        last_amplitude=span(stack.amplitude[-1] for stack in good),
        rms_slope=span(stack.rms_slope for stack in good),
    )


def _fitted(
    hdc: HeightDifference, waves: int, first: float, cut_off: float | None, common: dict[str, float]
) -> tuple[float, SineStack] | None:
    """Return residual and stack of so many waves from a first wavelength [m].

    None where the factor would leave its limits.
    """
    end = common.get("smallest_wavelength", cut_off or 0.0)
    steps = waves - 1 if cut_off is None else waves - 0.5
    if not FACTOR_RANGE[0] <= (first / end) ** (1.0 / steps) <= FACTOR_RANGE[1]:
        return None
    stack = fit_sines(hdc, scales=waves, first_wavelength=first, cut_off=cut_off, **common)
    return (math.inf if stack.residual is None else stack.residual), stack


def _band(hdc: HeightDifference, smallest: float, largest: float) -> float:
    """Return the rms half width of the band over a range of lags [decades]."""
    used = (hdc.lag >= smallest) & (hdc.lag <= largest) & np.isfinite(hdc.upper)
    if not used.any():
        return 0.0
    half = np.log10(hdc.upper[used] / hdc.value[used])
    return float(np.sqrt(np.average(half**2, weights=log_weights(hdc.lag[used]))))
