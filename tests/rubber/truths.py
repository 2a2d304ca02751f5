"""Rubbers whose E*(w) is known at every frequency, cut where a measurement might end."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber import MasterCurve, Rubber, fit_prony, read_master_curve, springpot_modulus
from tests.samples import MEASURED_DMA as TREAD

Modulus = Callable[[NDArray[np.float64]], NDArray[np.complex128]]


@dataclass(frozen=True)
class Truth:
    """E*(w) and the angular frequencies [rad/s] at which a measurement may begin and end."""

    modulus: Modulus
    corners: tuple[float, float, float, float]
    """In the rubbery region, on the way to the transition, in it, in the glassy region."""

    def cut(self, where: str) -> tuple[float, float]:
        """Return first and last frequency of a measurement."""
        rubbery, foot, flank, glassy = self.corners
        return {
            "whole": (rubbery, glassy),
            "no glass": (rubbery, flank),
            "no rubber": (foot, glassy),
            "flank": (foot, flank),
        }[where]

    def measured(
        self, low: float, high: float, noise: float, seed: int, per_decade: int = 8
    ) -> MasterCurve:
        """Return a master curve with normally distributed relative errors."""
        omega = np.geomspace(low, high, round(per_decade * np.log10(high / low)) + 1)
        return curve_of(self.modulus, omega, noise, seed)


def curve_of(
    modulus: Modulus, omega: NDArray[np.float64], noise: float = 0.0, seed: int = 0
) -> MasterCurve:
    """Return a master curve at angular frequencies [rad/s] with relative errors."""
    values = modulus(omega)
    scatter = np.exp(noise * np.random.default_rng(seed).standard_normal((2, len(omega))))
    return MasterCurve(omega / 2 / np.pi, values.real * scatter[0], values.imag * scatter[1])


def fractional_zener(
    omega: NDArray[np.float64], slow: float, fast: float, time: float, exponent: float
) -> NDArray[np.complex128]:
    """E* = slow + (fast - slow) s/(1 + s), s = (i w time)^exponent."""
    s = (1j * omega * time) ** exponent
    return slow + (fast - slow) * s / (1 + s)


def havriliak_negami(
    omega: NDArray[np.float64], slow: float, fast: float, time: float, shapes: tuple[float, float]
) -> NDArray[np.complex128]:
    """E* = fast + (slow - fast)/(1 + (i w time)^a)^b (Havriliak & Negami 1967, as a modulus)."""
    return fast + (slow - fast) / (1 + (1j * omega * time) ** shapes[0]) ** shapes[1]


def shipped_tread(omega: NDArray[np.float64]) -> NDArray[np.complex128]:
    """A generalised Maxwell solid over 17 decades: the series of the measured tread curve."""
    return _tread().complex_modulus(omega)


@cache
def _tread() -> Rubber:
    return fit_prony(read_master_curve(TREAD), terms=20, extrapolate_decades=0.0)


def filled(omega: NDArray[np.float64]) -> NDArray[np.complex128]:
    """A glass transition and a slow, broad relaxation of the filler network."""
    glass = fractional_zener(omega, 4e6, 1.2e9, 1e-8, 0.65)
    return glass + fractional_zener(omega, 0.0, 8e6, 1e-1, 0.25)


TRUTHS = {
    "springpots": Truth(springpot_modulus, (1e-2, 1e2, 1e6, 1e10)),
    "fractional Zener": Truth(
        lambda omega: fractional_zener(omega, 2e6, 1.5e9, 1e-7, 0.6), (1e-2, 1e1, 1e5, 1e9)
    ),
    "Havriliak-Negami": Truth(
        lambda omega: havriliak_negami(omega, 3e6, 2e9, 1e-3, (0.75, 0.35)), (1e-3, 1e2, 3e4, 1e8)
    ),
    "Maxwell": Truth(shipped_tread, (1e-1, 1e2, 1e7, 1e12)),
    "filled": Truth(filled, (1e-3, 1e1, 1e6, 1e10)),
}
CUTS = ("whole", "no glass", "no rubber", "flank")
