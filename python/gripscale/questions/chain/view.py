"""A model's Dataset as tables, figures and pages read it; what a model has not is left out.

Only a chain has waves (dimension `scale`). Numbers of those that did not converge are in the
Dataset, and hidden by `usable`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gripscale.core.arrays import Array
from gripscale.core.units import DisplayUnit, display_unit_of
from gripscale.experiment.design import CONVERGED

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class PredictionView:
    """A prediction: its Dataset and, where several stand together, its name."""

    data: xr.Dataset
    name: str = ""

    @property
    def moving(self) -> bool:
        """Whether it slides: rubber at rest has no friction to show."""
        return float(self.data["nominal_speed"]) > 0.0

    @property
    def title(self) -> str:
        """What tables and figures call it."""
        speed = self.display_unit("speed").text(float(self.data["nominal_speed"]))
        return f"Dynamic, {speed}" if self.moving else "Static"

    def display_unit(self, name: str) -> DisplayUnit:
        """Return how its `pressure`, `speed` or `footprint` is shown: as its case gives it."""
        return display_unit_of(self.data.attrs, name)

    @property
    def status(self) -> str:
        """`converged`, or why there are no totals."""
        return str(self.data["prediction_status"].item())

    @property
    def waves(self) -> int:
        """Number of waves solved, a failed one included; 0 for a model without waves."""
        return int(self.data.sizes.get("scale", 0))

    @property
    def complete(self) -> bool:
        """Whether everything was solved and may be used."""
        return self.status == CONVERGED and bool(self.converged.all())

    @cached_property
    def converged(self) -> NDArray[np.bool_]:
        """Whether each wave may be used."""
        if "status" not in self.data:
            return np.zeros(self.waves, dtype=bool)
        return np.asarray(self.data["status"].values == CONVERGED, dtype=bool)

    def why(self, i: int) -> str:
        """Return the status of wave `i`, and how much of its pressure was reached."""
        state = str(self.data["status"].values[i])
        reached = self.column("load_reached")[i] if self.has("load_reached") else math.nan
        if self.converged[i] or not math.isfinite(reached):
            return state
        return f"{state} at {100.0 * reached:.3g} % of the pressure"

    def total(self, name: str) -> float:
        """Return one of `gripscale.model.TOTALS`."""
        return float(self.data[f"total_{name}"])

    def has(self, name: str) -> bool:
        """Return whether there is a column `name` over the waves."""
        return name in self.data and "scale" in self.data[name].dims

    def column(self, name: str) -> Array:
        """Return a column over the waves."""
        return np.asarray(self.data[name].values, dtype=float)

    def usable(self, name: str) -> Array:
        """Return a column with NaN where the wave did not converge."""
        return np.where(self.converged, self.column(name), np.nan)

    def pressure_along(self, i: int) -> tuple[Array, Array]:
        """Return x/wavelength from -1/2 to 1/2, crest at 0, and the contact pressure [Pa] there."""
        x, pressure = self.column("surface_x")[i], self.column("surface_pressure")[i]
        finite = np.isfinite(x)
        phase = np.mod(x[finite] / self.column("wavelength")[i] + 0.5, 1.0) - 0.5
        order = np.argsort(phase)
        inside, values = phase[order], pressure[finite][order]
        end = np.interp(0.5, [inside[-1], inside[0] + 1.0], [values[-1], values[0]])
        return np.array([-0.5, *inside, 0.5]), np.array([end, *values, end])

    def mesh_along(self, i: int) -> tuple[Array, Array] | None:
        """Return the deformed nodes of wave `i` in wavelengths, set down on the wave, or None.

        Shape (layers, columns + 1) each, the surface first.
        """
        if not (self.has("mesh_x") and self.has("mesh_z")):
            return None
        x, z = self.column("mesh_x")[i], self.column("mesh_z")[i]
        layers, columns = np.isfinite(x).any(axis=1), np.isfinite(x).any(axis=0)
        if not layers.any():
            return None
        length, amplitude = self.column("wavelength")[i], self.column("amplitude")[i]
        x, z = x[layers][:, columns] / length, z[layers][:, columns] / length
        wave = amplitude / length * np.cos(2.0 * math.pi * x[0])
        return x, z - np.min(z[0] - wave)
