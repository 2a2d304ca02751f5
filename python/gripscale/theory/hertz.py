"""A rigid cylinder pressed into an elastic half-plane: Hertz's line contact.

Geometry: plane strain, frictionless, radius R much larger than the contact half width a.

Nomenclature: P load per length [N/m], M = E/(1-nu^2) of the elastic side.

    a^2 = 4 P R / (pi M)        p_max = 2 P / (pi a)        p(x) = p_max sqrt(1 - x^2/a^2)

Source: K. L. Johnson, Contact Mechanics (1985), sec. 4.2(c), eqs. 4.43-4.45,
doi:10.1017/CBO9781139171731. The crest of a wave A cos(2 pi x/lambda) has R = lambda^2/(4 pi^2 A):
Westergaard's contact tends to Hertz's as the load goes to zero.
"""

from __future__ import annotations

import numpy as np

from gripscale import checks


def crest_radius(*, wavelength: float, amplitude: float) -> float:
    """Return the radius of curvature of a wave's crest [m] from wavelength and amplitude [m].

    Raises `InputError` unless both are positive and finite.
    """
    length = checks.positive("wavelength", wavelength, unit="m")
    height = checks.positive("amplitude", amplitude, unit="m")
    return float(length**2 / (4.0 * np.pi**2 * height))


def contact_half_width(
    *, load_per_length: float, radius: float, plane_strain_modulus: float
) -> float:
    """Return the half width of the contact [m].

    Parameters
    ----------
    load_per_length : float
        [N/m], above zero.
    radius : float
        Of the cylinder [m], above zero.
    plane_strain_modulus : float
        E/(1-nu^2) [Pa], above zero.

    Raises
    ------
    InputError
        If an argument is not a positive finite number.
    """
    load = checks.positive("load_per_length", load_per_length, unit="N/m")
    curvature = checks.positive("radius", radius, unit="m")
    modulus = checks.positive("plane_strain_modulus", plane_strain_modulus, unit="Pa")
    return float(np.sqrt(4.0 * load * curvature / (np.pi * modulus)))


def largest_pressure(
    *, load_per_length: float, radius: float, plane_strain_modulus: float
) -> float:
    """Return the pressure in the middle of the contact [Pa].

    Arguments and errors are those of `contact_half_width`.
    """
    half_width = contact_half_width(
        load_per_length=load_per_length, radius=radius, plane_strain_modulus=plane_strain_modulus
    )
    return float(2.0 * load_per_length / (np.pi * half_width))
