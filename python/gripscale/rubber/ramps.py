"""From temperature ramps at a few frequencies to frequency sweeps at nominal temperatures.

Along the rows of one frequency log E' and log E'' are interpolated linearly in temperature, within
what was measured, at multiples of a step.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.sweeps import Array, Sweeps, checked_rows
from gripscale.units import ZERO_CELSIUS

_ONE_FREQUENCY = 0.01
"""Frequencies that differ by less than this share are one."""
_LEAST_STEP = 0.01
_NEAR = 0.5
"""Distance of a row from a nominal temperature, over the step, so that it can be interpolated."""


def sweeps_from_ramps(
    temperature: ArrayLike,
    frequency: ArrayLike,
    storage: ArrayLike,
    loss: ArrayLike,
    *,
    step: float,
    name: str = "",
    source: str = "",
) -> Sweeps:
    """Return sweeps at nominal temperatures from rows measured while the temperature ran.

    Parameters
    ----------
    temperature, frequency, storage, loss : array_like, shape (rows,)
        As for `Sweeps`: [K], [Hz], [Pa], [Pa].
    step : float
        Distance of the nominal temperatures [K], which are its multiples in degrees Celsius. No
        smaller than the steps of the ramp, or rows are used twice.
    name, source : str
        Carried along.

    Raises
    ------
    InputError
        As `Sweeps` does; if `step` is not above zero, or no frequency was measured at two
        temperatures with a nominal one in between.
    """
    rows = checked_rows(temperature, frequency, storage, loss)
    step = checks.positive("step", step, unit="K")
    if step < _LEAST_STEP:
        raise InputError(f"step must be at least {_LEAST_STEP:g} K; got {step:g}")
    group = _frequencies(rows["frequency"])
    found = [_at_steps(rows, group == one, step) for one in range(int(group.max()) + 1)]
    together = np.concatenate(found, axis=1)
    if not together.size:
        low, high = rows["temperature"].min(), rows["temperature"].max()
        raise InputError(
            f"step [K] must put a nominal temperature between the {low:.2f} and {high:.2f} K "
            f"measured; got {step:g}"
        )
    kelvin, hertz, real, imaginary = together
    return Sweeps(kelvin, hertz, real, imaginary, 0.5 * step, name, source)


def _frequencies(frequency: Array) -> Array:
    """Return which of the frequencies each row belongs to."""
    order = np.argsort(frequency, kind="stable")
    apart = np.diff(np.log(frequency[order]), prepend=np.log(frequency[order[0]])) > _ONE_FREQUENCY
    group = np.empty(len(frequency), dtype=int)
    group[order] = np.cumsum(apart)
    return group


def _at_steps(rows: dict[str, Array], chosen: Array, step: float) -> Array:
    """Return temperature, frequency, E' and E'' of one frequency at nominal temperatures."""
    order = np.argsort(rows["temperature"][chosen], kind="stable")
    celsius, frequency, storage, loss = (
        rows[key][chosen][order] for key in ("temperature", "frequency", "storage", "loss")
    )
    celsius = celsius - ZERO_CELSIUS
    first, last = np.ceil(celsius[0] / step - 1e-9), np.floor(celsius[-1] / step + 1e-9)
    nominal = step * np.arange(first, last + 1.0)
    away = np.abs(np.subtract.outer(nominal, celsius)).min(axis=1, initial=np.inf)
    nominal = nominal[away <= _NEAR * step]
    return np.array(
        [
            nominal + ZERO_CELSIUS,
            np.full(len(nominal), np.exp(np.log(frequency).mean())),
            np.exp(np.interp(nominal, celsius, np.log(storage))),
            np.exp(np.interp(nominal, celsius, np.log(loss))),
        ]
    )
