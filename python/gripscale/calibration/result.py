"""What a calibration answers, as numbers and as a Dataset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from gripscale.calibration.fitted import FittedLaw

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False)
class Calibration(FittedLaw):
    """A law of the area term fitted to measured friction beside a predicted hysteresis."""

    def to_dataset(self) -> xr.Dataset:
        """Return all of it as a labelled Dataset, see `gripscale.calibration.dataset`."""
        from gripscale.calibration.dataset import to_dataset

        return to_dataset(self)
