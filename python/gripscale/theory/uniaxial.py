"""Stress relaxation of an incompressible rubber bar after a step to a finite stretch.

Geometry: uniaxial tension or compression, stretch s held from t = 0 on.

Nomenclature: G(t) = E(t)/3 the shear relaxation modulus, P the nominal stress (force over the
undeformed cross-section).

    P(t) = G(t) (s - s^-2) = G_inf (s - s^-2) (1 + sum beta_i exp(-t/tau_i)),  beta_i = G_i/G_inf

A neo-Hookean base with linear evolution of the internal variables; the temporary network
(J. Lubliner, Mech. Res. Commun. 12 (1985) 93, doi:10.1016/0093-6413(85)90075-8), the second
Piola-Kirchhoff overstress (J. C. Simo, Comput. Methods Appl. Mech. Engrg. 60 (1987) 153,
doi:10.1016/0045-7825(87)90107-1) and its mixed pull-back agree here: the strain is constant.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.rubber import Rubber

Array = NDArray[np.float64]


def step_relaxation_stress(rubber: Rubber, *, stretch: float, time: ArrayLike) -> Array:
    """Return the nominal stress [Pa] at `time` [s] after a step to `stretch` [-], shape of `time`.

    Parameters
    ----------
    rubber : Rubber
        Its bulk modulus is taken as infinite.
    stretch : float
        Deformed over undeformed length [-], above zero.
    time : array_like
        Since the step [s], not negative; infinity gives equilibrium.

    Raises
    ------
    InputError
        If the stretch is not positive or a time is negative.
    """
    checks.instance("rubber", rubber, Rubber)
    ratio = checks.positive("stretch", stretch)
    return np.asarray(rubber.relaxation_modulus(time) / 3.0 * (ratio - ratio**-2))
