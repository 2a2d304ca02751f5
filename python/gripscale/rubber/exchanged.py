"""Whether storage and loss modulus of a master curve stand in each other's place.

A linear solid that relaxes has E' = E_inf + sum E_i x^2/(1 + x^2), E'' = sum E_i x/(1 + x^2), with
x = w tau_i and no negative modulus (Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980),
ch. 3). The best such series is fitted to the two curves as they are and the other way round.
Rubbers miss the first by their scatter; exchanged, E' would fall beyond the transition while E''
rises, or E'' exceed E' many times on a plateau, which no such series does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.maxwell_fit import Curve, Prior, fit_spectrum, relaxation_times

_CERTAIN, _CERTAIN_RATIO = 0.5, 3.0
_LIKELY, _LIKELY_RATIO = 0.25, 2.0
"""Misfit as the curves are, and its ratio to that of the exchanged ones. Measured and synthetic
rubbers with ten per cent of noise and loss factors up to 2.7 have at most 0.16; exchanged, they
have 0.37 to 2.6, those with a loss factor of one all over less."""
_WORST = 3.0
"""Log error of a row that counts, at most: a modulus of zero has no logarithm."""
_TIMES_PER_DECADE, _MOST_TIMES = 2.0, 60
_BEYOND = 2.0
"""Decades of relaxation times beyond both ends: all that a band can tell of."""
_OVER_MEASURED = 100.0
"""Limit of the sum of all moduli over the largest measured: none in practice."""


@dataclass(frozen=True)
class Exchange:
    """Root mean square log misfit [-] of the best series to E' and E''."""

    as_given: float
    exchanged: float

    @property
    def certain(self) -> bool:
        """Whether the two are exchanged for sure."""
        return self.as_given > max(_CERTAIN, _CERTAIN_RATIO * self.exchanged)

    @property
    def likely(self) -> bool:
        """Whether it looks as if they were."""
        return self.as_given > max(_LIKELY, _LIKELY_RATIO * self.exchanged)

    def __str__(self) -> str:
        """Return both misfits in a sentence that says what to do."""
        return (
            "storage and loss modulus look exchanged: the nearest linear solid misses them by a "
            f"factor of {math.exp(self.as_given):.2f} as they are, by "
            f"{math.exp(self.exchanged):.2f} the other way round; look at the titles of the "
            "file, or name its columns (columns)"
        )


def exchange(master: MasterCurve) -> Exchange:
    """Return how well a linear solid has the moduli of `master` as they are, and exchanged."""
    omega = master.angular_frequency
    return Exchange(
        _misfit(Curve(omega, master.storage, master.loss)),
        _misfit(Curve(omega, master.loss, master.storage)),
    )


def _misfit(curve: Curve) -> float:
    decades = math.log10(curve.omega[-1] / curve.omega[0])
    terms = min(max(4, round(_TIMES_PER_DECADE * decades) + 1), _MOST_TIMES)
    limit = _OVER_MEASURED * float(max(curve.storage.max(), curve.loss.max()))
    times = relaxation_times(curve.omega, terms, _BEYOND)
    found = fit_spectrum(curve, times, Prior(0.0, 0.0, limit))
    with np.errstate(divide="ignore"):
        errors = np.log(
            [found.storage(curve.omega) / curve.storage, found.loss(curve.omega) / curve.loss]
        )
    return float(np.sqrt(np.mean(np.clip(errors, -_WORST, _WORST) ** 2)))
