"""Closed forms of one sine: Westergaard's partial contact, pressure and friction in full contact.

An elastic half-plane pressed on a rigid sine in part: Westergaard's contact.

Geometry: plane strain, frictionless, small slope, wave z = A cos(2 pi x/lambda), crest at x = 0.

Nomenclature: p mean pressure, p* = pi E/(1-nu^2) A/lambda the pressure of full contact
(`full_contact_pressure`), psi = pi x/lambda, psi_a the same at the contact edge.

    sin^2(psi_a) = p/p*                              contact fraction = (2/pi) psi_a
    p(x) = 2 p cos(psi) / sin^2(psi_a) sqrt(sin^2(psi_a) - sin^2(psi))
    p(0) = 2 p / sin(psi_a)                          the largest pressure

Source: H. M. Westergaard, J. Appl. Mech. 6 (1939) A49; in this form K. L. Johnson, Contact
Mechanics (1985), sec. 13.2, doi:10.1017/CBO9781139171731.

A rubber half-plane that fills a rigid sine completely: pressure and friction in closed form.

Geometry: plane strain, wave z = A cos(k x), k = 2 pi/lambda, small slope, no adhesion; the rubber
slides over it with speed v, so that every point is excited at w = k v.

Nomenclature: M = E/(1-nu^2) the plane strain modulus, complex at w; p mean pressure; mu friction.

    p_full = k A |M(w)| / 2
    mu     = k^2 A^2 Im M(w) / (4 p)      for p >= p_full

Source: one Fourier component of the half-plane, u_q = -2 p_q / (|q| M(q v)) (K. L. Johnson, Contact
Mechanics, 1985, sec. 13.2, doi:10.1017/CBO9781139171731), with the elastic modulus replaced by the
complex one as in B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840, doi:10.1063/1.1388626. The
pressure then is p + k A |M| / 2 cos(k x + phase), which must not be negative.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, InputError, Quantity, checks


def contact_fraction(pressure_ratio: ArrayLike) -> Array:
    """Return the contact length over the wavelength [-] at p/p* [-], same shape; 1 from p* on.

    Raises `InputError` for a negative ratio or NaN.
    """
    ratio = checks.array(pressure_ratio, "pressure_ratio must be numbers not negative")
    if not (ratio >= 0.0).all():
        raise InputError(
            f"pressure_ratio must not be negative; got {checks.short_repr(pressure_ratio)}"
        )
    return np.asarray(2.0 / np.pi * np.arcsin(np.sqrt(np.minimum(ratio, 1.0))))


def contact_pressure(
    x: ArrayLike, *, wavelength: Quantity, pressure: Quantity, full_contact_pressure: Quantity
) -> Array:
    """Return the contact pressure [Pa] at `x` [m], same shape; zero out of contact.

    The crest is at x = 0; `pressure` is the mean and `full_contact_pressure` p* [Pa]. Raises
    `InputError` if an argument is not a positive finite number.
    """
    length = checks.positive("wavelength", wavelength, unit="m")
    mean = checks.positive("pressure", pressure, unit="Pa")
    full = checks.positive("full_contact_pressure", full_contact_pressure, unit="Pa")
    psi = np.pi * checks.real("x", x, unit="m") / length
    if mean >= full:
        return np.asarray(mean + full * np.cos(2.0 * psi))
    edge = mean / full
    root = np.sqrt(np.maximum(edge - np.sin(psi) ** 2, 0.0))
    return np.asarray(2.0 * mean / edge * np.abs(np.cos(psi)) * root)


def plane_strain_modulus(youngs_modulus: complex, poisson_ratio: float) -> complex:
    """Return E/(1 - nu^2) [Pa] from Young's modulus, real or complex [Pa], and Poisson's ratio [-].

    Raises `InputError` unless -1 < nu <= 0.5.
    """
    modulus = checks.complex_number("youngs_modulus", youngs_modulus, unit="Pa")
    return modulus / (1.0 - poisson(poisson_ratio) ** 2)


def poisson(value: float) -> float:
    """Return Poisson's ratio [-]; raise `InputError` unless it is above -1 and at most 0.5."""
    ratio = checks.number("poisson_ratio", value)
    if not -1.0 < ratio <= 0.5:
        raise InputError(f"poisson_ratio must be above -1 and at most 0.5; got {ratio:g}")
    return ratio


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
