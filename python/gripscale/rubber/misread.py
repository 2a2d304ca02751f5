"""Moduli that are those of no rubber: what the columns of a file may be instead.

A curve is in doubt if the nearest linear solid misses it by a factor of `math.exp(0.35)` = 1.42 in
the root mean square of E' and E''. Measured and synthetic rubbers with ten per cent of noise have
at most 0.16 (see `gripscale.rubber.prony_report`), a curve whose E'' is three times too large or
too small at every row has 0.35 to 0.5. Where E'' read as another quantity, or in another unit,
makes a linear solid of the same curve, that is the likely cause.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from gripscale.core.units import UNITS
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.maxwell_fit import Curve
from gripscale.rubber.prony_report import SwappedModuli, misfit

_NO_SOLID, _SOLID = 0.35, 0.16
"""Root mean square log misfit [-] above which a curve is in doubt; the most that rubbers have."""
_BETTER = 0.5
"""Misfit of a reading over that of exchanged moduli, below which it is the likelier cause."""
_SCATTER = 0.3
"""Relative scatter of E' about its neighbours that no measurement of one rubber has."""
_SOFTEST, _STIFFEST = 1e4, 2e10
"""Between these lies the largest E' of a rubber [Pa]: glassy polymers have up to 10 GPa."""


def moduli_doubts(master: MasterCurve, swapped: SwappedModuli, scatter: float) -> Iterator[str]:
    """Yield why the moduli of a master curve may be those of no rubber, a sentence each.

    `swapped` is how well a linear solid has them, `scatter` that of E' about its neighbours [-].
    """
    stiffest = float(master.storage.max())
    if not _SOFTEST <= stiffest <= _STIFFEST:
        yield (
            f"The largest E', {stiffest / 1e6:.3g} MPa, is that of no rubber: is the unit of the "
            "moduli right (modulus_unit)?"
        )
    if swapped.as_given <= _NO_SOLID:
        return
    cause = "E'' may be another quantity, or in another unit"
    if scatter > _SCATTER:
        cause = (
            f"rows of nearly one frequency differ by {scatter:.0%}, as of sweeps at several "
            "temperatures in one table"
        )
    elif reading := likely_reading(master, swapped):
        cause = f"E'' looks {reading}"
    elif swapped.likely:
        cause = "storage and loss modulus look exchanged"
    elif np.mean(master.loss > master.storage) > 0.5:
        cause = "E'' is larger than E' in most rows"
    yield (
        "E' and E'' do not belong to one rubber: the nearest linear solid misses them by a "
        f"factor of {math.exp(swapped.as_given):.2g}; {cause}; look at the titles and units of "
        "the file, or name its columns (columns)"
    )


def likely_reading(master: MasterCurve, swapped: SwappedModuli) -> str:
    """Return what E'' looks like, if a linear solid has it so; empty if it looks exchanged."""
    omega, storage, loss = master.angular_frequency, master.storage, master.loss
    readings = [("like one of a loss factor in %", 0.01 * loss)]
    units = sorted(set(UNITS["modulus"].values()))
    for unit in [*units, *(3.0 * unit for unit in units)]:  # a shear modulus was taken three times
        readings.append(("like the loss factor (tan delta)", storage * loss / unit))
    degrees = master.loss_factor
    if degrees.max() < 90.0:
        words = "like one of a phase angle in degrees, taken for the loss factor"
        readings.append((words, storage * np.tan(np.radians(degrees))))
    for ratio in (1e3, 1e6, 1e9):
        readings.append((f"{ratio:g} times too large", loss / ratio))
        readings.append((f"{ratio:g} times too small", loss * ratio))
    best, words = min((misfit(Curve(omega, storage, read)), words) for words, read in readings)
    return words if best < min(_SOLID, _BETTER * swapped.swapped) else ""
