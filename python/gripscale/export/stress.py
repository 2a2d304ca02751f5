"""The stress in the block of a wave, from its deformed mesh and the material law: no new solution.

    P = J^(-2/3) (F H - 1/3 (H : C) F^-T) + p J F^-T,   sigma = P F^T / J
    H = G_inf b + (G(t) - G_inf) 1 + T^-1{ (G(t) - G*(w_k)) T{Y} },   Y = J^(2/3) C^-1

with b = 2 dW/dCbar of a unit shear modulus, T the Fourier series along a line of equally placed
Gauss points (its mean not counted), w_k = 2 pi k v/wavelength, t the load time, and for p the
projection of K (J - 1) on the pressure modes of the element. At rest H = G_inf b. These are the
equations the kernel solves (rust/material), so that nodal forces vanish in the block to its
residual. Source: Lubliner, Mech. Res. Commun. 12 (1985) 93; Holzapfel, Nonlinear Solid Mechanics
(2000), section 6.4.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.export.reference_block import ReferenceBlock
from gripscale.rubber import Rubber
from gripscale.wave import Status, WaveResult

Array = NDArray[np.float64]

EQUILIBRIUM = (Status.CONVERGED, Status.TOLERANCE_NOT_MET, Status.FRICTIONS_DISAGREE)
"""Endings of a wave in which the forces on its nodes vanish."""


@dataclass(frozen=True)
class BlockStress:
    """Deformation and stress at the Gauss points of the block.

    Axes are element rows, contact surface first, columns, points across and points along an
    element.
    """

    block: ReferenceBlock = field(repr=False)
    gradient: Array = field(repr=False)
    """F, shape (rows, columns, across, along, 2, 2), components (x, z)."""
    pressure: Array = field(repr=False)
    """Volumetric stress p [Pa], positive in tension, shape (rows, columns, across, along)."""
    cauchy: Array = field(repr=False)
    """sigma [Pa], shape (..., 3, 3), components (x, y, z); y is across the plane of strain."""

    @property
    def jacobian(self) -> Array:
        """J = det F, shape (rows, columns, across, along)."""
        return np.asarray(np.linalg.det(self.gradient))

    def element_mean(self, values: Array) -> Array:
        """Return the mean of values at the points over each deformed element.

        Shape (rows, columns, ...).
        """
        volume = self.block.weights * self.jacobian
        extra = (None,) * (values.ndim - 4)
        total = (volume[(..., *extra)] * values).sum(axis=(2, 3))
        return np.asarray(total / volume.sum(axis=(2, 3))[(..., *extra)])


def block_stress(result: WaveResult) -> BlockStress:
    """Return the stress in the block of a wave.

    Parameters
    ----------
    result : WaveResult
        Of the finite-strain block, solved or read from a file, with its mesh and its rubber.

    Returns
    -------
    BlockStress
        What the material law gives for the deformed mesh: the stress of the solver, as far as it
        found one.

    Raises
    ------
    InputError
        If the wave has no mesh or no rubber, or no equilibrium was found.
    """
    checks.instance("result", result, WaveResult)
    block = ReferenceBlock.of(result)
    if result.status not in EQUILIBRIUM or result.rubber is None or result.deformed_mesh is None:
        raise InputError(
            "result must be in equilibrium and have its rubber for the stress to be known; got a "
            f"wave with status {result.status}"
        )
    gradient = block.gradients(*result.deformed_mesh)
    volume = np.linalg.det(gradient)
    pressure = _pressure(block, volume, result.rubber.bulk_modulus)
    full = _three_dimensional(gradient)
    right = np.swapaxes(full, -1, -2) @ full
    factor = (volume ** (-2.0 / 3.0))[..., None, None]
    history = _networks(result.rubber, factor * right)
    if result.speed > 0.0 and len(result.rubber.moduli):
        history = history + _remembered(result, np.linalg.inv(factor * right))
    pushed = factor * (full @ history @ np.swapaxes(full, -1, -2))
    trace = np.trace(pushed, axis1=-2, axis2=-1)[..., None, None]
    deviator = (pushed - trace / 3.0 * np.eye(3)) / volume[..., None, None]
    return BlockStress(block, gradient, pressure, deviator + pressure[..., None, None] * np.eye(3))


def _pressure(block: ReferenceBlock, volume: Array, bulk: float) -> Array:
    """Return p = K (J - 1) projected on the pressure modes of each element."""
    modes, weights = block.modes(), block.weights
    change = np.einsum("rcpq,rcpq,mpq->rcm", *np.broadcast_arrays(weights, volume - 1.0), modes)
    mass = np.einsum("rcpq,mpq->rcm", weights, modes**2)
    return np.asarray(bulk * np.einsum("rcm,mpq->rcpq", change / mass, modes))


def _three_dimensional(gradient: Array) -> Array:
    """Return F with components (x, y, z), of plane strain."""
    full = np.zeros((*gradient.shape[:-2], 3, 3))
    full[..., 1, 1] = 1.0
    full[..., ::2, ::2] = gradient
    return full


def _networks(rubber: Rubber, isochoric: Array) -> Array:
    """Return G_inf b of the permanent network, b = w1 1 + w2 (I1 1 - Cbar)."""
    first = np.trace(isochoric, axis1=-2, axis2=-1)
    second = 0.5 * (first**2 - np.einsum("...ij,...ij->...", isochoric, isochoric))
    w1, w2 = rubber.strain_energy.slopes(first - 3.0, second - 3.0)
    one = (w1 + w2 * first)[..., None, None] * np.eye(3)
    b = one - w2[..., None, None] * isochoric
    return np.asarray(rubber.equilibrium_shear_modulus * b)


def _remembered(result: WaveResult, inverse: Array) -> Array:
    """Return what the temporary networks add to H, from Y = Cbar^-1 along the lines of points."""
    assert result.rubber is not None
    columns = inverse.shape[1]
    omega = result.angular_frequency * np.arange(1, columns // 2 + 1)
    mean = float(result.rubber.relaxation_modulus(result.load_time)) / 3.0
    factor = np.zeros(columns // 2 + 1, dtype=complex)
    factor[1:] = mean - result.rubber.complex_modulus(omega) / 3.0
    harmonics = np.fft.rfft(inverse, axis=1) * factor[:, None, None, None, None]
    frozen = mean - result.rubber.equilibrium_shear_modulus
    return np.asarray(np.fft.irfft(harmonics, columns, axis=1) + frozen * np.eye(3))
