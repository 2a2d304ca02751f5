"""Gaussian maps whose contact is solved, and found by diffusion from fewer waves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gripscale as gs
from gripscale.surface import HeightMap
from gripscale.surface.cut_off import PowerLaw
from gripscale.theory import ContactPressures, diffusion

LENGTH, LONGEST, SLOPE = 0.1, 0.05, 0.3
"""Length of a map, its longest wave [m] and the rms slope of its lines [-]."""
POINTS_IN_WAVE = 4
START_TOLERANCE = 0.02


@dataclass(frozen=True)
class GaussianCase:
    """A self-affine Gaussian map, a rubber and a load."""

    hurst: float
    rubber: gs.Rubber
    speed: float
    share: float
    """Pressure over |M| at the last wave times the slope: about the contact fraction over 2 [-]."""
    seed: int


def gaussian_map(points: int, hurst: float, seed: int) -> tuple[HeightMap, PowerLaw]:
    """Return a map with four points in its last wave, and its gradients below its longest wave."""
    q = 2.0 * np.pi * np.fft.fftfreq(points, LENGTH / points)
    number = np.hypot(q[:, None], q)
    last = 2.0 * np.pi * points / POINTS_IN_WAVE / LENGTH
    rough = (number > 0.999 * 2.0 * np.pi / LONGEST) & (number < 1.0001 * last)
    amplitude = np.where(rough, np.where(number > 0.0, number, 1.0) ** (-1.0 - hurst), 0.0)
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal((points, points)))
    slope = np.fft.ifft2(1j * q[:, None] * amplitude * noise).real.std()
    heights = np.fft.ifft2(amplitude * noise).real * (SLOPE / slope)
    # white noise of variance 1 on these points has the density (step/(2 pi))^2
    level = (SLOPE / slope * LENGTH / points / (2.0 * np.pi)) ** 2
    x = np.arange(points) * LENGTH / points
    growth = 2.0 * np.pi * level * (2.0 * np.pi / LONGEST) ** (2.0 - 2.0 * hurst)
    return HeightMap(x, x, heights), PowerLaw(hurst, growth)


def judged(case: GaussianCase, points: int, octaves: int) -> tuple[float, float]:
    """Return contact fraction and friction by diffusion over those of the contact with all waves.

    The diffusion starts from the contact with waves so many octaves longer. The judge has four
    points in the last wave: its area is 1 % high and its friction from dissipation 1 % low.
    """
    surface, law = gaussian_map(points, case.hurst, case.seed)
    last = POINTS_IN_WAVE * LENGTH / points
    first = last * 2**octaves
    stiffness = abs(complex(case.rubber.plane_strain_modulus(4.4 * case.speed / last)))
    pressure = case.share * SLOPE * stiffness
    load = {"pressure": pressure, "speed": case.speed}
    start, judge = (
        gs.solve_rough_contact(
            case.rubber,
            surface,
            smallest_wavelength=cut_off,
            periodic=True,
            tolerance=tolerance,
            most_points=2**20,
            workers=1,
            **load,
        )
        for cut_off, tolerance in ((first, START_TOLERANCE), (last, None))
    )
    below = PowerLaw(law.hurst, law.growth * (LONGEST / first) ** (2.0 - 2.0 * law.hurst))
    pressures = ContactPressures(
        start.pressure[start.active],
        min(start.contact_fraction, 1.0),
        start.friction_from_dissipation,
        first,
    )
    found = diffusion(case.rubber, pressures, below, smallest_wavelength=last, **load)
    assert found.converged
    return (
        found.contact_fraction / judge.contact_fraction,
        found.friction / judge.friction_from_dissipation,
    )
