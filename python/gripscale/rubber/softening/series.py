"""The softened rubber as a series: what the finite-strain block can be given.

The block needs E_inf and E_i, and with f and g apart no series has f E' and g E'' at all
frequencies. One that has them where a wave excites the rubber does: multipliers x_i >= 0 of all
moduli minimise

    sum_w w_1/w ((E'_x/(f E') - 1)^2 + (E''_x/(g E'') - 1)^2)
        + smoothing^2 sum_i (x_i+1 - x_i)^2 + keeping^2 sum_i (x_i - f)^2

over the frequencies w of the wave, w_1 its lowest. Slow terms, which carry E' and lose nothing
there, follow f; E_inf keeps at least a third of f of it. What the series misses is stated.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.rubber.material import Rubber
from gripscale.rubber.maxwell_shapes import loss_shape, storage_shape

Array = NDArray[np.float64]

SMOOTHING = 0.03
KEEPING = 0.02
LEAST = 1.0 / 3.0
"""Smallest multiplier of E_inf over f."""


@dataclass(frozen=True)
class SoftenedSeries:
    """A rubber with both moduli softened where it is excited."""

    rubber: Rubber
    misfit: float
    """Largest relative difference from f E' and g E'' at the lowest frequency asked for [-]."""
    misfit_of_all: float
    """The same at all frequencies asked for [-]."""


def softened(rubber: Rubber, storage: float, loss: float, omega: ArrayLike) -> SoftenedSeries:
    """Return `rubber` with E' times `storage` and E'' times `loss` at frequencies `omega`.

    Parameters
    ----------
    rubber : Rubber
        As measured, at small strain.
    storage, loss : float
        f and g [-], above zero.
    omega : array_like, shape (frequencies,)
        Where the factors must hold [rad/s]; none: all moduli times f (relaxed rubber).

    Raises
    ------
    InputError
        If a factor is not above zero or a frequency is not.
    """
    f, g = checks.positive("storage", storage), checks.positive("loss", loss)
    at = checks.positive_vector("omega", omega, unit="rad/s") if np.size(omega) else np.empty(0)
    if f == g or at.size == 0 or rubber.moduli.size == 0:
        return SoftenedSeries(_multiplied(rubber, np.full(rubber.moduli.size + 1, f)), 0.0, 0.0)
    order = np.argsort(rubber.relaxation_times)[::-1]
    rows = _rows(rubber, order, np.sort(at), f, g)
    multiplier = _multipliers(rows, np.sort(at), f)
    missed = np.abs(rows @ multiplier - 1.0).reshape(2, -1)
    own = np.empty(order.size + 1)
    own[0], own[1 + order] = multiplier[0], multiplier[1:]
    return SoftenedSeries(_multiplied(rubber, own), float(missed[:, 0].max()), float(missed.max()))


def _multipliers(rows: Array, omega: Array, f: float) -> Array:
    """Return x, of E_inf and then of the slowest term first."""
    from scipy.optimize import nnls  # half a second, which reading a case does not pay

    count = rows.shape[1]
    weight = np.tile(np.sqrt(omega[0] / omega), 2)
    steps = SMOOTHING * np.diff(np.eye(count), axis=0)
    system = np.vstack([weight[:, None] * rows, steps, KEEPING * np.eye(count)])
    right = np.concatenate([weight, np.zeros(count - 1), np.full(count, KEEPING * f)])
    least = np.zeros(count)
    least[0] = LEAST * f
    return np.asarray(nnls(system, right - system @ least)[0] + least)


def _rows(rubber: Rubber, order: NDArray[np.intp], omega: Array, f: float, g: float) -> Array:
    """Return the share each modulus, E_inf and then the slowest first, has in f E' and g E''."""
    modulus = rubber.complex_modulus(omega)
    phase = np.outer(omega, rubber.relaxation_times[order])
    storage = np.column_stack(
        [
            np.full(omega.size, rubber.equilibrium_modulus),
            storage_shape(phase) * rubber.moduli[order],
        ]
    )
    loss = np.column_stack([np.zeros(omega.size), loss_shape(phase) * rubber.moduli[order]])
    return np.vstack([storage / (f * modulus.real)[:, None], loss / (g * modulus.imag)[:, None]])


def _multiplied(rubber: Rubber, multiplier: Array) -> Rubber:
    kept = multiplier[1:] > 0.0
    return replace(
        rubber,
        equilibrium_modulus=rubber.equilibrium_modulus * float(multiplier[0]),
        moduli=(rubber.moduli * multiplier[1:])[kept],
        relaxation_times=rubber.relaxation_times[kept],
        admissible=None,
    )
