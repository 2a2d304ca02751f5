"""Eight waves slid in time from rest: small to steep slopes, weak to strong memory."""

from dataclasses import dataclass
from typing import Any

import numpy as np

import gripscale as gs

WAVELENGTH = 1e-3
SPEED = 1.0
PASSAGE = WAVELENGTH / SPEED
RELAXED = 3e6


@dataclass(frozen=True)
class TransientCase:
    """A wave, a rubber and a load, all in ratios."""

    slope: float
    """A / lambda."""
    pressure_ratio: float
    """p / |E*(w_1)|."""
    moduli: tuple[float, ...]
    """Over E_inf."""
    passages: tuple[float, ...]
    """Relaxation times over the time of passage of a wave."""

    @property
    def rubber(self) -> gs.Rubber:
        """The rubber."""
        moduli, times = np.array(self.moduli) * RELAXED, np.array(self.passages) * PASSAGE
        return gs.Rubber(RELAXED, moduli, times, bulk_modulus=1e9)

    @property
    def wave(self) -> dict[str, float]:
        """Wavelength and amplitude, as keyword arguments."""
        return {"wavelength": WAVELENGTH, "amplitude": self.slope * WAVELENGTH}

    @property
    def pressure(self) -> float:
        """Mean pressure [Pa]."""
        modulus = complex(self.rubber.complex_modulus(2.0 * np.pi / PASSAGE))
        return self.pressure_ratio * abs(modulus)

    def stage(self, passages: float, speed: float = SPEED) -> gs.Stage:
        """Return a stage of the programme as long as some passages of the wave at `SPEED`."""
        return gs.Stage(passages * PASSAGE, speed, self.pressure)

    def steady(self, speed: float = SPEED, **options: Any) -> gs.ScaleResult:
        """Solve the steady state."""
        return gs.solve_scale(
            self.rubber, **self.wave, pressure=self.pressure, speed=speed, **options
        )

    def run(self, *stages: gs.Stage, **options: Any) -> gs.TransientResult:
        """Slide from rest through a programme."""
        return gs.solve_transient(self.rubber, **self.wave, stages=stages, **options)


CASES = (
    TransientCase(0.01, 0.02, (2.0,), (0.1,)),
    TransientCase(0.01, 0.01, (9.0,), (0.05,)),
    TransientCase(0.05, 0.1, (1.0, 1.0), (0.03, 0.3)),
    TransientCase(0.1, 0.1, (2.0,), (0.1,)),
    TransientCase(0.1, 0.3, (4.0,), (0.2,)),
    TransientCase(0.2, 0.1, (2.0, 1.0), (0.05, 0.2)),
    TransientCase(0.2, 0.3, (2.0,), (0.2,)),
    TransientCase(0.3, 0.2, (1.0,), (0.1,)),
)

PLAIN = CASES[3]
"""A Zener solid on a moderate slope."""

SLOW = TransientCase(0.1, 0.1, (2.0, 3.0), (0.1, 50.0))
"""With a relaxation time of fifty passages."""
