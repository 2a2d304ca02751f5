"""Made-up roads and rubbers, written as the files a case names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gripscale import Profile, Rubber

MAXWELL = Rubber(6e6, [2e6, 3e6, 5e6], [1e-1, 1e-3, 1e-5])
"""Three relaxations, all within the frequencies of `write_maxwell`."""


def write_road(path: Path, road: Profile) -> None:
    """Write a profile in mm, to a nanometre."""
    rows = [f"{x * 1e3:.6f}\t{z * 1e3:.6f}" for x, z in zip(road.x, road.z, strict=True)]
    _write(path, "x [mm]\tz [mm]", rows)


def write_master_curve(
    path: Path, frequency: NDArray[np.float64], modulus: NDArray[np.complex128]
) -> None:
    """Write complex moduli [Pa] over frequency [Hz], in MPa."""
    pairs = zip(frequency, modulus / 1e6, strict=True)
    rows = [f"{f:.5e} {e.real:.6e} {e.imag:.6e}" for f, e in pairs]
    _write(path, "# Frequency (Hz) E' (MPa) E'' (MPa)", rows)


def three_waves(phase: float = 0.0) -> Profile:
    """Return a road of three waves, 0.4 m long; `phase` is that of the longest."""
    x = np.arange(4000) * 0.1  # mm
    z = 2.0 * np.cos(x / 3.0 + phase) + 0.7 * np.cos(x + 1.0) + 0.2 * np.cos(3.1 * x + 2.0)
    return Profile(1e-3 * x, 1e-3 * z)


def write_maxwell(path: Path) -> None:
    """Write the moduli of `MAXWELL` over eight decades of frequency."""
    frequency = np.geomspace(1e-2, 1e6, 60)
    write_master_curve(path, frequency, MAXWELL.complex_modulus(2 * np.pi * frequency))


def _write(path: Path, title: str, rows: list[str]) -> None:
    path.write_text("\n".join([title, *rows]) + "\n", encoding="utf-8")
