"""Closed forms of contact, relaxation and thin films that tests compare with."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array
from gripscale.rubber import Rubber


def crest_radius(*, wavelength: float, amplitude: float) -> float:
    """Return the radius of a crest of a sine [m]."""
    return wavelength**2 / (4.0 * math.pi**2 * amplitude)


def contact_half_width(
    *, load_per_length: float, radius: float, plane_strain_modulus: float
) -> float:
    """Return the half width [m] of Hertz's line contact under a load [N/m].

    a^2 = 4 P R/(pi M), p_max = 2 P/(pi a): K. L. Johnson, Contact Mechanics (1985), sec. 4.2(c).
    """
    return math.sqrt(4.0 * load_per_length * radius / (math.pi * plane_strain_modulus))


def largest_pressure(
    *, load_per_length: float, radius: float, plane_strain_modulus: float
) -> float:
    """Return the pressure in the middle of that contact [Pa]."""
    half_width = contact_half_width(
        load_per_length=load_per_length, radius=radius, plane_strain_modulus=plane_strain_modulus
    )
    return 2.0 * load_per_length / (math.pi * half_width)


def contact_fraction(pressure_ratio: ArrayLike) -> Array:
    """Return the contact length over the wavelength [-] of a sine at p/p* [-]; 1 from p* on.

    H. M. Westergaard, J. Appl. Mech. 6 (1939) A49; in this form K. L. Johnson, Contact Mechanics
    (1985), sec. 13.2: sin^2(pi a/lambda) = p/p*.
    """
    ratio = np.minimum(np.asarray(pressure_ratio, dtype=float), 1.0)
    return np.asarray(2.0 / np.pi * np.arcsin(np.sqrt(ratio)))


def contact_pressure(
    x: ArrayLike, *, wavelength: float, pressure: float, full_contact_pressure: float
) -> Array:
    """Return Westergaard's contact pressure [Pa] at `x` [m], the crest at 0; zero out of contact.

    p(x) = 2 p cos(psi)/sin^2(psi_a) sqrt(sin^2(psi_a) - sin^2(psi)), psi = pi x/lambda.
    """
    psi = np.pi * np.asarray(x, dtype=float) / wavelength
    if pressure >= full_contact_pressure:
        return np.asarray(pressure + full_contact_pressure * np.cos(2.0 * psi))
    edge = pressure / full_contact_pressure
    root = np.sqrt(np.maximum(edge - np.sin(psi) ** 2, 0.0))
    return np.asarray(2.0 * pressure / edge * np.abs(np.cos(psi)) * root)


def step_relaxation_stress(rubber: Rubber, *, stretch: float, time: ArrayLike) -> Array:
    """Return the nominal stress [Pa] of an incompressible bar at `time` [s] after a step.

    P(t) = G(t) (s - s^-2): the temporary network (J. Lubliner, Mech. Res. Commun. 12 (1985) 93),
    the second Piola-Kirchhoff overstress (J. C. Simo, Comput. Methods Appl. Mech. Engrg. 60 (1987)
    153) and its mixed pull-back agree here, because the strain is constant.
    """
    return np.asarray(rubber.relaxation_modulus(time) / 3.0 * (stretch - stretch**-2))


def flow_factor_across(amplitude: float) -> float:
    """Return the flow over that of a parallel gap, across the ridges of h_0 (1 + a sin kx)."""
    return float((1.0 - amplitude**2) ** 2.5 / (1.0 + 0.5 * amplitude**2))


def flow_factor_along(amplitude: float) -> float:
    """Return the same along the ridges: <h^3>/h_0^3."""
    return 1.0 + 1.5 * amplitude**2


def patir_cheng_flow_factor(gap_ratio: float) -> float:
    """Return the flow factor of isotropic Gaussian roughness, from mean gap over rms, above 3.

    N. Patir & H. S. Cheng, J. Lubr. Technol. 100 (1978) 12, doi:10.1115/1.3453103, table 1.
    """
    return 1.0 - 0.90 * math.exp(-0.56 * gap_ratio)


def stefan_time(
    length: float, pressure: float, viscosity: float, before: float, after: float
) -> float:
    """Return the time [s] in which a film between parallel strips thins from `before` to `after`.

    J. Stefan, Sitzungsber. Akad. Wiss. Wien 69 (1874) 713; B. J. Hamrock, S. R. Schmid & B. O.
    Jacobson, Fundamentals of Fluid Film Lubrication (2004), ch. 11.
    """
    return viscosity * length**2 / (2.0 * pressure) * (after**-2 - before**-2)
