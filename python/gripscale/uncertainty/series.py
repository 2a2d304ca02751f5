"""Prony series that a master curve leaves open: scatter of its rows, and what lies beyond its ends.

The series is fitted anew to disturbed equations (randomise, then optimise; J. M. Bardsley, A.
Solonen, H. Haario & M. Laine, SIAM J. Sci. Comput. 36 (2014) A1895, doi:10.1137/140964023: for
linear equations with Gaussian errors an exact draw of what is known after the measurement, here up
to the moduli not being negative). With the rows of `maxwell_fit` in units of the scatter,

    minimise |A z - (b + e)|^2,    z >= 0,

- e of the measured rows are the residuals of the best series, drawn in blocks of a decade along
  the frequency, E' and E'' of a row together: rows of one temperature are off together. They are
  scaled up by the degrees of freedom the fit has taken, and to the scatter where they are less.
- e of the rows that smooth and shrink the spectrum, one in these units, are standard normal: where
  no data are, beyond the ends, the spectrum wanders off as far as the weak smoothing allows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber import MasterCurve, PronyFit, Rubber
from gripscale.rubber.extremes import open_equations
from gripscale.rubber.maxwell_fit import Curve, Equations, Spectrum, non_negative
from gripscale.rubber.outliers import LEAST_SCATTER
from gripscale.rubber.prony import BEYOND, largest_modulus

Array = NDArray[np.float64]

BLOCK_DECADES = 1.0
"""Length of a block of rows."""
MOST_TAKEN = 0.75
"""Share of the degrees of freedom a fit is believed to take at most."""


@dataclass(frozen=True, eq=False)
class SeriesScatter:
    """The equations of a fit in units of the scatter of its rows.

    Parameters
    ----------
    problem : Equations
        Of `open_equations`: first all rows of E', then those of E'', of the prior, and one limit.
    omega : array, shape (rows,)
        Angular frequency of the measured rows [rad/s], rising.
    """

    problem: Equations
    omega: Array

    @classmethod
    def of(cls, master: MasterCurve, fit: PronyFit, bulk_modulus: float) -> SeriesScatter:
        """Return what a master curve leaves open beside the fit that was made of it."""
        kept = ~np.isin(master.frequency, fit.outlier_frequency)
        curve = Curve(master.angular_frequency, master.storage, master.loss).rows(kept)
        scatter = (
            max(LEAST_SCATTER, fit.storage_scatter, fit.rms_storage),
            max(LEAST_SCATTER, fit.loss_scatter, fit.rms_loss),
        )
        limit = largest_modulus(float(curve.storage.max()), bulk_modulus)
        return cls(open_equations(curve, scatter, BEYOND, limit), curve.omega)

    @cached_property
    def best(self) -> Array:
        """The solution of the equations as they stand."""
        return non_negative(self.problem.matrix, self.problem.right)

    @cached_property
    def _residuals(self) -> Array:
        """Errors of E' and E'' of each row to be drawn from, shape (rows, 2)."""
        rows = 2 * len(self.omega)
        error = (self.problem.right - self.problem.matrix @ self.best)[:rows].reshape(2, -1).T
        error = error - error.mean(axis=0)
        rms = np.sqrt(np.mean(error**2, axis=0))
        taken = min(np.count_nonzero(self.best) / rows, MOST_TAKEN)
        wanted = np.maximum(rms / math.sqrt(1.0 - taken), 1.0)
        return np.asarray(error * wanted / np.where(rms > 0.0, rms, 1.0))

    @cached_property
    def _block(self) -> int:
        """Rows in a block."""
        rows, decades = len(self.omega), math.log10(self.omega[-1] / self.omega[0])
        return max(1, min(round(rows * BLOCK_DECADES / decades), rows // 2))

    def draw(self, random: np.random.Generator) -> Spectrum:
        """Return the spectrum of one disturbed fit."""
        rows, block = len(self.omega), self._block
        first = random.integers(rows, size=-(-rows // block))
        order = ((first[:, None] + np.arange(block)) % rows).ravel()[:rows]
        noise = random.standard_normal(len(self.problem.right) - 2 * rows - 1)
        errors = np.concatenate([self._residuals[order].T.ravel(), noise, [0.0]])
        return self.problem.spectrum(
            non_negative(self.problem.matrix, self.problem.right + errors)
        )


def with_series(rubber: Rubber, spectrum: Spectrum) -> Rubber:
    """Return `rubber` with another series, and nothing said of what else fits."""
    present = spectrum.moduli > 1e-9 * spectrum.moduli.sum()
    return replace(
        rubber,
        equilibrium_modulus=spectrum.equilibrium,
        moduli=spectrum.moduli[present],
        relaxation_times=spectrum.times[present],
        admissible=None,
    )
