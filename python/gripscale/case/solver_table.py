"""[solver] and [chain] of a case: what solves a wave, and what goes on from wave to wave."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, model_validator

from gripscale.case.quantity import Duration
from gripscale.case.table import Table
from gripscale.chain.pressure import MOST_CLASSES


class Solver(Table):
    """The model of one wave and its mesh; what is not stated stays at the solver's default."""

    model: Literal["finite_strain", "half_plane"] = "finite_strain"
    """What solves a wave: the block at finite strain or the half-plane at small strain."""
    columns: int | None = Field(default=None, ge=4, le=4096, multiple_of=2)
    """Elements along the block, doubled where the two frictions differ."""
    rows: int | None = Field(default=None, ge=2, le=256)
    """Elements across the block."""
    depth: float | None = Field(default=None, gt=0.0, allow_inf_nan=False)
    """Height of the block over the wavelength."""
    element_order: Literal[1, 2] | None = None
    """Order of the elements."""
    tolerance: float | None = Field(default=None, gt=0.0, lt=1.0, allow_inf_nan=False)
    """The mesh is refined until the estimated errors are below this."""
    time_limit: Duration | None = None
    """A wave that takes longer is given up."""
    points: int | None = Field(default=None, ge=16, le=8192)
    """Points of the half-plane."""

    @model_validator(mode="after")
    def _options_of_the_model(self) -> Solver:
        mesh = ["columns", "rows", "depth", "element_order", "tolerance", "time_limit"]
        foreign = ["points"] if self.model == "finite_strain" else mesh
        for name in foreign:
            if getattr(self, name) is not None:
                raise ValueError(f'{name} is not an option of model = "{self.model}"')
        return self

    def options(self) -> dict[str, Any]:
        """Return the stated options as keyword arguments of the solver."""
        return self.model_dump(exclude={"model"}, exclude_none=True)


class ChainOptions(Table):
    """What goes on from wave to wave."""

    pressure_classes: int = Field(default=1, ge=1, le=MOST_CLASSES)
    """Classes of equal load in which the pressure is handed down; 1: its mean."""
