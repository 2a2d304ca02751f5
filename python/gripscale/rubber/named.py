"""Rubbers known by published parameters."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import ComplexArray, InputError, Quantity, checks
from gripscale.rubber.master_curve import MasterCurve
from gripscale.rubber.material import BULK_MODULUS, Rubber
from gripscale.rubber.prony import fit_prony_report

_ORIGIN = (
    "springpot parameters published for an unfilled SBR at 20 C; the publication is not stated in "
    "the source they were taken from"
)


def springpot_modulus(omega: ArrayLike) -> ComplexArray:
    """Return E*(w) [Pa] of an unfilled styrene-butadiene rubber at 20 C, of the shape of `omega`.

    One springpot in parallel with two in series, s = i w / w_r, w_r = 2 pi 6.94e7 rad/s:

        E*(w) = E_a + 1/(1/E_b + 1/E_c)
        E_a = 1.76 MPa s^(2.3/90),  E_b = 1.12 GPa s^(55/90),  E_c = 1.12 GPa s^(2/90)

    The exponents are the limiting loss angles over 90 degrees. The parameters are published for an
    unfilled SBR at 20 C; the publication, the compound and the strain amplitude are not stated in
    the source they were taken from. Raises `InputError` if an angular frequency `omega` [rad/s] is
    not finite or not above zero.
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


def styrene_butadiene(
    *, band: tuple[float, float] = (1e-2, 1e10), bulk_modulus: Quantity = BULK_MODULUS
) -> Rubber:
    """Return an unfilled styrene-butadiene rubber at 20 C as a Prony series.

    The springpots of `springpot_modulus`, fitted over the angular frequencies of `band` [rad/s],
    at least two decades apart, with two elements per decade, two decades beyond its ends as well. A
    springpot has no equilibrium modulus: the one given here is what is left below the slow end of
    the band, so static results depend on the band and are not a property of the rubber.

    What is known: unfilled SBR, 20 C, the parameters. Not known: publication, compound, laboratory,
    strain amplitude, how far into the glassy region they were measured, and the bulk modulus [Pa],
    which is assumed. Raises `InputError` if the band or the bulk modulus cannot be used.
    """
    ends = checks.positive_vector("band", band, unit="rad/s")
    if len(ends) != 2 or ends[1] < 100.0 * ends[0]:
        raise InputError(
            f"band [rad/s] must span at least two decades; got {checks.short_repr(band)}"
        )
    bulk = checks.positive("bulk_modulus", bulk_modulus, unit="Pa")
    return _styrene_butadiene(float(ends[0]), float(ends[1]), bulk)


@lru_cache(maxsize=8)
def _styrene_butadiene(low: float, high: float, bulk_modulus: float) -> Rubber:
    decades = float(np.log10(high / low))
    omega = np.geomspace(low, high, round(10 * decades) + 1)
    hertz, modulus = omega / (2.0 * np.pi), springpot_modulus(omega)
    name = "unfilled styrene-butadiene rubber, 20 C"
    master = MasterCurve(hertz, modulus.real, modulus.imag, 293.15, name, _ORIGIN)
    terms, keep_all = round(2 * decades) + 1, float("inf")
    return fit_prony_report(
        master, terms=terms, bulk_modulus=bulk_modulus, outlier_threshold=keep_all
    )[0]
