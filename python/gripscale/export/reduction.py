"""A Prony series of fewer terms, or for a band of frequencies, with what it misses.

    E(w) = E_inf + sum_i E_i i w t_i/(1 + i w t_i),    E_inf, E_i >= 0
    min sum_k (E'(w_k)/E'_k - 1)^2 + (E''(w_k)/E''_k - 1)^2

over frequencies w_k of the band, with times t_i at equal ratios over the band and half a decade
beyond both of its ends. Slower elements become part of E_inf, faster ones are left out.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import nnls

from gripscale.core import InputError, RubberWarning, checks
from gripscale.rubber import Rubber

_MARGIN = 10.0**0.5  # how far the times reach beyond the band, as a ratio
_PER_DECADE = 20  # frequencies at which the moduli are compared
MOST_TERMS = 200


@dataclass(frozen=True)
class Reduction:
    """A rubber with another Prony series, and what this misses within a band."""

    rubber: Rubber  # the rubber; its `valid_band` is the band [rad/s]
    storage: float  # largest relative error of E' within the band
    loss: float  # largest relative error of E''
    loss_factor: float  # largest relative error of E''/E'

    def __str__(self) -> str:
        low, high = (end / (2.0 * math.pi) for end in self.rubber.valid_band or (0.0, math.inf))
        return (
            f"Reduced to {len(self.rubber.moduli)} Maxwell elements for {low:.4g} to {high:.4g} "
            f"Hz; largest errors there: E' {self.storage:.2%}, E'' {self.loss:.2%}, loss factor "
            f"{self.loss_factor:.2%}"
        )


def reduced(
    rubber: Rubber, *, band: tuple[float, float] | None = None, terms: int | None = None
) -> Reduction:
    """Return a rubber with fewer terms, for a band of frequencies.

    The `band` [Hz] is by default what the numbers rest on, or all terms; the number of Maxwell
    elements, `terms`, 1 to 200, is by default that of the rubber in the band. Raises `InputError`
    if an argument is out of range, or the rubber is elastic.
    """
    checks.instance("rubber", rubber, Rubber)
    if not len(rubber.moduli):
        raise InputError("rubber must have Maxwell elements to be reduced; got an elastic one")
    rates = 1.0 / np.asarray(rubber.relaxation_times)
    low, high = rubber.valid_band or (float(rates.min()), float(rates.max()))
    if band is not None:
        low, high = (2.0 * math.pi * end for end in checks.interval("band", band, unit="Hz"))
    inside = int(((rates >= low) & (rates <= high)).sum())
    count = max(inside, 1)
    if terms is not None:
        count = checks.whole("terms", terms, least=1, most=MOST_TERMS)
    ends = (1.0 / (_MARGIN * high), _MARGIN / low)
    times = np.geomspace(*ends, count) if count > 2 else np.geomspace(*ends, count + 2)[1:-1]
    omega = np.geomspace(low, high, max(2, round(_PER_DECADE * math.log10(high / low))))
    exact = rubber.complex_modulus(omega)
    phase = 1j * omega[:, None] * times
    columns = np.column_stack([np.ones_like(omega), phase / (1.0 + phase)])
    parts = [columns.real / exact.real[:, None], columns.imag / exact.imag[:, None]]
    solution, _ = nnls(np.concatenate(parts), np.ones(2 * omega.size))
    kept = solution[1:] > 0.0
    if not solution[0] > 0.0:
        raise InputError(
            f"terms must be enough for E' at the slow end of the band; {count} leave no "
            "equilibrium modulus"
        )
    with warnings.catch_warnings():  # of a bulk modulus that the rubber has already
        warnings.simplefilter("ignore", RubberWarning)
        fewer = replace(
            rubber,
            equilibrium_modulus=float(solution[0]),
            moduli=solution[1:][kept],
            relaxation_times=times[kept],
            valid_band=(low, high),
            admissible=None,
        )
        modulus = fewer.complex_modulus(omega)
        factor = (modulus.imag / modulus.real) / (exact.imag / exact.real)
        ratios = modulus.real / exact.real, modulus.imag / exact.imag, factor
        reduction = Reduction(fewer, *(float(np.abs(ratio - 1.0).max()) for ratio in ratios))
        source = f"{rubber.source}; {reduction}" if rubber.source else str(reduction)
        return replace(reduction, rubber=replace(fewer, source=source))
