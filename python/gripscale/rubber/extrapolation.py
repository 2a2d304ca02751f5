"""How much of a result rests on a rubber beyond its measured frequencies, and how far beyond.

A rubber from a master curve is known within `Rubber.valid_band`; beyond it its series is an
extrapolation. Every model states excitation beyond the band in the same three numbers: the share of
the friction that comes from there, and how many decades below and above the band it goes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, ExtrapolationError
from gripscale.rubber.material import Rubber

CHOICES = ("warn", "refuse")  # what may be done about excitation beyond the band
# Share of the friction that does not count: of a spectrum, which has no end, both tails.
WORTH_SAYING = 0.01


@dataclass(frozen=True)
class Extrapolation:
    """What of a friction rests on the rubber beyond its measured frequencies; NaN if not known."""

    share: float
    """Of the friction [-]; also NaN where there is no friction to share."""
    below: float
    """How far excitation goes below the band [decades]; 0 if not."""
    above: float
    """How far it goes above the band [decades]; 0 if not."""

    @property
    def anywhere(self) -> bool:
        """Whether anything is beyond the band."""
        return self.below > 0.0 or self.above > 0.0

    @property
    def furthest(self) -> str:
        """How far it goes, in words; empty within the band."""
        ends = [
            f"{decades:.2g} decades {word}"
            for decades, word in ((self.below, "below"), (self.above, "above"))
            if decades > 0.0
        ]
        return f"up to {' and '.join(ends)} the measured band" if ends else ""


# Of a rubber without a measured band, or a model that does not tell.
UNKNOWN = Extrapolation(math.nan, math.nan, math.nan)
NOTHING_BEYOND = Extrapolation(0.0, 0.0, 0.0)  # at rest, where nothing is excited


def of_frequencies(rubber: Rubber, omega: ArrayLike) -> Extrapolation:
    """Return how far excitation at all of `omega` [rad/s] goes; its share is all or nothing."""
    if rubber.valid_band is None:
        return UNKNOWN
    frequency = np.abs(np.asarray(omega, dtype=float))
    outside = bool(np.any(rubber.outside_band(frequency)))
    return Extrapolation(float(outside), *_decades(rubber.valid_band, frequency))


def of_spectrum(rubber: Rubber, omega: ArrayLike, friction: ArrayLike) -> Extrapolation:
    """Return what of a friction lies beyond the band: `omega` [rad/s] and what each adds [-].

    The slowest and the fastest frequencies that `WORTH_SAYING` of it comes from count as nothing.
    """
    if rubber.valid_band is None:
        return UNKNOWN
    parts = np.abs(np.ravel(np.asarray(friction, dtype=float)))
    frequency = np.abs(np.ravel(np.asarray(omega, dtype=float)))
    total = float(parts.sum())
    if not (math.isfinite(total) and total > 0.0):
        return Extrapolation(math.nan, 0.0, 0.0)
    share = float(parts[rubber.outside_band(frequency)].sum()) / total
    order = np.argsort(frequency)
    so_far = np.cumsum(parts[order]) / total
    ends = np.searchsorted(so_far, [WORTH_SAYING, 1.0 - WORTH_SAYING])
    counted = frequency[order[np.minimum(ends, len(order) - 1)]]
    return Extrapolation(share, *_decades(rubber.valid_band, counted))


def by_wavelength(
    rubber: Rubber, speed: float, wavelength: Array, running_friction: Array
) -> Extrapolation:
    """Return what of a friction lies beyond the band, from that of the waves down to each [m].

    What an interval of wavelength adds counts at its middle, at 2 pi speed/wavelength.
    """
    if speed == 0.0:
        return NOTHING_BEYOND
    parts = np.diff(running_friction, prepend=0.0)
    longer = np.append(wavelength[0], wavelength[:-1])
    return of_spectrum(rubber, 2.0 * np.pi * speed / np.sqrt(longer * wavelength), parts)


def of_sum(parts: Sequence[Extrapolation], friction: ArrayLike) -> Extrapolation:
    """Return the extrapolation of a sum of which each of `parts` adds its `friction` [-]."""
    if not parts:
        return UNKNOWN
    weight = np.abs(np.asarray(friction, dtype=float))
    share, below, above = np.array([(part.share, part.below, part.above) for part in parts]).T
    total = float(weight.sum())
    # a part without friction has no share to tell of, and adds none
    beyond = float(weight @ np.where(weight > 0.0, share, 0.0))
    whole = 0.0 if not share.any() else beyond / total if total > 0.0 else math.nan
    return Extrapolation(whole, float(below.max()), float(above.max()))


def _decades(band: tuple[float, float], omega: Array) -> tuple[float, float]:
    """Return how far the frequencies go below and above the band [decades]."""
    excited = omega[omega > 0.0]
    if not excited.size:
        return 0.0, 0.0
    below = math.log10(band[0] / float(excited.min()))
    above = math.log10(float(excited.max()) / band[1])
    return max(below, 0.0), max(above, 0.0)


def require_measured(rubber: Rubber, wavelength: ArrayLike, speed: float) -> None:
    """Raise `ExtrapolationError` if a fundamental of falling wavelengths [m] is beyond the band."""
    lengths = np.atleast_1d(np.asarray(wavelength, dtype=float))
    omega = 2.0 * np.pi * speed / lengths
    if rubber.valid_band is None or speed == 0.0 or not rubber.outside_band(omega).any():
        return
    low, high = rubber.valid_band
    at = int(np.argmax(np.maximum(np.log(low / omega), np.log(omega / high))))
    if omega[at] > high:
        most = _three_digits(high * lengths[-1] / (2.0 * np.pi), math.floor)
        limit = _three_digits(2e3 * np.pi * speed / high, math.ceil)
        side, end, reach = "above", "smallest", f"at most {most} m/s"
    else:
        least = _three_digits(low * lengths[0] / (2.0 * np.pi), math.ceil)
        limit = _three_digits(2e3 * np.pi * speed / low, math.floor)
        side, end, reach = "below", "largest", f"at least {least} m/s"
    raise ExtrapolationError(
        f"wave {at + 1} of {lengths.size} (wavelength {1e3 * lengths[at]:.4g} mm) excites the "
        f"rubber at {omega[at]:.3g} rad/s, {side} the measured band, {low:.3g} to {high:.3g} "
        f"rad/s, and extrapolation is to be refused; the data carry {reach} with these waves, or "
        f"a {end} wavelength of {limit} mm at {speed:.4g} m/s"
    )


def _three_digits(value: float, rounding: Callable[[float], int]) -> str:
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{rounding(value / step) * step:.3g}"
