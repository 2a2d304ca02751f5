"""How an elastic slab bonded to a rigid base yields to a wavy pressure.

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
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.theory.full_contact import poisson

Array = NDArray[np.float64]


def slab_compliance(
    wavenumber: ArrayLike, *, depth: float, youngs_modulus: float, poisson_ratio: float
) -> Array:
    """Return normal displacement over pressure amplitude, u/p [m/Pa], same shape as `wavenumber`.

    Parameters
    ----------
    wavenumber : array_like
        2 pi/lambda [rad/m], above zero.
    depth : float
        Thickness of the slab [m], above zero; infinity gives the half-plane.
    youngs_modulus : float
        [Pa], above zero.
    poisson_ratio : float
        [-], above -1 and at most 0.5.

    Raises
    ------
    InputError
        If an argument is out of its range.
    """
    number = checks.real("wavenumber", wavenumber, unit="rad/m")
    if not (number >= checks.LEAST).all():
        raise InputError(
            f"wavenumber must be greater than zero, at least {checks.LEAST:g} [rad/m]; "
            f"got {checks.shown(wavenumber)}"
        )
    thickness = checks.positive("depth", depth, unit="m", infinite=True)
    modulus = checks.positive("youngs_modulus", youngs_modulus, unit="Pa")
    ratio = poisson(poisson_ratio)
    half_plane = 2.0 * (1.0 - ratio**2) / (modulus * number)
    return np.asarray(half_plane * slab_factor(number * thickness, ratio))


def slab_factor(depth_phase: ArrayLike, poisson_ratio: float) -> Array:
    """Return the compliance of the slab over that of the half-plane [-] at k h [rad]."""
    kappa = 3.0 - 4.0 * poisson_ratio
    # beyond k h = 300 the factor is 1 to double precision; the limit keeps sinh finite
    c = np.minimum(np.asarray(depth_phase, dtype=float), 300.0)
    above = 2.0 * kappa * np.sinh(2.0 * c) - 4.0 * c
    below = 2.0 * kappa * np.cosh(2.0 * c) + 1.0 + kappa**2 + 4.0 * c**2
    return np.asarray(above / below)
