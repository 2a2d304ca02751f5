"""An elastic half-plane pressed on a rigid sine in part: Westergaard's contact.

Geometry: plane strain, frictionless, small slope, wave z = A cos(2 pi x/lambda), crest at x = 0.

Nomenclature: p mean pressure, p* = pi E/(1-nu^2) A/lambda the pressure of full contact
(`full_contact.full_contact_pressure`), psi = pi x/lambda, psi_a the same at the contact edge.

    sin^2(psi_a) = p/p*                              contact fraction = (2/pi) psi_a
    p(x) = 2 p cos(psi) / sin^2(psi_a) sqrt(sin^2(psi_a) - sin^2(psi))
    p(0) = 2 p / sin(psi_a)                          the largest pressure

Source: H. M. Westergaard, J. Appl. Mech. 6 (1939) A49; in this form K. L. Johnson, Contact
Mechanics (1985), sec. 13.2, doi:10.1017/CBO9781139171731.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError

Array = NDArray[np.float64]


def contact_fraction(pressure_ratio: ArrayLike) -> Array:
    """Return the contact length over the wavelength [-] at p/p* [-], same shape; 1 from p* on.

    Raises `InputError` for a negative ratio or NaN.
    """
    ratio = checks.array(pressure_ratio, "pressure_ratio must be numbers not negative")
    if not (ratio >= 0.0).all():
        raise InputError(f"pressure_ratio must not be negative; got {checks.shown(pressure_ratio)}")
    return np.asarray(2.0 / np.pi * np.arcsin(np.sqrt(np.minimum(ratio, 1.0))))


def contact_pressure(
    x: ArrayLike, *, wavelength: float, pressure: float, full_contact_pressure: float
) -> Array:
    """Return the contact pressure [Pa] at `x` [m], same shape; zero out of contact.

    Parameters
    ----------
    x : array_like
        Abscissa, crest at 0 [m].
    wavelength : float
        Of the wave [m], above zero.
    pressure, full_contact_pressure : float
        Mean pressure and p* [Pa], above zero.

    Raises
    ------
    InputError
        If an argument is not a positive finite number.
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
