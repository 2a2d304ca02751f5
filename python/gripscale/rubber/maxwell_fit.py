"""The linear least-squares problem behind a Prony fit: non-negative moduli on given times.

Minimise over E_inf > 0, E_i >= 0 the relative errors of both moduli together,

    sum_rows (E'_fit/E' - 1)^2 + weight^2 (E''_fit/E'' - 1)^2 + smoothing^2 sum_i (second diff.)^2

where the second differences are of E_i / E'(1/tau_i): without them a non-negative fit turns a
smooth spectrum into spikes. Sources: M. Baumgaertel & H. H. Winter, Rheol. Acta 28 (1989) 511,
doi:10.1007/BF01332922 (relative errors of E' and E'' together); J. Honerkamp & J. Weese, Continuum
Mech. Thermodyn. 2 (1990) 17, doi:10.1007/BF01170953 (second differences as regularisation).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_LEAST_EQUILIBRIUM = 1e-3
"""E_inf is at least this share of the lowest storage modulus: a melt has none, a rubber must."""


@dataclass(frozen=True)
class Spectrum:
    """Moduli [Pa] on relaxation times [s]: E_inf, E_i and tau_i."""

    equilibrium: float
    moduli: Array
    times: Array

    def storage(self, omega: Array) -> Array:
        """Return E' [Pa] at `omega` [rad/s]."""
        return self.equilibrium + _storage_shapes(omega, self.times) @ self.moduli

    def loss(self, omega: Array) -> Array:
        """Return E'' [Pa] at `omega` [rad/s]."""
        return np.asarray(_loss_shapes(omega, self.times) @ self.moduli)


def relaxation_times(omega: Array, terms: int, extra_decades: float) -> Array:
    """Return `terms` log-spaced times [s] over the band of `omega` [rad/s] and beyond both ends."""
    low = -np.log10(omega.max()) - extra_decades
    high = -np.log10(omega.min()) + extra_decades
    if terms == 1:
        return np.array([10.0 ** (0.5 * (low + high))])
    return np.logspace(low, high, terms)


def fit_spectrum(
    omega: Array, storage: Array, loss: Array, times: Array, smoothing: float, loss_weight: float
) -> Spectrum:
    """Return the best non-negative moduli on the given `times` [s].

    `omega` [rad/s], `storage` and `loss` [Pa] have shape (rows,), `omega` ascending.
    """
    from scipy.optimize import nnls

    floor = _LEAST_EQUILIBRIUM * float(storage.min())
    scale = np.interp(-np.log(times), np.log(omega), storage)
    left = np.vstack(
        [
            np.column_stack([np.ones_like(storage), _storage_shapes(omega, times) * scale])
            / storage[:, None],
            np.column_stack([np.zeros_like(loss), _loss_shapes(omega, times) * scale])
            * (loss_weight / loss[:, None]),
            smoothing * _second_differences(len(times)),
        ]
    )
    unit = float(storage.min())
    left[:, 0] *= unit
    right = np.concatenate(
        [1.0 - floor / storage, np.full(len(loss), loss_weight), np.zeros(max(len(times) - 2, 0))]
    )
    solution, _ = nnls(left, right, maxiter=100 * left.shape[1])
    return Spectrum(floor + unit * float(solution[0]), solution[1:] * scale, times)


def _storage_shapes(omega: Array, times: Array) -> Array:
    phase = np.outer(omega, times)
    return np.asarray(1.0 - 1.0 / (1.0 + phase**2))


def _loss_shapes(omega: Array, times: Array) -> Array:
    phase = np.outer(omega, times)
    return np.asarray(phase / (1.0 + phase**2))


def _second_differences(terms: int) -> Array:
    """Return the matrix of second differences of the moduli; its first column (E_inf) is zero."""
    rows = max(terms - 2, 0)
    matrix = np.zeros((rows, terms + 1))
    for row in range(rows):
        matrix[row, row + 1 : row + 4] = 1.0, -2.0, 1.0
    return matrix
