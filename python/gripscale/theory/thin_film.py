r"""Closed forms of thin films: flow factors of simple gaps, squeeze-out between parallel plates.

The gap of one sine, h = h_0 (1 + a sin(2 pi x / lambda)), under Reynolds' equation.

Nomenclature: phi the flow over that of a parallel gap of the width h_0; a below 1.

    across the ridges   phi = (1 - a^2)^(5/2) / (1 + a^2/2)     1 / phi = <h^-3> h_0^3
    along the ridges    phi = 1 + 3 a^2 / 2                         phi = <h^3> / h_0^3

Gaussian roughness without a direction, H the mean gap over its standard deviation, fitted to flow
simulations from H = 3 on, without contact:

    phi = 1 - 0.90 exp(-0.56 H)

Source: N. Patir & H. S. Cheng, J. Lubr. Technol. 100 (1978) 12, doi:10.1115/1.3453103, table 1.

Parallel rigid plates pressed together under a fluid: Stefan's equation. p_0 the mean pressure, eta
the viscosity, h_1 and h_2 the films before and after the time t; a strip of the length L, open at
both ends, or a disc of the diameter D:

    t = eta L^2 / (2 p_0) (h_2^-2 - h_1^-2)           strip, wide across L
    t = 3 eta D^2 / (16 p_0) (h_2^-2 - h_1^-2)        disc

Source: J. Stefan, Sitzungsber. Akad. Wiss. Wien 69 (1874) 713; in this form B. J. Hamrock, S. R.
Schmid & B. O. Jacobson, Fundamentals of Fluid Film Lubrication (2004), ch. 11.
"""

from __future__ import annotations

import math

from gripscale.core import checks


def flow_factor_across(amplitude: float) -> float:
    """Return the flow factor across the ridges of a gap of one sine, of relative amplitude."""
    square = _below_one(amplitude) ** 2
    return (1.0 - square) ** 2.5 / (1.0 + 0.5 * square)


def flow_factor_along(amplitude: float) -> float:
    """Return the flow factor along the ridges of a gap of one sine, of relative amplitude."""
    return 1.0 + 1.5 * _below_one(amplitude) ** 2


def patir_cheng_flow_factor(gap_ratio: float) -> float:
    """Return the flow factor of isotropic Gaussian roughness, from the mean gap over its rms."""
    return 1.0 - 0.90 * math.exp(-0.56 * checks.positive("gap_ratio", gap_ratio))


def stefan_time(
    length: float, pressure: float, viscosity: float, before: float, after: float
) -> float:
    """Return the time in which a film between parallel strips thins [s].

    Parameters
    ----------
    length : float
        Of the strips between their open ends [m]; they are wide across it.
    pressure : float
        Mean pressure [Pa].
    viscosity : float
        [Pa s].
    before, after : float
        Film thickness at the beginning and end [m].
    """
    size = checks.positive("length", length, unit="m") ** 2
    load = checks.positive("pressure", pressure, unit="Pa")
    first, last = (checks.positive("film thickness", film, unit="m") for film in (before, after))
    growth = last**-2 - first**-2
    return checks.positive("viscosity", viscosity, unit="Pa s") * size / (2.0 * load) * growth


def _below_one(amplitude: float) -> float:
    checks.at_most_one("amplitude", checks.not_negative("amplitude", amplitude))
    return amplitude
