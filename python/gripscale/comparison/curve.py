"""Area and friction down to each wavelength, as the models tell it, on one scale of wavelengths.

The chain adds a wave at a time, in steps. The direct contact splits its friction by octave
(its area is that of another contact, without the shorter waves), the theories integrate: both are
interpolated in the logarithm of the wavelength.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
import xarray as xr
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUNDING = 1e-6
"""Relative difference below which two wavelengths are the same."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Contact fraction and friction down to each wavelength.

    Parameters
    ----------
    wavelength : array, shape (n,)
        Falling [m].
    contact_fraction, friction : array, shape (n,)
        Of the waves not shorter [-]; NaN where unknown.
    stepped : bool
        Whether each wavelength is one wave, and nothing lies between.
    """

    wavelength: Array = field(repr=False)
    contact_fraction: Array = field(repr=False)
    friction: Array = field(repr=False)
    stepped: bool

    def at(self, name: str, wavelength: Array) -> Array:
        """Return `contact_fraction` or `friction` down to each `wavelength` [m].

        Above the longest wave nothing of the surface is seen yet; below the shortest nothing more
        comes; NaN where the model knows the wave and not the number.
        """
        values = getattr(self, name)
        known = np.isfinite(values)
        if not known.any():
            return np.full(wavelength.size, np.nan)
        before, first = _BEFORE[name], self.wavelength[0] * (1.0 + ROUNDING)
        own, values = self.wavelength[known], values[known]
        if self.stepped:
            count = (own[None, :] >= wavelength[:, None] * (1.0 - ROUNDING)).sum(axis=1)
            return np.asarray(np.append(before, values)[count])
        found = np.interp(-np.log(wavelength), -np.log(own), values)
        found = np.where(wavelength > own[0] * (1.0 + ROUNDING), np.nan, found)
        return np.where(wavelength > first, before, found)


_BEFORE = {"contact_fraction": 1.0, "friction": 0.0}
"""Of a smooth surface."""


def curve_of(answer: xr.Dataset) -> Curve | None:
    """Return what a model told by wavelength, or None if it told nothing."""
    if "octave_running_friction" in answer:
        names = ("contact_fraction_without_shorter", "octave_running_friction")
        weight = answer["weight"].values
        area, friction = (weight @ answer[name].transpose("profile", ...).values for name in names)
        return Curve(answer["wavelength"].values, area, friction, stepped=False)
    if "running_friction" not in answer:
        return None
    friction = answer["running_friction"].values
    known = answer.get("running_contact_fraction")
    area = np.full(friction.size, np.nan) if known is None else known.values
    return Curve(answer["wavelength"].values, area, friction, stepped="amplitude" in answer)


def octaves(curves: Iterable[Curve], smallest: float) -> Array:
    """Return the lower ends of octaves [m], falling, that hold all `curves`, `smallest` among them.

    Empty without curves.
    """
    ends = np.array([[one.wavelength[0], one.wavelength[-1]] for one in curves])
    if not ends.size:
        return np.empty(0)
    first = np.floor(np.log2(ends[:, 0].max() / smallest) + ROUNDING)
    last = np.floor(np.log2(ends[:, 1].min() / smallest) + ROUNDING)
    return np.asarray(smallest * 2.0 ** np.arange(first, last - 1.0, -1.0))
