"""Rubber of finite thickness on a rigid base, in one layer or in several: its compliance K(q).

A harmonic pressure p exp(i q . r) without shear lifts the free surface by u = K(q) p. One layer of
thickness d, with s = |q| d, shear modulus G and Poisson's ratio nu, complex at the frequency:

    K = (1 - nu) / (G |q|) F,    F = N / D,
    N = (3 - 4 nu) sinh 2s - 2s,    D = (3 - 4 nu) cosh 2s + 2 s^2 + 5 - 12 nu + 8 nu^2

M. Hannah, Q. J. Mech. Appl. Math. 4 (1951) 94; F. Bentall & K. L. Johnson, Int. J. Mech. Sci. 10
(1968) 637. N and D are multiplied by exp(-2s). Several layers join by the stiffness of their faces:
E. Kausel & J. M. Roesset, Bull. Seismol. Soc. Am. 71 (1981) 1743, at rest; see docs/method.md.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, ComplexArray, InputError, checked, checks, readable
from gripscale.core.arrays import Quantity
from gripscale.rubber import Rubber
from gripscale.rubber.material import plane_strain_modulus_of

_ROWS = 2**14  # waves at once: their matrices take about 10 MB
_TERMS = 8  # of the series of sinh x - x below x = 1: the next is below 1e-16 of the sum


def _pairs(name: str, value: Any) -> tuple[tuple[Rubber, float], ...]:
    """Return rubbers with their thicknesses [m]; raise `InputError` for anything else."""
    pairs = value if isinstance(value, list | tuple) else []
    if not pairs or not all(isinstance(pair, list | tuple) and len(pair) == 2 for pair in pairs):
        raise InputError(
            f"{name} must be pairs of a Rubber and its thickness [m], the layer in contact first; "
            f"got {checks.short_repr(value)}"
        )
    return tuple(
        (
            checks.instance(f"rubber of layer {number}", rubber, Rubber),
            checks.positive(f"thickness of layer {number}", thickness, unit="m"),
        )
        for number, (rubber, thickness) in enumerate(pairs)
    )


class Layers(Checked):
    """Layers of rubber on a rigid base, bonded to one another.

    Raises `InputError` unless there is at least one layer, each a `Rubber` and a thickness above
    zero.

        >>> gs.Layers([(rubber, "4 mm"), (rubber, "6 mm")]).thicknesses
        [0.004, 0.006]
    """

    layers: Sequence[tuple[Rubber, Quantity]] = checked(_pairs)
    """Rubber and thickness [m] of each layer, that in contact first."""

    def __len__(self) -> int:
        return len(self.layers)

    def __iter__(self) -> Iterator[tuple[Rubber, float]]:
        return iter(self.layers)

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield thickness and rubber of each layer, that in contact is layer 0."""
        for number, (rubber, thickness) in enumerate(self):
            yield f"layer {number}", f"{readable(thickness, 'm')} of {rubber.name or 'rubber'}"

    @property
    def rubbers(self) -> list[Rubber]:
        """Rubber of each layer, that in contact first."""
        return [rubber for rubber, _ in self.layers]

    @property
    def thicknesses(self) -> list[float]:
        """Thickness of each layer [m], that in contact first."""
        return [thickness for _, thickness in self.layers]


def shear_and_compression(modulus: ComplexArray, bulk: float) -> tuple[ComplexArray, ComplexArray]:
    """Return G [Pa] and the complex 1 - 2 nu [-] of E* = 3 G and the bulk modulus [Pa]."""
    shear = modulus / 3.0
    return shear, 3.0 * shear / (3.0 * bulk + shear)


def _sinh_less(x: Array) -> Array:
    """Return exp(-x) (sinh x - x) of x not negative, to its last digits."""
    small = np.minimum(x, 1.0)
    term = small**3 / 6.0
    series = np.zeros_like(small)
    for number in range(_TERMS):
        series += term
        term = term * small**2 / ((2 * number + 4) * (2 * number + 5))
    large = np.maximum(x, 1.0)
    whole = -0.5 * np.expm1(-2.0 * large) - large * np.exp(-large)
    return np.where(x < 1.0, np.exp(-small) * series, whole)


