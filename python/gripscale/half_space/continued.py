"""Model of profiles whose roughness goes on below the measurement."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

from gripscale.core import checks
from gripscale.core.checks import checked
from gripscale.core.errors import InputError
from gripscale.half_space.below_measurement import (
    BAND,
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
    """Direct contact of profiles that are continued below their sampling, labelled as such.

    The answer holds the curves of `contact_by_cut_off` over `cut_off`, and as its estimated errors
    the standard error of a continuation. The fields are arguments of that function. It needs
    profiles: a map has no lines as long as a wave of its roughness has to be.
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

        Raises `InputError` as `contact_by_cut_off` does, and if the surface has no profiles.
        """
        measured = surface.measured
        if measured is None or measured.map is not None:
            kind = "waves stated by hand" if measured is None else "a map"
            raise InputError(f"roughness is continued below measured profiles; got {kind}")
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
        error = BAND * math.sqrt(curve.octaves_below[-1]) / QUANTILE_90
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
