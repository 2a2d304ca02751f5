"""A model of your own, in twenty lines, varied, kept on disk and tabulated as the chain is.

A rough surface far from full contact touches in proportion to the load,
A_r/A_0 = kappa p / (|E*| h') with kappa near 2 and h' the rms slope (Hyun et al., Phys. Rev. E 70
(2004) 026117). The friction is a guess of the right order: slope times sine of the loss angle.

A model of the package is one such class in a file of its own, named in a list where a case file
shall know it by its word; nothing that varies, draws or reports is touched.
Run as `python examples/toy_model.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from rich.console import Console

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.model import Load, Model, predicted_answer
from gripscale.questions import Study, Variation
from gripscale.surface.surface import Surface, SurfacePart

CASE = Path(__file__).parent / "three_waves" / "case.toml"


@dataclass(frozen=True)
class Proportional(Model):
    """Real contact in proportion to the load, on the slopes of all waves together."""

    name: ClassVar[str] = "proportional"
    needs: ClassVar[frozenset[SurfacePart]] = frozenset({"waves"})

    kappa: float = 2.0

    def predict(
        self,
        rubber: gs.Rubber,
        surface: Surface,
        load: Load,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the totals; there is nothing else to tell."""
        sines = surface.sines
        slope = float(np.sqrt(np.sum((2 * np.pi * sines.amplitude / sines.wavelength) ** 2) / 2))
        modulus = complex(rubber.complex_modulus(2 * np.pi * load.speed / sines.wavelength[-1]))
        friction = slope * modulus.imag / abs(modulus)
        totals = {
            "total_contact_fraction": min(1.0, self.kappa * load.pressure / abs(modulus) / slope),
            "total_friction": friction,
            "total_friction_from_dissipation": friction,
        }
        return predicted_answer(xr.Dataset(), totals, "converged", self.name, load)


def main(folder: str = "results/examples") -> None:
    """Vary speed and pressure of a case with it; print the table."""
    vary = {"speed": "0.01 m/s, 10 m/s", "pressure": "1 bar, 3 bar"}
    result = Study(read_case(CASE), vary, model=Proportional()).run(Path(folder) / "toy_model")
    Console(width=100).print(Variation(result).table())


if __name__ == "__main__":
    main(*sys.argv[1:2])
