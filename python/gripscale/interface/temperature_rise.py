"""How warm a sliding rubber gets where it loses energy: closed forms for an insulated half-space.

The rubber moves with v along x over heat that stands still, lost at depths distributed as in
`loss_depth`. A harmonic q exp(i k . r) of the heat per area [W/m^2], steady, gives

    T(0)    = q E exp(-m Z) / (kappa m),      m^2 = |k|^2 + i k_x v / D,   Re m > 0
    T(lost) = q (E exp(-m |Z - Z'|) + (E exp(-m Z))^2) / (2 kappa m)

at the surface, and on the mean where the energy is lost; for the exponential depth exp(-a z) the
first is Q / (kappa m (m + a)) with Q = a q. A uniform q that lasts for a time t, l = 2 sqrt(D t):

    T(0)    = q l E ierfc(Z/l) / kappa        (2 q sqrt(t / (pi kappa rho c)) at the surface)
    T(lost) = q l (E ierfc(|Z - Z'|/l) + E ierfc((Z + Z')/l)) / (2 kappa)

Source of the plane source and its image: H. S. Carslaw & J. C. Jaeger, Conduction of Heat in
Solids, 2nd ed. (1959), sec. 10.2 and 10.7; the averages over depths are derived here.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.interface.loss_depth import DepthsOfLoss
from gripscale.interface.thermal import ThermalProperties

ComplexArray = NDArray[np.complex128]


def harmonic_decay(
    wavenumber: ArrayLike, along: ArrayLike, speed: float, thermal: ThermalProperties
) -> ComplexArray:
    """Return m [1/m] of harmonics.

    Parameters
    ----------
    wavenumber, along : array_like
        |k| and k_x [rad/m], broadcast together.
    speed : float
        Of the rubber [m/s].
    thermal : ThermalProperties
        Of the rubber.
    """
    number = np.asarray(wavenumber, dtype=float)
    carried = np.asarray(along, dtype=float) * speed / thermal.diffusivity
    return np.asarray(np.sqrt(number**2 + 1j * carried))


def harmonic_at_surface(
    m: ComplexArray, depth: DepthsOfLoss, thermal: ThermalProperties
) -> ComplexArray:
    """Return the surface temperature of harmonics per heat per area [K m^2/W], shape of `m`."""
    return np.asarray(depth.decay(m) / (thermal.conductivity * m))


def harmonic_where_lost(
    m: ComplexArray, depth: DepthsOfLoss, thermal: ThermalProperties
) -> ComplexArray:
    """Return the temperature of harmonics on the mean where they are lost, per heat per area.

    In [K m^2/W], shape of `m`.
    """
    met = depth.decay_between(m) + depth.decay(m) ** 2
    return np.asarray(met / (2.0 * thermal.conductivity * m))


def uniform_at_surface(time: float, depth: DepthsOfLoss, thermal: ThermalProperties) -> float:
    """Return the surface temperature of uniform heat per heat per area.

    Parameters
    ----------
    time : float
        How long the heat has lasted [s].
    depth : DepthsOfLoss
        Where it is lost.
    thermal : ThermalProperties
        Of the rubber.

    Returns
    -------
    float
        In [K m^2/W].

    Raises
    ------
    InputError
        If the time is no finite number from zero.
    """
    length = _spread(time, thermal)
    return length * depth.spread(length) / thermal.conductivity if length > 0.0 else 0.0


def uniform_where_lost(time: float, depth: DepthsOfLoss, thermal: ThermalProperties) -> float:
    """Return the temperature where the energy is lost of uniform heat per heat per area.

    Arguments, unit and errors as for `uniform_at_surface`.
    """
    length = _spread(time, thermal)
    if length == 0.0:
        return 0.0
    met = depth.spread_between(length) + depth.spread_sum(length)
    return length * met / (2.0 * thermal.conductivity)


def _spread(time: float, thermal: ThermalProperties) -> float:
    """Return 2 sqrt(D t) [m]."""
    return 2.0 * math.sqrt(thermal.diffusivity * checks.not_negative("time", time, unit="s"))
