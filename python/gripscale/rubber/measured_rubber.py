"""A rubber together with the measurement it was fitted to, and its fit for a case.

The series of a rubber has to be right where its case excites it: a row at w has the weight

    1 + 100 c(w)/max c,   c(w) = sum_i (c_i + a_i) 2 w w_i/(w^2 + w_i^2),

c_i and a_i being the shares of wave i in friction and area by Persson's theory at light loads (J.
Chem. Phys. 115 (2001) 3840, doi:10.1063/1.1388626): docs/derivations.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, ComplexArray, Finding, InputError, Quantity, checks
from gripscale.rubber.admissible import loss_shape
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import BULK_MODULUS, Rubber
from gripscale.rubber.maxwell_fit import Curve
from gripscale.rubber.prony import fit_prony_report
from gripscale.rubber.prony_report import PronyFit, sizes_of_errors
from gripscale.rubber.shift import ShiftTable
from gripscale.rubber.shift_fit import ShiftFit, fit_wlf
from gripscale.rubber.superposition import Superposition
from gripscale.rubber.sweeps import Sweeps

_MOST_WEIGHT = 100.0  # of a row that decides most, over one that decides nothing


@dataclass(frozen=True)
class MeasuredRubber:
    """A rubber and what it comes from; a rubber made by hand comes from nothing else."""

    rubber: Rubber
    source: str
    master: MasterCurve | None = None  # the master curve that the Prony series was fitted to
    fit: PronyFit | None = None  # the report on that fit
    sweeps: Sweeps | None = None  # sweeps at several temperatures that make the master curve
    superposition: Superposition | None = None  # how these sweeps meet
    note: str = ""  # what was assumed when its file was read, as a sentence; empty if nothing was

    @property
    def doubts(self) -> tuple[Finding, ...]:
        """Why its moduli may be those of no rubber."""
        return () if self.fit is None else self.fit.doubts

    def fitted_for(self, omega: Array, slope: Array) -> MeasuredRubber:
        """Return it with its series fitted anew for waves of a surface, longest first.

        They have the rms `slope` [-] and excite the rubber at `omega` [rad/s], at the temperature
        of the master curve; at rest all rows count alike. Unchanged without a measurement.
        """
        if self.fit is None or self.fit.problem is None:
            return self
        rows = self.fit.problem.rows
        weight = row_weights(rows, omega, slope) if omega.all() else 1.0
        problem = replace(self.fit.problem, row_weight=weight)
        rubber = problem.applied_to(self.rubber)
        sizes = sizes_of_errors(rubber.complex_modulus(rows.omega), rows)
        fit = replace(self.fit, terms=len(rubber.moduli), problem=problem, **sizes)
        return replace(self, rubber=rubber, fit=fit)

    def shift_fits(self) -> list[ShiftFit]:
        """Return the WLF law that the measured shift follows; none where it follows no such law."""
        if self.master is None or not isinstance(self.master.shift, ShiftTable):
            return []
        try:
            reference = self.master.reference_temperature
            return [fit_wlf(self.master.shift, reference_temperature=reference)]
        except InputError:
            return []


def row_weights(rows: Curve, omega: Array, slope: Array) -> Array:
    """Return the weight of each row for waves of rms `slope` at `omega` [rad/s], longest first."""
    position, square = np.log(omega), slope**2
    storage, loss = (
        np.exp(np.interp(position, np.log(rows.omega), np.log(modulus)))
        for modulus in (rows.storage, rows.loss)
    )
    felt = np.cumsum(square * (storage**2 + loss**2))
    friction, area = square * loss / np.sqrt(felt), square * (storage**2 + loss**2) / felt[-1]
    share = loss_shape(rows.omega[:, None] / omega) @ (friction / friction.sum() + area)
    return np.asarray(1.0 + _MOST_WEIGHT * share / share.max())


_ORIGIN = (
    "springpot parameters published for an unfilled SBR at 20 C; the publication is not stated in "
    "the source they were taken from"
)


def springpot_modulus(omega: ArrayLike) -> ComplexArray:
    """Return E*(w) [Pa] of an unfilled styrene-butadiene rubber at 20 C, of the shape of `omega`.

    One springpot in parallel with two in series, s = i w / w_r, w_r = 2 pi 6.94e7 rad/s:

        E*(w) = E_a + 1/(1/E_b + 1/E_c)
        E_a = 1.76 MPa s^(2.3/90),  E_b = 1.12 GPa s^(55/90),  E_c = 1.12 GPa s^(2/90)

    The exponents are the limiting loss angles over 90 degrees. Raises `InputError` if an angular
    frequency `omega` [rad/s] is not finite or not above zero.
    """
    frequency = checks.real("omega", omega, unit="rad/s")
    if not (frequency >= checks.LEAST).all():
        raise InputError(
            f"omega must be greater than zero, at least {checks.LEAST:g} [rad/s]; "
            f"got {checks.short_repr(omega)}"
        )
    scaled = 1j * frequency / (2.0 * np.pi * 6.94e7)
    rubbery = 1.76e6 * scaled ** (2.3 / 90.0)
    transition = 1.12e9 * scaled ** (55.0 / 90.0)
    glassy = 1.12e9 * scaled ** (2.0 / 90.0)
    return np.asarray(rubbery + 1.0 / (1.0 / transition + 1.0 / glassy))


def styrene_butadiene(*, bulk_modulus: Quantity = BULK_MODULUS) -> Rubber:
    """Return an unfilled styrene-butadiene rubber at 20 C as a Prony series.

    The springpots of `springpot_modulus`, fitted from 1e-2 to 1e10 rad/s with two elements per
    decade, two decades beyond these ends as well. A springpot has no equilibrium modulus: the one
    given here is what is left below the slow end, so static results depend on the band and are not
    a property of the rubber.

    What is known: unfilled SBR, 20 C, the parameters. Not known: publication, compound, laboratory,
    strain amplitude, how far into the glassy region they were measured, and the bulk modulus [Pa],
    which is assumed. Raises `InputError` if the bulk modulus cannot be used.
    """
    return _styrene_butadiene(checks.positive("bulk_modulus", bulk_modulus, unit="Pa"))


@lru_cache(maxsize=8)
def _styrene_butadiene(bulk_modulus: float) -> Rubber:
    omega = np.geomspace(1e-2, 1e10, 121)
    hertz, modulus = omega / (2.0 * np.pi), springpot_modulus(omega)
    name = "unfilled styrene-butadiene rubber, 20 C"
    master = MasterCurve(hertz, modulus.real, modulus.imag, 293.15, name, _ORIGIN)
    options: dict[str, float] = {"bulk_modulus": bulk_modulus, "outlier_threshold": float("inf")}
    return fit_prony_report(master, terms=25, **options)[0]
