"""Direct contact of profiles with roughness continued below the measurement."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from gripscale.core import checks
from gripscale.core.checks import checked
from gripscale.core.errors import InputError
from gripscale.half_space.below_measurement import (
    OwnFaces,
    Roughness,
    as_roughness,
    contact_by_cut_off,
)
from gripscale.half_space.model import DirectContact
from gripscale.model import STATUS

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import Load, OnProgress
    from gripscale.rubber import Rubber
    from gripscale.surface import Surface

DOWN_TO = 10e-6
"""Usual end of a continuation [m]: about the depth of a measured texture of a stone's face."""


class ContinuedContact(DirectContact):
    """Direct contact of profiles, continued below their sampling and labelled as such.

    The answer holds the curves of `contact_by_cut_off` over `cut_off`, and as its estimated errors
    the standard error of a continuation. `down_to`, `roughness` and `seed` are arguments of this
    function; `periodic` and `tolerance` have no effect.
    """

    name: ClassVar[str] = "continued"

    tolerance: float | None = None
    down_to: float = checked(checks.positive, unit="m", default=DOWN_TO)
    roughness: Roughness = checked(as_roughness, default=OwnFaces())
    seed: int = checked(checks.whole, least=0, most=2**32 - 1, default=0)

    def predict(
        self, rubber: Rubber, surface: Surface, load: Load, *, on_progress: OnProgress = None
    ) -> xr.Dataset:
        """Return the answer with the curves over `cut_off`; `on_progress` gets each contact.

        Raises `InputError` as `contact_by_cut_off` does, and unless the surface is measured
        profiles.
        """
        measured = surface.measured
        if measured is None or measured.map is not None:
            surface_kind = "waves stated by hand" if measured is None else "a map"
            raise InputError(
                "roughness below the measurement is continued from measured profiles; "
                f"got {surface_kind}"
            )
        curve = contact_by_cut_off(
            rubber,
            measured.cleaned,
            pressure=load.pressure,
            speed=load.speed,
            down_to=self.down_to,
            roughness=self.roughness,
            seed=self.seed,
            on_contact=on_progress,
            conditions=self.conditions,
            footprint=load.footprint,
        )
        answer = self._answer(curve.steps[-1].contacts, surface, load)
        if answer[STATUS].item() != "converged":
            return answer
        error = float(np.arcsinh(curve.band[-1])) / QUANTILE_90
        for name in ("contact_fraction", "friction"):
            about = answer[f"{name}_error"].attrs
            answer[f"{name}_error"] = (error * answer[name]).assign_attrs(about)
        curves = curve.to_dataset()
        return answer.merge(curves.rename(CURVE_NAMES).drop_vars("status"))


QUANTILE_90 = 1.645
"""Half width of the 90 % interval of a Gaussian over its standard deviation."""

CURVE_NAMES = {
    name: f"curve_{name}"
    for name in (
        "contact_fraction",
        "contact_fraction_lower",
        "contact_fraction_upper",
        "friction",
        "friction_from_dissipation",
        "friction_from_dissipation_lower",
        "friction_from_dissipation_upper",
        "slope_in_contact",
        "octave_slope",
        "measured",
    )
}
"""Names of the curves in an answer: `friction` without a dimension is that of the last cut-off."""
