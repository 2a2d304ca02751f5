"""Stress of a material point at finite strain.

The permanent network has the strain energy W; each Maxwell element is a temporary network:

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
from numpy.typing import ArrayLike

from gripscale.core import Array, checks
from gripscale.rubber.material import Rubber

# Below this x = dt/tau the weights are taken from their power series (next term below 1e-14).
_SMALL_STEP = 1e-3


def uniaxial_stress(rubber: Rubber, time: ArrayLike, stretch: ArrayLike) -> Array:
    """Return the nominal stress [Pa] of a bar in uniaxial tension or compression, shape (samples,).

    The bulk modulus is taken as infinite. Raises `InputError` if a time falls, a stretch is not
    positive, or the lengths differ.

    Parameters
    ----------
    time : array_like, shape (samples,)
        Times of the samples [s], not falling; two equal times make a step.
    stretch : array_like, shape (samples,)
        Deformed over undeformed length [-], above zero. Before the first sample the bar is at rest
        and undeformed: a first stretch other than 1 is a step.
    """
    checks.instance("rubber", rubber, Rubber)
    ratio = checks.positive_vector("stretch", stretch)
    elapsed = _times(time, ratio, "stretch")
    permanent = rubber.strain_energy.uniaxial_factor(ratio) * (ratio - ratio**-2)
    temporary = uniaxial_network_stresses(rubber.relaxation_times, elapsed, ratio)
    equilibrium = rubber.equilibrium_shear_modulus
    return np.asarray(equilibrium * permanent + temporary @ rubber.shear_moduli)


def simple_shear_stress(rubber: Rubber, time: ArrayLike, shear: ArrayLike) -> Array:
    """Return the shear stress [Pa] of a block in simple shear, nominal and true, shape (samples,).

    `shear` is displacement over height [-], shape (samples,). Volume does not change, so the bulk
    modulus does not matter; `time` and the rest before it are as in `uniaxial_stress`. Raises
    `InputError` if a time falls, a value is not finite, or the lengths differ.
    """
    checks.instance("rubber", rubber, Rubber)
    amount = checks.vector("shear", shear)
    elapsed = _times(time, amount, "shear")
    permanent = rubber.strain_energy.shear_factor(amount) * amount
    states = network_states(rubber.relaxation_times, elapsed, -amount[:, None], rest=(0.0,))
    temporary = (amount[:, None] + states[..., 0]) @ rubber.shear_moduli
    return np.asarray(rubber.equilibrium_shear_modulus * permanent + temporary)


def uniaxial_network_stresses(relaxation_times: Array, time: Array, stretch: Array) -> Array:
    """Return s A_11 - s^-2 A_22: nominal stress over shear modulus [-], shape (samples, terms)."""
    inverse = np.column_stack([stretch**-2, stretch])
    states = network_states(relaxation_times, time, inverse, rest=(1.0, 1.0))
    return np.asarray(
        stretch[:, None] * states[..., 0] - (stretch**-2)[:, None] * states[..., 1], dtype=float
    )


def network_states(
    relaxation_times: Array, time: Array, inverse: Array, rest: tuple[float, ...]
) -> Array:
    """Return the states A_i of the networks, (samples, terms, components), by the recurrence above.

    `inverse` are components of C^-1, (samples, components), `rest` those of the unit tensor.
    """
    step = np.diff(time)[:, None] / relaxation_times
    kept = np.exp(-step)
    # Weights of Y at the start and at the end of steps x = dt/tau.
    x = np.maximum(step, _SMALL_STEP)
    mean = -np.expm1(-x) / x
    small = step < _SMALL_STEP
    before = np.where(small, step * (0.5 - step * (1 / 3 - step / 8)), mean - np.exp(-x))
    after = np.where(small, step * (0.5 - step * (1 / 6 - step / 24)), 1.0 - mean)
    states = np.empty((len(time), len(relaxation_times), inverse.shape[1]))
    states[0] = rest
    new = before[..., None] * inverse[:-1, None, :] + after[..., None] * inverse[1:, None, :]
    for sample in range(len(step)):
        states[sample + 1] = kept[sample, :, None] * states[sample] + new[sample]
    return states


def _times(time: ArrayLike, driven: Array, name: str) -> Array:
    elapsed = checks.vector("time", time, unit="s")
    checks.same_length(1, time=elapsed, **{name: driven})
    falls = np.diff(elapsed, prepend=-np.inf) < 0.0
    checks.refuse_entries(elapsed, falls, "time must not fall [s]")
    return elapsed
