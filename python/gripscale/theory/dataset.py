"""What a theory answers as a Dataset, with the names every model has."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from gripscale import model, versions
from gripscale.cut_off_exponents import NOT_CONVERGED, of_curve
from gripscale.rubber.extrapolation import by_wavelength

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import NominalLoad
    from gripscale.rubber import Rubber
    from gripscale.wave.status import Status

Variable = tuple[str, Any, str, str]
"""Name, which is the attribute too, dimension, unit and meaning."""


class TheoryResult(Protocol):
    """What the results of all theories have."""

    @property
    def rubber(self) -> Rubber: ...  # noqa: D102
    @property
    def load(self) -> NominalLoad: ...  # noqa: D102
    @property
    def wavelength(self) -> NDArray[np.float64]: ...  # noqa: D102
    @property
    def running_friction(self) -> NDArray[np.float64]: ...  # noqa: D102
    @property
    def contact_fraction(self) -> float: ...  # noqa: D102
    @property
    def friction(self) -> float: ...  # noqa: D102
    @property
    def status(self) -> Status: ...  # noqa: D102
    @property
    def converged(self) -> bool: ...  # noqa: D102


def theory_dataset(
    result: TheoryResult, variables: Sequence[Variable], *, name: str, title: str, source: str
) -> xr.Dataset:
    """Return `variables` over `scale`, the wavelengths; totals are NaN unless it converged."""
    import xarray as xr

    from gripscale.wave.dataset import labelled

    data = {
        variable: labelled(dims, getattr(result, variable), unit, text, source)
        for variable, dims, unit, text in variables
    }
    number = np.arange(1, result.wavelength.size + 1)
    coordinate = labelled("scale", number, "1", "number of the wavelength", source)
    totals = {
        "total_contact_fraction": result.contact_fraction,
        "total_friction": result.friction,
        "total_friction_from_dissipation": result.friction,
    }
    if not result.converged:
        totals = dict.fromkeys(totals, math.nan)
    made = xr.Dataset(data, coords={"scale": coordinate}).assign_attrs(
        title=title,
        rubber=f"{result.rubber.name}; {result.rubber.source}".strip("; "),
        rubber_parameters=json.dumps(result.rubber.to_dict()),
        method=source,
        **versions.attributes(),
    )
    beyond = by_wavelength(
        result.rubber, result.load.speed, result.wavelength, result.running_friction
    )
    area = getattr(result, "running_contact_fraction", np.full(number.size, math.nan))
    exponents = NOT_CONVERGED
    if result.converged:
        moving = result.load.speed > 0.0
        exponents = of_curve(result.wavelength, area, result.running_friction, moving=moving)
    return model.answer(made, totals, str(result.status), name, result.load, beyond, exponents)
