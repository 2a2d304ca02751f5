"""A rubber half-plane that fills a rigid sine completely: pressure and friction in closed form.

With A cos(k x), k = 2 pi/lambda, the plane strain modulus M at w = k v and the mean pressure p,

    p_full = k A |M(w)| / 2,    mu = k^2 A^2 Im M(w) / (4 p)  for p >= p_full

K. L. Johnson, Contact Mechanics (1985), sec. 13.2, doi:10.1017/CBO9781139171731, with the complex
modulus as in B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840, doi:10.1063/1.1388626.
"""

from __future__ import annotations

import numpy as np

from gripscale.core import InputError, Quantity, checks


def plane_strain_modulus(youngs_modulus: complex, poisson_ratio: float) -> complex:
    """Return E/(1 - nu^2) [Pa] from Young's modulus, real or complex [Pa], and Poisson's ratio [-].

    Raises `InputError` unless -1 < nu <= 0.5.
    """
    modulus = checks.complex_number("youngs_modulus", youngs_modulus, unit="Pa")
    ratio = checks.number("poisson_ratio", poisson_ratio)
    if not -1.0 < ratio <= 0.5:
        raise InputError(f"poisson_ratio must be above -1 and at most 0.5; got {ratio:g}")
    return modulus / (1.0 - ratio**2)


def full_contact_pressure(
    plane_strain_modulus: complex, *, wavelength: Quantity, amplitude: Quantity
) -> float:
    """Return the least mean pressure that presses the valleys flat, k A |M| / 2 [Pa].

    For an elastic half-plane this is Westergaard's p* = pi E/(1-nu^2) A/lambda. Arguments: M =
    E/(1-nu^2) at the angular frequency 2 pi v/lambda [Pa], real when elastic; wavelength and
    amplitude, half peak to valley [m]. Raises `InputError` if one is not a positive finite number.
    """
    modulus = _modulus(plane_strain_modulus)
    length = checks.positive("wavelength", wavelength, unit="m")
    height = checks.positive("amplitude", amplitude, unit="m")
    return float(np.pi * abs(modulus) * height / length)


def full_contact_friction(
    plane_strain_modulus: complex, *, wavelength: Quantity, amplitude: Quantity, pressure: Quantity
) -> float:
    """Return the friction coefficient in full contact, k^2 A^2 Im(M) / (4 p) [-].

    Arguments as for `full_contact_pressure`, and the mean pressure [Pa]. Raises `InputError` if one
    is not positive and finite, or the pressure leaves gaps.
    """
    least = full_contact_pressure(plane_strain_modulus, wavelength=wavelength, amplitude=amplitude)
    load = checks.positive("pressure", pressure, unit="Pa")
    if load < least * (1.0 - 1e-12):
        raise InputError(f"pressure must be at least {least:g} for full contact [Pa]; got {load:g}")
    height = checks.positive("amplitude", amplitude, unit="m")
    slope = 2.0 * np.pi * height / checks.positive("wavelength", wavelength, unit="m")
    return float(slope**2 * _modulus(plane_strain_modulus).imag / (4.0 * load))


def _modulus(value: complex) -> complex:
    modulus = checks.complex_number("plane_strain_modulus", value, unit="Pa")
    if not (modulus.real > 0.0 and modulus.imag >= 0.0):
        raise InputError(
            "plane_strain_modulus must have a real part above zero and an imaginary part not "
            f"negative [Pa]; got {modulus}"
        )
    return modulus
