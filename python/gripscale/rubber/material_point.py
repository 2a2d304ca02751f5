"""One incompressible material point of a rubber, driven through a history of stretch or shear.

The permanent network with its strain energy W and one temporary network per Maxwell element:

    tau_i dA_i/dt = C^-1 - A_i,   A_i = 1 before the first sample
    S = G_inf b + sum_i G_i A_i - p C^-1,   b = 2/G_inf dW/dC,   p from the free side faces

Source: J. Lubliner, Mech. Res. Commun. 12 (1985) 93, doi:10.1016/0093-6413(85)90075-8.
The memory integral is exact for C^-1 linear in time between samples (R. L. Taylor, K. S. Pister &
G. L. Goudreau, Int. J. Numer. Methods Eng. 2 (1970) 45, doi:10.1002/nme.1620020106):

    A <- e^-x A + ((1 - e^-x)/x - e^-x) Y_old + (1 - (1 - e^-x)/x) Y_new,   Y = C^-1,  x = dt/tau

Uniaxial stretch s:  P = dW/ds + sum_i G_i (s A_11 - s^-2 A_22),   Y_11 = s^-2,  Y_22 = s.
Simple shear g:      T = dW/dg + sum_i G_i (g + A_12),             Y_12 = -g,  Y_22 = A_22 = 1.

In simple shear the temporary networks are linear at any amplitude: T is then that of small strain.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.material import Rubber

Array = NDArray[np.float64]

_SMALL_STEP = 1e-3
"""Below this x = dt/tau the weights are taken from their power series (next term below 1e-14)."""


def uniaxial_stress(rubber: Rubber, time: ArrayLike, stretch: ArrayLike) -> Array:
    """Return the nominal stress [Pa] of a bar in uniaxial tension or compression.

    Parameters
    ----------
    rubber : Rubber
        Its bulk modulus is taken as infinite.
    time : array_like, shape (samples,)
        Times of the samples [s], not falling; two equal times make a step.
    stretch : array_like, shape (samples,)
        Deformed over undeformed length [-], above zero. Before the first sample the bar is at rest
        and undeformed: a first stretch other than 1 is a step.

    Returns
    -------
    ndarray, shape (samples,)
        Force over the undeformed cross-section.

    Raises
    ------
    InputError
        If a time falls, a stretch is not positive, or the lengths differ.
    """
    checks.instance("rubber", rubber, Rubber)
    ratio = checks.positive_vector("stretch", stretch)
    elapsed = _times(time, ratio, "stretch")
    permanent = rubber.strain_energy.uniaxial_factor(ratio) * (ratio - ratio**-2)
    temporary = uniaxial_network_stresses(rubber.relaxation_times, elapsed, ratio)
    equilibrium = rubber.equilibrium_shear_modulus
    return np.asarray(equilibrium * permanent + temporary @ rubber.shear_moduli)


def simple_shear_stress(rubber: Rubber, time: ArrayLike, shear: ArrayLike) -> Array:
    """Return the shear stress [Pa] of a block in simple shear; nominal and true stress agree.

    Parameters
    ----------
    rubber : Rubber
        Volume does not change, so its bulk modulus does not matter.
    time : array_like, shape (samples,)
        Times of the samples [s], not falling; two equal times make a step.
    shear : array_like, shape (samples,)
        Displacement over height [-]. Before the first sample the block is at rest and undeformed.

    Returns
    -------
    ndarray, shape (samples,)

    Raises
    ------
    InputError
        If a time falls, a value is not finite, or the lengths differ.
    """
    checks.instance("rubber", rubber, Rubber)
    amount = checks.vector("shear", shear)
    elapsed = _times(time, amount, "shear")
    permanent = rubber.strain_energy.shear_factor(amount) * amount
    states = network_states(rubber.relaxation_times, elapsed, -amount[:, None], rest=(0.0,))
    temporary = (amount[:, None] + states[..., 0]) @ rubber.shear_moduli
    return np.asarray(rubber.equilibrium_shear_modulus * permanent + temporary)


def uniaxial_network_stresses(relaxation_times: Array, time: Array, stretch: Array) -> Array:
    """Return s A_11 - s^-2 A_22, each temporary network's nominal stress over its shear modulus.

    `relaxation_times` [s] has shape (terms,), `time` [s] and `stretch` [-] have shape (samples,);
    the result [-] has shape (samples, terms).
    """
    inverse = np.column_stack([stretch**-2, stretch])
    states = network_states(relaxation_times, time, inverse, rest=(1.0, 1.0))
    return np.asarray(
        stretch[:, None] * states[..., 0] - (stretch**-2)[:, None] * states[..., 1], dtype=float
    )


def network_states(
    relaxation_times: Array, time: Array, inverse: Array, rest: tuple[float, ...]
) -> Array:
    """Return the states A_i of the temporary networks along a history, by the recurrence above.

    Parameters
    ----------
    relaxation_times : ndarray, shape (terms,)
        tau_i [s].
    time : ndarray, shape (samples,)
        Not falling [s].
    inverse : ndarray, shape (samples, components)
        Y, components of C^-1 [-].
    rest : tuple of float, length components
        The same components of the unit tensor: the state at the first time.

    Returns
    -------
    ndarray, shape (samples, terms, components)
    """
    step = np.diff(time)[:, None] / relaxation_times
    kept, (left, arrived) = np.exp(-step), _weights(step)
    states = np.empty((len(time), len(relaxation_times), inverse.shape[1]))
    states[0] = rest
    new = left[..., None] * inverse[:-1, None, :] + arrived[..., None] * inverse[1:, None, :]
    for sample in range(len(step)):
        states[sample + 1] = kept[sample, :, None] * states[sample] + new[sample]
    return states


def _weights(step: Array) -> tuple[Array, Array]:
    """Return the weights of Y at the start and at the end of steps x = dt/tau."""
    x = np.maximum(step, _SMALL_STEP)
    mean = -np.expm1(-x) / x
    small = step < _SMALL_STEP
    left = np.where(small, step * (0.5 - step * (1 / 3 - step / 8)), mean - np.exp(-x))
    arrived = np.where(small, step * (0.5 - step * (1 / 6 - step / 24)), 1.0 - mean)
    return left, arrived


def _times(time: ArrayLike, driven: Array, name: str) -> Array:
    elapsed = checks.vector("time", time, unit="s")
    if len(elapsed) != len(driven) or len(elapsed) == 0:
        raise InputError(
            f"time and {name} must have the same length, at least 1; "
            f"got {len(elapsed)} and {len(driven)}"
        )
    falls = np.diff(elapsed) < 0.0
    if falls.any():
        at = int(np.argmax(falls)) + 1
        raise InputError(f"time must not fall [s]; got {elapsed[at]:g} at index {at}")
    return elapsed
