"""Formulas of vehicle models through a slip curve: Burckhardt's, and the Magic Formula.

    mu(s) = c1 (1 - exp(-c2 s)) - c3 s
    mu(s) = D sin(C atan(B s - E (B s - atan(B s))))

M. Burckhardt, Fahrwerktechnik: Radschlupf-Regelsysteme (1993); H. B. Pacejka, Tire and Vehicle
Dynamics, 3rd ed. (2012), eq. 4.49, without shifts.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gripscale.core.arrays import Array

Formula = Callable[..., Array]


def burckhardt(slip: Array, c1: float, c2: float, c3: float) -> Array:
    """Return mu(s) of Burckhardt's parameters [-]."""
    return np.asarray(c1 * (1.0 - np.exp(-c2 * slip)) - c3 * slip)


def magic_formula(slip: Array, b: float, c: float, d: float, e: float) -> Array:
    """Return mu(s) of the parameters B, C, D and E of the Magic Formula [-]."""
    bs = b * slip
    return np.asarray(d * np.sin(c * np.arctan(bs - e * (bs - np.arctan(bs)))))


FORMULAS: dict[str, tuple[Formula, tuple[str, ...], tuple[float, ...], tuple[float, ...]]] = {
    "burckhardt": (burckhardt, ("c1", "c2", "c3"), (0.0, 0.1, -2.0), (5.0, 500.0, 5.0)),
    "magic_formula": (
        magic_formula,
        ("B", "C", "D", "E"),
        (0.1, 0.5, 0.0, -20.0),
        (200.0, 2.5, 5.0, 1.0),
    ),
}
"""Function, parameters and their bounds of each formula."""
DRY, WET = (1.2801, 23.99, 0.52), (0.857, 33.82, 0.347)
"""Burckhardt's parameters of a tyre on dry and on wet asphalt."""


def fitted(name: str, slip: Array, force: Array) -> tuple[Array, float]:
    """Return the parameters of a formula through a slip curve, and its rms misfit over the peak.

    Of several starts the best counts.
    """
    from scipy.optimize import least_squares  # slow to import

    function, _, low, high = FORMULAS[name]
    peak, slope = float(force.max()), float(force[0] / slip[0])
    starts = {
        "burckhardt": [(peak, slope / peak, c3) for c3 in (0.0, 0.3)],
        "magic_formula": [(slope / (c * peak), c, peak, e) for c in (1.3, 1.65) for e in (-1, 0.5)],
    }[name]

    def misfit(parameters: Array) -> Array:
        return function(slip, *parameters) - force

    bounds = np.array(low) + 1e-9, np.array(high) - 1e-9
    fits = [least_squares(misfit, np.clip(start, *bounds), bounds=(low, high)) for start in starts]
    best = min(fits, key=lambda fit: float(fit.cost))
    return best.x, float(np.sqrt(np.mean(best.fun**2))) / peak
