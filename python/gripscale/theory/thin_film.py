r"""Closed forms of thin films: flow factors of simple gaps, squeeze-out between parallel plates.

Gap of one sine, h = h_0 (1 + a sin(2 pi x / lambda)); phi is the flow over that of a parallel gap.

    across the ridges   phi = (1 - a^2)^(5/2) / (1 + a^2/2)     1 / phi = <h^-3> h_0^3
    along the ridges    phi = 1 + 3 a^2 / 2                         phi = <h^3> / h_0^3

Isotropic Gaussian roughness without contact, H the mean gap over its rms, from H = 3 on:

    phi = 1 - 0.90 exp(-0.56 H)

Source: N. Patir & H. S. Cheng, J. Lubr. Technol. 100 (1978) 12, doi:10.1115/1.3453103, table 1.

Parallel rigid plates pressed together under a fluid: Stefan's equation. p_0 the mean pressure, eta
the viscosity, h_1 and h_2 the films before and after the time t; strips of the length L
between open ends, wide across it:

    t = eta L^2 / (2 p_0) (h_2^-2 - h_1^-2)

Source: J. Stefan, Sitzungsber. Akad. Wiss. Wien 69 (1874) 713; in this form B. J. Hamrock, S. R.
Schmid & B. O. Jacobson, Fundamentals of Fluid Film Lubrication (2004), ch. 11.
"""

from __future__ import annotations

import math

from gripscale.core import checks


def flow_factor_across(amplitude: float) -> float:
    """Return the flow factor across the ridges of a gap of one sine, of relative amplitude."""
    square = checks.share("amplitude", amplitude) ** 2
    return float((1.0 - square) ** 2.5 / (1.0 + 0.5 * square))


def flow_factor_along(amplitude: float) -> float:
    """Return the flow factor along the ridges of a gap of one sine, of relative amplitude."""
    return 1.0 + 1.5 * checks.share("amplitude", amplitude) ** 2


def patir_cheng_flow_factor(gap_ratio: float) -> float:
    """Return the flow factor of isotropic Gaussian roughness, from the mean gap over its rms."""
    return 1.0 - 0.90 * math.exp(-0.56 * checks.positive("gap_ratio", gap_ratio))


def stefan_time(
    length: float, pressure: float, viscosity: float, before: float, after: float
) -> float:
    """Return the time [s] in which a film between parallel strips thins from `before` to `after`.

    `length` is that between the open ends [m], `pressure` the mean [Pa], `viscosity` in Pa s.
    """
    size = checks.positive("length", length, unit="m") ** 2
    load = checks.positive("pressure", pressure, unit="Pa")
    first, last = (checks.positive("film thickness", film, unit="m") for film in (before, after))
    growth = last**-2 - first**-2
    return checks.positive("viscosity", viscosity, unit="Pa s") * size / (2.0 * load) * growth