def thickness_factor(depth: Array, compression: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return F [-] of one layer and d ln F / d nu [-].

    `depth` is |q| d [-], above zero; `compression` is 1 - 2 nu [-]; broadcast together.
    """
    x = 2.0 * depth
    decay, difference = np.exp(-x), _sinh_less(x)
    cosh = 0.5 * (1.0 + np.exp(-2.0 * x))
    stiff = 1.0 + 2.0 * compression  # 3 - 4 nu
    # 5 - 12 nu + 8 nu^2 = 1 + 2 c + 2 c^2 with c = 1 - 2 nu
    rest = 2.0 * depth**2 + 1.0 + 2.0 * compression * (1.0 + compression)
    above = stiff * difference + 2.0 * compression * x * decay
    below = stiff * cosh + rest * decay
    # by c: d/d nu = -2 d/d c
    slope_above = 2.0 * difference + 2.0 * x * decay
    slope_below = 2.0 * cosh + (2.0 + 4.0 * compression) * decay
    slope = -2.0 * (slope_above / above - slope_below / below)
    deep = decay == 0.0
    return np.where(deep, 1.0, above / below), np.where(deep, 0.0, slope)


def effective_modulus(
    rubber: Rubber, omega: ArrayLike, number: ArrayLike, thickness: float | None
) -> ComplexArray:
    """Return 2/(|q| K) [Pa] of waves |q| [rad/m] at omega [rad/s], on a rigid base.

    E/(1 - nu^2) without a `thickness` [m], that of a half-space. Arrays broadcast together.
    """
    young = rubber.complex_modulus(omega)
    modulus = plane_strain_modulus_of(young, rubber.bulk_modulus)
    if thickness is None:
        return modulus
    compression = shear_and_compression(young, rubber.bulk_modulus)[1]
    return np.asarray(modulus / thickness_factor(np.multiply(number, thickness), compression)[0])


def _layer_stiffness(depth: Array, shear: ComplexArray, compression: ComplexArray) -> ComplexArray:
    """Return the stiffness of a layer over |q| [Pa], shape (waves, 4, 4); lower face first."""
    displacement = np.empty((depth.size, 4, 4), dtype=complex)
    traction = np.empty_like(displacement)
    stiff = 1.0 + 2.0 * compression  # 3 - 4 nu
    decay = np.exp(-depth)
    zero, full = np.zeros_like(depth), np.ones_like(depth)
    for column, sign in ((0, 1.0), (2, -1.0)):
        # growing solutions are one at the upper face, decaying ones at the lower face
        faces = ((-depth, decay), (zero, full)) if sign > 0.0 else ((zero, full), (depth, decay))
        for row, (height, size) in zip((0, 2), faces, strict=True):
            outward = -1.0 if row == 0 else 1.0
            constant, linear = column, column + 1
            displacement[:, row, constant] = size
            displacement[:, row + 1, constant] = sign * size
            displacement[:, row, linear] = height * size
            displacement[:, row + 1, linear] = (sign * height - stiff) * size
            traction[:, row, constant] = outward * 2.0 * sign * size
            traction[:, row + 1, constant] = outward * 2.0 * size
            # 1 - (3 - 4 nu) = -2 c, and -4 + 4 nu = -2 (1 + c), with c = 1 - 2 nu
            tangential, normal = -2.0 * compression, -2.0 * sign * (1.0 + compression)
            traction[:, row, linear] = outward * (tangential + 2.0 * sign * height) * size
            traction[:, row + 1, linear] = outward * (normal + 2.0 * height) * size
    transposed = np.linalg.solve(displacement.swapaxes(1, 2), traction.swapaxes(1, 2))
    return shear[:, None, None] * transposed.swapaxes(1, 2)


def _stack_losses(
    number: Array, moduli: Sequence[ComplexArray], bulk: Sequence[float], thickness: Sequence[float]
) -> tuple[ComplexArray, Array]:
    """Return K(q) [m/Pa] of some waves, and what of Im K each layer loses, (layers, waves)."""
    lower: ComplexArray | None = None
    steps = []
    for modulus, bulk_modulus, height in reversed(list(zip(moduli, bulk, thickness, strict=True))):
        stiffness = _layer_stiffness(number * height, *shear_and_compression(modulus, bulk_modulus))
        upper = stiffness[:, 2:, 2:]
        if lower is not None:
            follows = -np.linalg.solve(stiffness[:, :2, :2] + lower, stiffness[:, :2, 2:])
            upper = upper + stiffness[:, 2:, :2] @ follows
            steps.append((follows, lower))
        lower = upper
    assert lower is not None
    load = np.zeros((number.size, 2, 1), dtype=complex)
    load[:, 1] = 1.0
    surface = np.linalg.solve(lower, load)
    compliance = surface[:, 1, 0] / number
    displacement, work = surface, [compliance.imag]
    for follows, below in reversed(steps):
        displacement = follows @ displacement
        power = (displacement.conj().swapaxes(1, 2) @ (below @ displacement))[:, 0, 0]
        work.append(-power.imag / number)
    work.append(np.zeros(number.size))
    return np.asarray(compliance), np.asarray(-np.diff(np.array(work), axis=0))


def stack_compliance(
    number: Array, moduli: Sequence[ComplexArray], bulk: Sequence[float], thickness: Sequence[float]
) -> tuple[ComplexArray, Array]:
    """Return K(q) [m/Pa] of layers, and what of Im K each layer loses, shape (layers, *waves).

    `number` is |q| [rad/m], above zero; `moduli` are E* [Pa] of each layer, that in contact first,
    broadcastable to the waves; `bulk` and `thickness` are their bulk moduli [Pa] and heights [m].
    """
    waves = [np.broadcast_to(modulus, number.shape).reshape(-1) for modulus in moduli]
    flat = number.reshape(-1)
    parts = [
        _stack_losses(flat[at : at + _ROWS], [w[at : at + _ROWS] for w in waves], bulk, thickness)
        for at in range(0, flat.size, _ROWS)
    ]
    compliance = np.concatenate([part[0] for part in parts]).reshape(number.shape)
    losses = np.concatenate([part[1] for part in parts], axis=1)
    return compliance, losses.reshape(len(moduli), *number.shape)
