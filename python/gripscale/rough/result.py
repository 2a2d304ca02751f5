"""What the direct contact answers, as numbers and as a Dataset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from gripscale.rough.solved import SolvedContact

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class RoughContact(SolvedContact):
    """Contact and friction of a whole surface, with the evidence for them (m, Pa, m/s)."""

    @property
    def friction_by_wavelength(self) -> xr.Dataset:
        """Friction and contact fraction by octave of wavelength, see `rough.dataset`."""
        from gripscale.rough.dataset import by_wavelength

        return by_wavelength(self)

    def to_dataset(self, *, fields: bool = True) -> xr.Dataset:
        """Return everything as a labelled Dataset, with `fields` what lies on the grid too."""
        from gripscale.rough.dataset import to_dataset

        return to_dataset(self, fields=fields)
