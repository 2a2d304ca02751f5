"""The test of docs/isotropic-maps.md on a surface that is known: stones, and a few lines of them.

Stones are caps of random place, size, height and tilt, the highest of which is seen; maps made from
sixteen lines of a square of 102.4 mm are compared with the square itself. Run as
`python -m studies.known_surface`; some minutes of one core.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gripscale.surface import HeightMap, Profile
from studies.isotropic_maps.map_factor import map_over_lines, solve_map_and_lines
from studies.isotropic_maps.setting import AREA, FRICTION, LOAD, TOLERANCE
from studies.shipped import tread

POINTS, STEP = 1024, 1e-4
STONES = 900
RADIUS = (3e-3, 7e-3)
HEIGHT, TILT, CURVATURE = 1.2e-3, 0.12, 20.0
"""Rms height [m] and slope of a cap's middle; its curvature [1/m]."""
FLOOR = -5e-3
ROUGHNESS = 1.5e-5
EDGE = 1.5e-4
"""Width over which an edge is rounded [m]."""


def stones(seed: int) -> HeightMap:
    """Return one period of the highest of many caps, rounded, with a little roughness."""
    random = np.random.default_rng(seed)
    length = POINTS * STEP
    x = STEP * np.arange(POINTS, dtype=np.float64)
    z = np.full((POINTS, POINTS), FLOOR)
    for _ in range(STONES):
        middle, radius = random.random(2) * length, random.uniform(*RADIUS)
        top, tilt = HEIGHT * random.standard_normal(), TILT * random.standard_normal(2)
        a, b = ((x - at + 0.5 * length) % length - 0.5 * length for at in middle)
        near = np.ix_(np.abs(a) < radius, np.abs(b) < radius)
        a, b = a[near[0]], b[near[1]]
        square = a**2 + b**2
        cap = top + tilt[0] * a + tilt[1] * b - 0.5 * CURVATURE * square
        z[near] = np.maximum(z[near], np.where(square < radius**2, cap, FLOOR))
    q = 2.0 * np.pi * np.hypot(np.fft.fftfreq(POINTS, STEP)[:, None], np.fft.fftfreq(POINTS, STEP))
    waves = np.fft.fft2(z) * np.exp(-0.5 * (q * EDGE) ** 2)
    rough = np.fft.ifft2(_self_affine(q) * np.fft.fft2(random.standard_normal(z.shape))).real
    z = np.fft.ifft2(waves).real + ROUGHNESS * rough / rough.std()
    return HeightMap(x, x, z - z.mean(), "stones")


def _self_affine(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return amplitudes of H = 0.8 below 3 mm."""
    return np.where(q > 0.0, np.maximum(q, 2.0 * np.pi / 3e-3) ** -1.8, 0.0)


def main() -> None:
    """Print the known map and its lines, then the maps made from them."""
    rubber, surface = tread(), stones(0)
    known = solve_map_and_lines(rubber, surface, lines=16, tolerance=TOLERANCE, **LOAD)
    print("known", known, flush=True)
    lines = [
        Profile(surface.x, surface.z[:, at], f"line {at}") for at in range(0, POINTS, POINTS // 16)
    ]
    for construction in ("spectrum", "lines"):
        found = map_over_lines(
            rubber, lines, construction=construction, seeds=range(3), tolerance=TOLERANCE, **LOAD
        )
        for name in (AREA, FRICTION):
            maps = [one.whole[name] for one in found.maps]
            truth = known.whole[name]
            print(
                f"{construction}, {name}: lines over measured {found.match(name):.3f}, map "
                f"{np.mean(maps):.4f} +- {np.std(maps, ddof=1):.4f} (known {truth:.4f}), factor "
                f"{found.factor(name):.3f} +- {found.scatter(name):.3f} (known "
                f"{truth / known.lines[name]:.3f})",
                flush=True,
            )


if __name__ == "__main__":
    main()
