"""The chain as one of the models that can be compared, varied, drawn and reported."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

from gripscale import checks, model, versions
from gripscale.chain.predict import ChainError, predict
from gripscale.chain.pressure import MOST_CLASSES
from gripscale.chain.rubber_at import RubberAt
from gripscale.conditions.conditions import Conditions
from gripscale.errors import ExtrapolationError
from gripscale.rubber.extrapolation import CHOICES
from gripscale.surface import PreparedSurface, SineStack
from gripscale.wave.block import FiniteStrainBlock
from gripscale.wave.solver import WaveSolver

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber


@dataclass(frozen=True)
class Chain:
    """Waves solved one after the other, each with the pressure that leaves the one above.

    Parameters
    ----------
    solver : WaveSolver
        What solves one wave.
    rubber_at : RubberAt, optional
        Conditions that change the rubber on the way; a frozen dataclass, so that it can be kept.
    pressure_classes : int
        In how many classes of equal load a wave hands its pressure down, see `predict`.
    extrapolate : str
        "say" or "refuse", see `predict`.
    conditions : Conditions, optional
        Temperature, softening, heat and area term, see `predict`.

    Raises
    ------
    InputError
        If `pressure_classes` is no whole number from 1 to 64, or `extrapolate` another word.
    """

    name: ClassVar[str] = "chain"

    solver: WaveSolver = field(default_factory=FiniteStrainBlock)
    rubber_at: RubberAt | None = None
    pressure_classes: int = 1
    extrapolate: str = "say"
    conditions: Conditions | None = None

    def __post_init__(self) -> None:
        checks.one_of("extrapolate", self.extrapolate, CHOICES)
        checks.whole("pressure_classes", self.pressure_classes, least=1, most=MOST_CLASSES)

    def relevant(self, surface: PreparedSurface) -> PreparedSurface:
        """Return nothing of `surface` but its waves."""
        sines = SineStack(surface.sines.wavelength, surface.sines.amplitude)
        return PreparedSurface(sines, source="")

    def predict(
        self,
        rubber: Rubber,
        surface: PreparedSurface,
        load: NominalLoad,
        *,
        on_progress: Callable[[Any], None] | None = None,
    ) -> xr.Dataset:
        """Return the prediction as a Dataset; `on_progress` gets the `Prediction` so far.

        A wave that does not converge ends the chain and is its last, refused extrapolation ends it
        before the first; `prediction_status` says why.
        """
        try:
            result = predict(
                rubber,
                surface.sines,
                pressure=load.pressure,
                speed=load.speed,
                footprint=load.footprint,
                pressure_classes=self.pressure_classes,
                load_time=load.load_time,
                solver=self.solver,
                rubber_at=self.rubber_at,
                extrapolate=self.extrapolate,
                conditions=self.conditions,
                on_scale=on_progress,
            )
        except ChainError as failure:
            return failure.partial.to_dataset().assign(prediction_status=str(failure))
        except ExtrapolationError as refusal:
            return _refused(str(refusal), load)
        return result.to_dataset()


def _refused(why: str, load: NominalLoad) -> xr.Dataset:
    """Return the answer of a chain that was not begun."""
    import xarray as xr

    nothing = xr.Dataset(attrs=versions.attributes())
    return model.answer(nothing, dict.fromkeys(model.TOTALS, math.nan), why, Chain.name, load)
