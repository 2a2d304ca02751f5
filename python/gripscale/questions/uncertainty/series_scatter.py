"""Prony series that a master curve leaves open: scatter of its rows, and what lies beyond its ends.

The series is fitted anew to disturbed equations (randomise, then optimise; J. M. Bardsley, A.
Solonen, H. Haario & M. Laine, SIAM J. Sci. Comput. 36 (2014) A1895, doi:10.1137/140964023). What
disturbs them is in docs/derivations.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gripscale.core.arrays import Array
from gripscale.rubber import MasterCurve, PronyFit
from gripscale.rubber.maxwell_fit import (
    LEAST_SCATTER,
    Curve,
    Equations,
    MaxwellSpectrum,
    non_negative,
)
from gripscale.rubber.prony import DECADES_BEYOND, largest_modulus, open_equations

_FEWEST_BLOCKS = 8  # blocks there are at least to draw from
# Fits after which the scatter, in whose units the equations are, is that about their solution.
_PASSES = 3
# Weight of a row over the largest, from which on it counts: the series of a case misses the others,
# and draws that follow them would not lie about it.
LEAST_WEIGHT = 0.3
MOST_TAKEN = 0.75  # share of the degrees of freedom a fit is believed to take at most


@dataclass(frozen=True, eq=False)
class SeriesScatter:
    """The equations of a fit in units of the scatter of its rows."""

    problem: Equations
    """Of `open_equations`: first all rows of E', then those of E'', of the prior, and one limit."""
    omega: Array
    """Angular frequency of the measured rows [rad/s], rising, shape (rows,)."""

    @classmethod
    def of(cls, master: MasterCurve, fit: PronyFit, bulk_modulus: float) -> SeriesScatter:
        """Return what a master curve leaves open beside the fit that was made of it.

        Parameters
        ----------
        master : MasterCurve
            As measured; the rows the fit has left out do not count.
        fit : PronyFit
            The report of `fit_prony_report` on it.
        bulk_modulus : float
            Of the rubber [Pa]; it limits the sum of the moduli.
        """
        kept = ~np.isin(master.frequency, fit.outlier_frequency)
        curve = Curve(master.angular_frequency, master.storage, master.loss).rows(kept)
        if fit.problem is not None:
            weight = np.broadcast_to(fit.problem.row_weight, curve.omega.shape)
            counted = weight > LEAST_WEIGHT * weight.max()
            curve = curve.rows(counted) if counted.sum() > 2 * _FEWEST_BLOCKS else curve
        limit = largest_modulus(float(curve.storage.max()), bulk_modulus)
        scatter = fit.rms_storage, fit.rms_loss
        for _ in range(_PASSES):
            unit = max(scatter[0], LEAST_SCATTER), max(scatter[1], LEAST_SCATTER)
            equations = open_equations(curve, unit, DECADES_BEYOND, limit)
            band = cls(equations, curve.omega)
            # the fit has taken of the scatter, by its degrees of freedom
            taken = min(np.count_nonzero(band.best) / (2 * len(curve.omega)), MOST_TAKEN)
            rms = np.sqrt(np.mean(band._errors**2, axis=0)) / math.sqrt(1.0 - taken)
            scatter = float(rms[0] * unit[0]), float(rms[1] * unit[1])
        return band

    @cached_property
    def best(self) -> Array:
        """The solution of the equations as they stand."""
        return non_negative(self.problem.matrix, self.problem.right)

    @cached_property
    def _errors(self) -> Array:
        """Errors of E' and E'' of each row about the best series, shape (rows, 2)."""
        rows = 2 * len(self.omega)
        error = (self.problem.right - self.problem.matrix @ self.best)[:rows]
        return error.reshape(2, -1).T

    @cached_property
    def _residuals(self) -> Array:
        """Errors to be drawn from, shape (rows, 2), of mean zero and rms one."""
        error = self._errors - self._errors.mean(axis=0)
        rms = np.sqrt(np.mean(error**2, axis=0))
        return np.asarray(error / np.where(rms > 0.0, rms, 1.0))

    @cached_property
    def _block(self) -> int:
        """Rows in a block: as far as errors go together, (1 + r)/(1 - r) by their lag-one r.

        Longer ones would be too quiet: the fit has taken from the errors what is slow in them.
        """
        error = self._residuals
        together = float(np.mean(error[1:] * error[:-1]))
        most = max(1, len(error) // _FEWEST_BLOCKS)
        together = min(max(together, 0.0), 1.0 - 2.0 / (most + 1.0))
        return round((1.0 + together) / (1.0 - together))

    @cached_property
    def _beyond(self) -> Array:
        """Return one for each row of the prior on relaxations beyond the ends, zero for others."""
        rate = 1.0 / self.problem.times
        outside = (rate < self.omega[0]) | (rate > self.omega[-1])
        prior = self.problem.matrix[2 * len(self.omega) : -1, 1:-1]
        return np.asarray((np.abs(prior) @ outside > 0.0).astype(float))

    def draw(self, random: np.random.Generator) -> MaxwellSpectrum:
        """Return the spectrum of one disturbed fit."""
        rows, block = len(self.omega), self._block
        first = random.integers(rows, size=-(-rows // block))
        order = ((first[:, None] + np.arange(block)) % rows).ravel()[:rows]
        noise = random.standard_normal(len(self._beyond)) * self._beyond
        errors = np.concatenate([self._residuals[order].T.ravel(), noise, [0.0]])
        return self.problem.spectrum(non_negative(self.problem.matrix, self.problem.right + errors))
