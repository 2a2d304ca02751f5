"""Closed forms: Hertz, step relaxation, Westergaard, full contact of a sine, bonded slab.

A rigid cylinder pressed into an elastic half-plane: Hertz's line contact.

Geometry: plane strain, frictionless, radius R much larger than the contact half width a.

Nomenclature: P load per length [N/m], M = E/(1-nu^2) of the elastic side.

    a^2 = 4 P R / (pi M)        p_max = 2 P / (pi a)        p(x) = p_max sqrt(1 - x^2/a^2)

Source: K. L. Johnson, Contact Mechanics (1985), sec. 4.2(c), eqs. 4.43-4.45,
doi:10.1017/CBO9781139171731. The crest of a wave A cos(2 pi x/lambda) has R = lambda^2/(4 pi^2 A):
Westergaard's contact tends to Hertz's as the load goes to zero.

Stress relaxation of an incompressible rubber bar after a step to a finite stretch.

Geometry: uniaxial tension or compression, stretch s held from t = 0 on.

Nomenclature: G(t) = E(t)/3 the shear relaxation modulus, P the nominal stress (force over the
undeformed cross-section).

    P(t) = G(t) (s - s^-2) = G_inf (s - s^-2) (1 + sum beta_i exp(-t/tau_i)),  beta_i = G_i/G_inf

A neo-Hookean base with linear evolution of the internal variables; the temporary network
(J. Lubliner, Mech. Res. Commun. 12 (1985) 93, doi:10.1016/0093-6413(85)90075-8), the second
Piola-Kirchhoff overstress (J. C. Simo, Comput. Methods Appl. Mech. Engrg. 60 (1987) 153,
doi:10.1016/0045-7825(87)90107-1) and its mixed pull-back agree here: the strain is constant.

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

How an elastic slab bonded to a rigid base yields to a wavy pressure.

Geometry: plane strain, thickness h, the lower face bonded, a pressure p cos(k x) without shear on
the upper face; u is the normal displacement there.

Nomenclature: kappa = 3 - 4 nu, c = k h.

    u/p = 2 (1-nu^2)/(E k) * (2 kappa sinh 2c - 4 c) / (2 kappa cosh 2c + 1 + kappa^2 + 4 c^2)

Limits: 2 (1-nu^2)/(E k), the half-plane, for c -> infinity; h (1+nu)(1-2nu)/(E (1-nu)), uniaxial
strain, for c -> 0.

Source: M. Hannah, Q. J. Mech. Appl. Math. 4 (1951) 94; F. Bentall & K. L. Johnson,
Int. J. Mech. Sci. 10 (1968) 637 (bonded layer).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, InputError, Quantity, checks
from gripscale.rubber import Rubber


def crest_radius(*, wavelength: Quantity, amplitude: Quantity) -> float:
    """Return the radius of a crest [m]; `InputError` unless both lengths [m] are above zero."""
    length = checks.positive("wavelength", wavelength, unit="m")
    height = checks.positive("amplitude", amplitude, unit="m")
    return float(length**2 / (4.0 * np.pi**2 * height))


def contact_half_width(
    *, load_per_length: float, radius: Quantity, plane_strain_modulus: Quantity
) -> float:
    """Return the half width of the contact [m].

    Arguments: load [N/m], radius of the cylinder [m] and E/(1-nu^2) [Pa]. Raises `InputError` if
    one is not a positive finite number.
    """
    load = checks.positive("load_per_length", load_per_length, unit="N/m")
    curvature = checks.positive("radius", radius, unit="m")
    modulus = checks.positive("plane_strain_modulus", plane_strain_modulus, unit="Pa")
    return float(np.sqrt(4.0 * load * curvature / (np.pi * modulus)))


def largest_pressure(
    *, load_per_length: float, radius: Quantity, plane_strain_modulus: Quantity
) -> float:
    """Return the pressure in the middle of the contact [Pa], as `contact_half_width`."""
    half_width = contact_half_width(
        load_per_length=load_per_length, radius=radius, plane_strain_modulus=plane_strain_modulus
    )
    return float(2.0 * load_per_length / (np.pi * half_width))


def step_relaxation_stress(rubber: Rubber, *, stretch: float, time: ArrayLike) -> Array:
    """Return the nominal stress [Pa] at `time` [s] after a step to `stretch` [-], shape of `time`.

    The bulk modulus of the rubber is taken as infinite; infinite time gives equilibrium. Raises
    `InputError` if the stretch, deformed over undeformed length, is not positive or a time is
    negative.
    """
    checks.instance("rubber", rubber, Rubber)
    ratio = checks.positive("stretch", stretch)
    return np.asarray(rubber.relaxation_modulus(time) / 3.0 * (ratio - ratio**-2))


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


def slab_compliance(
    wavenumber: ArrayLike, *, depth: Quantity, youngs_modulus: Quantity, poisson_ratio: float
) -> Array:
    """Return normal displacement over pressure amplitude, u/p [m/Pa], same shape as `wavenumber`.

    Arguments: 2 pi/lambda [rad/m], thickness of the slab [m], where infinity gives the half-plane,
    Young's modulus [Pa], all above zero, and Poisson's ratio [-], above -1 and at most 0.5. Raises
    `InputError` if one is out of its range.
    """
    number = checks.real("wavenumber", wavenumber, unit="rad/m")
    if not (number >= checks.LEAST).all():
        raise InputError(
            f"wavenumber must be greater than zero, at least {checks.LEAST:g} [rad/m]; "
            f"got {checks.short_repr(wavenumber)}"
        )
    thickness = checks.positive("depth", depth, unit="m", infinite=True)
    modulus = checks.positive("youngs_modulus", youngs_modulus, unit="Pa")
    ratio = poisson(poisson_ratio)
    half_plane = 2.0 * (1.0 - ratio**2) / (modulus * number)
    kappa = 3.0 - 4.0 * ratio
    # beyond k h = 300 the slab is a half-plane to double precision; the limit keeps sinh finite
    c = np.minimum(number * thickness, 300.0)
    above = 2.0 * kappa * np.sinh(2.0 * c) - 4.0 * c
    below = 2.0 * kappa * np.cosh(2.0 * c) + 1.0 + kappa**2 + 4.0 * c**2
    return np.asarray(half_plane * (above / below))
