"""Where a Prony series misses its master curve by more than the scatter, and by how much.

Local: means over nine neighbouring rows, whose own scatter is a third of a row's. Where even the
best non-negative series misses them, the measured E' and E'' are not those of one linear solid (the
Kramers-Kronig relation ties each to the other): vertical shifts left out, strain amplitudes that
differ between sets, or a non-linear filler network are the usual causes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber.maxwell_fit import Curve

Array = NDArray[np.float64]

_WINDOW = 9
_ALLOWED = 1.5
"""Local mean over scatter that is believed: four and a half times its own scatter."""
END_ROWS = 5


@dataclass(frozen=True)
class Misfit:
    """A range of frequencies, and the largest local mean of fit over data less one in it."""

    low: float
    """Lowest angular frequency [rad/s]."""
    high: float
    """Highest angular frequency [rad/s]."""
    storage: float
    """Of E' [-], negative where the fit is below the data."""
    loss: float
    """Of E'' [-]."""

    def __str__(self) -> str:
        """Return the range and both misfits in words."""
        return (
            f"{self.low:.3g} to {self.high:.3g} rad/s "
            f"(E' {self.storage:+.0%}, E'' {self.loss:+.0%})"
        )


def local_misfits(
    curve: Curve, modulus: NDArray[np.complex128], scatter: tuple[float, float]
) -> tuple[Misfit, ...]:
    """Return where the local mean of `modulus` over `curve` less one exceeds the scatter [-].

    `modulus` is E* of the fit [Pa] at the rows of the curve.
    """
    local = [_local_mean(error) for error in _errors(curve, modulus)]
    beyond = [np.abs(mean) > _ALLOWED * one for mean, one in zip(local, scatter, strict=True)]
    return tuple(
        Misfit(
            float(curve.omega[first]),
            float(curve.omega[last]),
            _largest(local[0][first : last + 1]),
            _largest(local[1][first : last + 1]),
        )
        for first, last in _runs(beyond[0] | beyond[1])
    )


def end_misfits(
    curve: Curve, modulus: NDArray[np.complex128], scatter: tuple[float, float]
) -> tuple[Misfit | None, Misfit | None]:
    """Return the mean misfit of the first and of the last five rows, None within the scatter."""
    errors = _errors(curve, modulus)
    found: list[Misfit | None] = []
    for rows in (slice(None, END_ROWS), slice(-END_ROWS, None)):
        omega = curve.omega[rows]
        storage, loss = (float(error[rows].mean()) for error in errors)
        missed = abs(storage) > scatter[0] or abs(loss) > scatter[1]
        one = Misfit(float(omega[0]), float(omega[-1]), storage, loss)
        found.append(one if missed else None)
    return found[0], found[1]


def _errors(curve: Curve, modulus: NDArray[np.complex128]) -> tuple[Array, Array]:
    return modulus.real / curve.storage - 1.0, modulus.imag / curve.loss - 1.0


def _local_mean(error: Array) -> Array:
    """Return the mean of each row and its neighbours, of as many near the ends."""
    size = min(_WINDOW, len(error))
    means = np.convolve(error, np.full(size, 1.0 / size), mode="valid")
    start = np.arange(len(error)) - size // 2
    return np.asarray(means[np.clip(start, 0, len(means) - 1)])


def _largest(values: Array) -> float:
    return float(values[np.argmax(np.abs(values))])


def _runs(chosen: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first and last row of each run, runs with at most two rows between as one."""
    rows = np.flatnonzero(chosen)
    if not rows.size:
        return []
    breaks = np.flatnonzero(np.diff(rows) > 3)
    first = rows[np.concatenate([[0], breaks + 1])]
    last = rows[np.concatenate([breaks, [len(rows) - 1]])]
    return list(zip(first.tolist(), last.tolist(), strict=True))
