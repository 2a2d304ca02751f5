"""A model that answers where it would refuse, so that one sample of many does not end them all."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gripscale import model, versions
from gripscale.errors import InputError
from gripscale.model import Model, NominalLoad
from gripscale.rubber import Rubber
from gripscale.surface import PreparedSurface

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Attempt:
    """Another model, whose refusal of an input is an answer without totals that says why."""

    model: Model

    @property
    def name(self) -> str:
        """Word for the model within."""
        return self.model.name

    def relevant(self, surface: PreparedSurface) -> PreparedSurface:
        """Return what the model within depends on."""
        return self.model.relevant(surface)

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the answer of the model within, or why there is none as `prediction_status`."""
        import xarray as xr

        try:
            return self.model.predict(rubber, surface, load, on_progress=on_progress)
        except InputError as refusal:
            nothing = xr.Dataset(attrs=versions.attributes())
            totals = dict.fromkeys(model.TOTALS, math.nan)
            return model.answer(nothing, totals, str(refusal), self.name, load)
