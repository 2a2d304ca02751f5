"""A tread as a brush: the braking force of bristles that stick and slide in a contact patch.

With y = x/L from the entry of a patch of length L, stiffness k, slip s, sigma = s/(1 - s) and the
speed v of the road (docs/tyre.md),

    p(y)      = 6 p_0 y (1 - y)                          pressure, mean p_0
    tau(y)    = k sigma L y  sticking,    mu(v_s, p, T) p(y)  sliding
    v_s(y)    = s v - (1 - s) v (6 p_0 / (k L)) mu (1 - 2 y)
    T(t)      = 1/(e sqrt(pi)) int_0^t mu p v_s / sqrt(t - t') dt'    warming, effusivity e

Sources: S. K. Clark (ed.), Mechanics of Pneumatic Tires (1981), ch. 6; H. B. Pacejka, Tire and
Vehicle Dynamics, 3rd ed. (2012), sec. 3.2, doi:10.1016/C2010-0-68548-8; H. S. Carslaw & J. C.
Jaeger, Conduction of Heat in Solids, 2nd ed. (1959), sec. 2.9.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, InputError, checked, checks

# mu [-] of sliding speed [m/s], pressure [Pa] and temperature rise [K], of one shape.
SlidingFriction = Callable[[Array, Array, Array], Array]

# Points of a quadrature along the sliding part. With a friction that is smooth over speed they are
# within 1e-4 of 64 points.
_NODES = 12
# Of the interval in which a sliding speed lies, in its logarithm, before a secant through what is
# left, some 15 %.
_HALVINGS = 7
# Of the patch, for where sliding begins. The force is stationary there: 6e-5 leave 1e-8.
_EDGE_HALVINGS = 14
_SLOWEST = 1e-4  # sliding speed that counts as none, over the speed of the road
# Iterations of friction and temperature, half way each, and the change that ends them [K].
_WARMING_STEPS, _WARMING_TOLERANCE = 40, 0.05
# Longest time that a bristle is heated for, over the time in which the road passes the patch.
_LONGEST_PASSAGE = 20.0


class Brush(Checked):
    """Bristles of a tread in a contact patch with a parabolic pressure.

    Raises `InputError` if a value cannot be used.
    """

    length: float = checked(checks.positive, unit="m")
    """Length of the patch [m]."""
    pressure: float = checked(checks.positive, unit="Pa")
    """Mean pressure in the patch [Pa]."""
    stiffness: float = checked(checks.positive, unit="Pa/m")
    """Shear stress of a bristle over its deflection [Pa/m]."""
    effusivity: float | None = checked(checks.positive, unit="W s^0.5/(m^2 K)", default=None)
    """sqrt(conductivity x density x specific heat) of the rubber; None: it does not warm."""

    @property
    def compliance(self) -> float:
        """6 p_0/(k L) [-]: sigma from which all bristles slide, over the friction."""
        return 6.0 * self.pressure / (self.stiffness * self.length)

    def pressure_at(self, y: Array) -> Array:
        """Return the pressure [Pa] at y = x/L."""
        return 6.0 * self.pressure * y * (1.0 - y)


class BrushForce(NamedTuple):
    """What a brush answers, over slips."""

    force: Array
    """Braking force over the load [-]."""
    warming: Array
    """Largest temperature rise of the rubber in the patch [K]."""


def brush_force(
    brush: Brush, friction: SlidingFriction, slip: ArrayLike, speed: ArrayLike
) -> BrushForce:
    """Return the braking force of a brush over slips and speeds of the road.

    Parameters
    ----------
    brush : Brush
        The tread.
    friction : callable
        mu [-] of sliding speed [m/s], pressure [Pa] and temperature rise [K]. Its arguments have
        the shape of slip and speed together and one axis more, along the patch; its result may have
        further axes before these.
    slip : array_like
        s = 1 - (speed of the tread)/(speed of the road), above 0 and up to 1, the locked wheel.
    speed : array_like
        Speed of the road under the wheel [m/s], broadcast with `slip`.

    Raises
    ------
    InputError
        If a slip or a speed cannot be used.
    """
    slips, speeds = checks.real("slip", slip), checks.real("speed", speed, unit="m/s")
    if not ((slips > 0.0) & (slips <= 1.0)).all():
        raise InputError(f"slip must be above 0 and at most 1; got {checks.short_repr(slip)}")
    if not (speeds > 0.0).all():
        raise InputError(f"speed must be above zero [m/s]; got {checks.short_repr(speed)}")
    s, v = (a[..., None] for a in np.broadcast_arrays(slips, speeds))
    patch = _Patch(brush, friction, s, v)
    edge = patch.edge()
    u, weights = _unit_gauss(_NODES)
    y = edge + (1.0 - edge) * u**2  # temperature rises with the square root from the edge
    warming = patch.warming(edge, y)
    stress = patch.friction_at(y, warming)[0] * brush.pressure_at(y)
    sliding = (1.0 - edge[..., 0]) * (stress * (2.0 * u * weights)).sum(-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        sheared = np.where(
            edge > 0.0, brush.stiffness * brush.length * s / (1.0 - s) * edge**2, 0.0
        )
    force = (sliding + 0.5 * sheared[..., 0]) / brush.pressure
    return BrushForce(force, warming.max(-1))


class _Patch(NamedTuple):
    """A brush at slips and speeds with one axis more, along the patch."""

    brush: Brush
    friction: SlidingFriction
    slip: Array
    speed: Array

    def friction_at(self, y: Array, warming: Array) -> tuple[Array, Array]:
        """Return friction [-] and sliding speed [m/s] of bristles that slide."""
        mean = self.slip * self.speed
        regained = (1.0 - self.slip) * self.speed * self.brush.compliance * (2.0 * y - 1.0)
        pressure = self.brush.pressure_at(y)
        shape = np.broadcast_shapes(y.shape, warming.shape, mean.shape)
        low = np.broadcast_to(np.log(_SLOWEST * self.speed), shape)
        high = np.broadcast_to(np.log(mean + 10.0 * np.abs(regained)), shape)
        pressure, warming = np.broadcast_to(pressure, shape), np.broadcast_to(warming, shape)

        def excess(logarithm: Array) -> Array:
            sliding = np.exp(logarithm)
            return sliding - mean - regained * self.friction(sliding, pressure, warming)

        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            slower = excess(middle) < 0.0
            low, high = np.where(slower, middle, low), np.where(slower, high, middle)
        below, above = excess(low), excess(high)
        part = np.where(below < 0.0, below / np.where(below < above, below - above, 1.0), 0.0)
        sliding = np.exp(low + np.clip(part, 0.0, 1.0) * (high - low))
        return self.friction(sliding, pressure, warming), sliding

    def edge(self) -> Array:
        """Return y where bristles begin to slide: k sigma L y = mu p, cold; 0 where all slide."""
        with np.errstate(divide="ignore"):
            demand = self.slip / (1.0 - self.slip) / self.brush.compliance
        example = self.friction(*(np.full(self.slip.shape, x) for x in (1.0, 1.0, 0.0)))
        low, high = np.zeros(example.shape), np.ones(example.shape)
        for _ in range(_EDGE_HALVINGS):
            middle = 0.5 * (low + high)
            sticks = self.friction_at(middle, np.zeros(1))[0] * (1.0 - middle) > demand
            low, high = np.where(sticks, middle, low), np.where(sticks, high, middle)
        return np.where(low > 0.0, 0.5 * (low + high), 0.0)

    def warming(self, edge: Array, y: Array) -> Array:
        """Return the temperature rise at points of the sliding part [K]."""
        warming = np.zeros(y.shape)
        if self.brush.effusivity is None:
            return warming
        rolling = np.maximum(1.0 - self.slip, 1.0 / _LONGEST_PASSAGE) * self.speed
        passage = (1.0 - edge) * self.brush.length / rolling
        scale = np.sqrt(passage / np.pi) / self.brush.effusivity
        for _ in range(_WARMING_STEPS):
            mu, sliding = self.friction_at(y, warming)
            heat = mu * self.brush.pressure_at(y) * sliding
            change = scale * (heat @ _half_integral().T) - warming
            warming = warming + 0.5 * change
            if np.abs(change).max() < _WARMING_TOLERANCE:
                break
        return warming


@lru_cache(maxsize=4)
def _unit_gauss(count: int) -> tuple[Array, Array]:
    """Return points and weights of Gauss's quadrature from 0 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return 0.5 * (nodes + 1.0), 0.5 * weights


@lru_cache(maxsize=1)
def _half_integral() -> Array:
    """Return the matrix of int_0^z q(z')/sqrt(z - z') dz' at z = u^2, u the points of quadrature.

    With z' = z (1 - w^2) it is 2 sqrt(z) int_0^1 q dw; q is a polynomial in u through its points.
    """
    u, _ = _unit_gauss(_NODES)
    w, weights = _unit_gauss(2 * _NODES)
    inner = u[:, None] * np.sqrt(1.0 - w**2)
    basis = np.array(
        [
            np.prod([(inner - other) / (node - other) for other in np.delete(u, i)], axis=0)
            for i, node in enumerate(u)
        ]
    )
    return np.asarray(2.0 * u[:, None] * np.einsum("jim,m->ij", basis, weights))
