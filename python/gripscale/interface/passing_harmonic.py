"""Temperature of a moving harmonic of heat that has lasted only while a contact passes.

The steady harmonic of `temperature_rise` takes its time: one across the way of sliding never moves
over the rubber, and warms it by conduction alone. Switched on at t = 0 it gives, l = 2 sqrt(D t),

    T(0)    = q E r(Z) / kappa
    T(lost) = q (E r(|Z - Z'|) + E r(Z + Z')) / (2 kappa)
    r(z)    = (exp(-m z) erfc(z/l - m l/2) - exp(m z) erfc(z/l + m l/2)) / (2 m)

which is the steady exp(-m z)/m for l to infinity and the uniform l ierfc(z/l) for m to zero.
Derived here, as the integral over time of the plane source of Carslaw & Jaeger (1959), sec. 10.7,
exp(-z^2/(4 D t) - D m^2 t)/sqrt(pi t), whose decay is complex; held against that integral in
tests/interface/test_passing_harmonic.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.special import wofz

from gripscale.interface.loss_depth import LossDepth
from gripscale.interface.temperature_rise import (
    ComplexArray,
    harmonic_at_surface,
    harmonic_where_lost,
)
from gripscale.interface.thermal import ThermalProperties

Array = NDArray[np.float64]

STEADY = 4.0
"""Re(m) l/2 from which a harmonic is steady: erfc of it is 2e-8."""


def passing_at_surface(
    m: ComplexArray, time: float, depth: LossDepth, thermal: ThermalProperties
) -> ComplexArray:
    """Return the surface temperature after a `time` [s] of harmonics per heat per area.

    In [K m^2/W], shape of `m`, which has no zero.
    """

    def slow(own: ComplexArray, length: float) -> ComplexArray:
        met = depth.average("one", lambda z: _risen(z, own, length), length)
        return np.asarray(met / thermal.conductivity)

    return _each(m, time, thermal, harmonic_at_surface(m, depth, thermal), slow)


def passing_where_lost(
    m: ComplexArray, time: float, depth: LossDepth, thermal: ThermalProperties
) -> ComplexArray:
    """Return the temperature on the mean where they are lost, per heat per area.

    In [K m^2/W], shape of `m`, which has no zero.
    """

    def slow(own: ComplexArray, length: float) -> ComplexArray:
        parts = [
            depth.average(of, lambda z: _risen(z, own, length), length) for of in ("between", "sum")
        ]
        return np.asarray(sum(parts) / (2.0 * thermal.conductivity))

    return _each(m, time, thermal, harmonic_where_lost(m, depth, thermal), slow)


def _each(
    m: ComplexArray,
    time: float,
    thermal: ThermalProperties,
    steady: ComplexArray,
    slow: Callable[[ComplexArray, float], ComplexArray],
) -> ComplexArray:
    """Return the steady values, those of harmonics that are not steady yet replaced."""
    length = 2.0 * math.sqrt(thermal.diffusivity * time)
    late = m.real * (0.5 * length) < STEADY
    if not late.any():
        return steady
    out = steady.copy()
    different, back = np.unique(m[late], return_inverse=True)
    out[late] = slow(different, length)[back] if length > 0.0 else 0.0
    return out


def _risen(z: Array, m: ComplexArray, length: float) -> ComplexArray:
    """Return r at depths of shape (n,), shape (n, m), by Faddeeva's w(x) = exp(-x^2) erfc(-i x)."""
    at, half = (z / length)[:, None], (0.5 * length * m)[None, :]
    scale = np.exp(-(at**2) - half**2)
    return np.asarray(scale * (wofz(1j * (at - half)) - wofz(1j * (at + half))) / (2.0 * m))
