"""What the flash temperature of a closed program counts, and what a whole footprint adds to it.

    python -m studies.flash_temperature

Compound S100 on random phases of the measured spectrum, 3 bar, 0.68 m/s, 20 C. The program's rises
are known at three magnifications, its friction over speed; not its thermal constants, nor for how
long it heats. One minute.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import gripscale as gs
from gripscale.conditions import Conditions, ThermalProperties
from gripscale.conditions.flash_temperature import ierfc
from gripscale.core import Array
from gripscale.half_space.conditions import octave_heats, temperature
from gripscale.rubber.softening import softening_of_sweeps
from studies.treads import compound, road_spectrum, sweeps

PRESSURE, SPEED, FOOTPRINT = 3e5, 0.68, 0.1
MAGNIFICATION = (0.46, 3.08, 3.83)
"""Decades of the wavenumber above the first of the spectrum."""
PROGRAM = (0.1, 4.3, 5.9)
"""Its rises there [K]."""
PROGRAM_FRICTION = 0.53
POINTS = 2**16
DEPTHS = {"exp(-2 q z), mean 1/(2 q)": (0.5, 1), "(q z)^2 exp(-2 q z), mean 3/(2 q)": (1.5, 3)}
"""Mean depth of the loss times q, and shape of its gamma distribution."""
LENGTHS = (1e-3, 2e-3, 3e-3, 5e-3, 1e-2, FOOTPRINT)
"""Lengths over which a point of the rubber is heated [m]."""
HEAT = ThermalProperties()


def random_line(seed: int) -> gs.Profile:
    """Return a periodic line of a surface with the road's spectrum and random phases."""
    spectrum = road_spectrum()
    first, last = spectrum.wavenumber[0], spectrum.wavenumber[-1]
    length = 2.0 * np.pi / first
    along = first * np.arange(1, POINTS // 2)
    across = np.append(0.0, np.geomspace(1.0, last, 400))
    density = spectrum.at(np.hypot(along[:, None], across[None, :]))
    # half a squared amplitude is what all waves with this q_x, of both signs, add to the variance
    amplitude = np.sqrt(2.0 * 2.0 * first * 2.0 * np.trapezoid(density, across, axis=1))
    half = np.zeros(POINTS // 2 + 1, dtype=complex)
    turns = np.random.default_rng(seed).random(along.size)
    half[1:-1] = 0.5 * POINTS * amplitude * np.exp(2j * np.pi * turns)
    return gs.Profile(np.arange(POINTS) * length / POINTS, np.fft.irfft(half, POINTS))


def rise_between(depth: float, other: float, shape: int, time: float) -> float:
    """Return the rise at gamma depths of one mean [m] by unit heat at those of another."""
    draw = np.random.default_rng(0)
    z, source = (draw.gamma(shape, mean / shape, 100_000) for mean in (depth, other))
    length = 2.0 * np.sqrt(HEAT.diffusivity * time)
    both = ierfc(np.abs(z - source) / length) + ierfc((z + source) / length)
    return float(length * both.mean() / (2.0 * HEAT.conductivity))


def uniform_rises(
    at: Array, wavenumber: Array, friction: Array, mean: float, shape: int, time: float
) -> list[float]:
    """Return the rises at wavenumbers [rad/m] by the heat of octaves, even over the surface."""
    flux = PRESSURE * SPEED
    return [
        flux
        * sum(
            mu * rise_between(mean / q, mean / k, shape, time)
            for k, mu in zip(wavenumber, friction, strict=True)
        )
        for q in at
    ]


def main() -> None:
    """Print the rises for both depths, and those of the contact as the package solves it."""
    rubber = compound("S100")
    softening = softening_of_sweeps(list(sweeps("S100").values()), measured_at=1e-3)
    options: dict[str, Any] = {
        "pressure": PRESSURE,
        "speed": SPEED,
        "periodic": True,
        "tolerance": None,
    }
    line = random_line(1)
    cold = gs.solve_rough_contact(
        rubber, line, conditions=Conditions(softening=softening), **options
    )
    heats = octave_heats(cold.grid, cold.pressure, cold.lost_by_harmonic())
    wavenumber = np.array([heat.wavenumber for heat in heats])
    share = np.array([heat.friction for heat in heats])
    share /= share.sum()
    at = road_spectrum().wavenumber[0] * 10.0 ** np.array(MAGNIFICATION)
    print(f"hysteresis friction {cold.friction_from_dissipation:.3f}, program {PROGRAM_FRICTION}")
    print("| depth of the loss | heated over mm | rise K at 10^0.46, 10^3.08, 10^3.83 |")
    print("|---|---|---|")
    print(f"| program | not stated | {', '.join(map(str, PROGRAM))} |")
    for name, (mean, shape) in DEPTHS.items():
        for length in LENGTHS:
            rises = uniform_rises(
                at, wavenumber, PROGRAM_FRICTION * share, mean, shape, length / SPEED
            )
            print(f"| {name} | {1e3 * length:g} | {', '.join(f'{t:.2f}' for t in rises)} |")
    both = Conditions(softening=softening, heat=HEAT)
    hot = gs.solve_rough_contact(rubber, line, conditions=both, footprint=FOOTPRINT, **options)
    for length in (3e-3, FOOTPRINT):
        octaves, field = temperature(hot, both, length / SPEED)
        logs = np.log([heat.wavenumber for heat in octaves])
        solved = np.interp(np.log(at), logs, field.octave)
        print(
            f"solved with heat, friction {hot.friction_from_dissipation:.3f}, over "
            f"{1e3 * length:g} mm: {', '.join(f'{t:.2f}' for t in solved)}"
        )


if __name__ == "__main__":
    main()
