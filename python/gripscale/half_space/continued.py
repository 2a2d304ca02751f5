"""Model of profiles and maps whose roughness goes on below the measurement."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from gripscale.core import checks
from gripscale.core.checks import checked
from gripscale.core.errors import InputError
from gripscale.half_space.below_measurement import (
    ContactByCutOff,
    OwnFaces,
    Roughness,
    as_roughness,
    contact_by_cut_off,
)
from gripscale.half_space.map_below_measurement import map_by_cut_off
from gripscale.half_space.model import DirectContact
from gripscale.model import STATUS, TOTALS, of_curve, with_area_term
from gripscale.model import answer as model_answer
from gripscale.rubber.extrapolation import by_wavelength

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.model import Load, OnProgress
    from gripscale.rubber import Rubber
    from gripscale.surface import Surface

DOWN_TO = 10e-6
"""Usual end of a continuation [m]: about the depth of a measured texture of a stone's face."""


class ContinuedContact(DirectContact):
    """Direct contact of profiles or a map, continued below their sampling and labelled as such.

    The answer holds the curves of `contact_by_cut_off`, or of `map_by_cut_off`, over `cut_off`, and
    as its estimated errors the standard error of a continuation. The fields are arguments of these
    functions: `seed` is that of lines; `periodic` and `tolerance` are those of maps. Numbers of a
    map's pressures, such as friction by octave, are those of its measured waves.
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

        Raises `InputError` as `contact_by_cut_off` and `map_by_cut_off` do, and if the surface was
        not measured.
        """
        measured = surface.measured
        if measured is None:
            raise InputError(
                "roughness is continued below measured profiles or a map; got waves stated by hand"
            )
        options: dict[str, Any] = {
            "pressure": load.pressure,
            "speed": load.speed,
            "down_to": self.down_to,
            "roughness": self.roughness,
            "on_contact": on_progress,
            "conditions": self.conditions,
            "footprint": load.footprint,
        }
        if measured.map is None:
            curve = contact_by_cut_off(rubber, measured.cleaned, seed=self.seed, **options)
        else:
            options |= {"periodic": self.periodic, "tolerance": self.tolerance}
            curve = map_by_cut_off(rubber, measured.map, **options)
        answer = self._answer(curve.steps[-1].contacts, surface, load)
        if answer[STATUS].item() != "converged":
            return answer
        if measured.map is not None:
            answer = _with_diffusion(answer, curve, load)
        error = float(np.arcsinh(curve.band[-1])) / QUANTILE_90
        for name in ("contact_fraction", "friction"):
            about = answer[f"{name}_error"].attrs
            answer[f"{name}_error"] = (error * answer[name]).assign_attrs(about)
        curves = curve.to_dataset()
        return answer.merge(curves.rename(CURVE_NAMES).drop_vars("status"))


def _with_diffusion(answer: xr.Dataset, curve: ContactByCutOff, load: Load) -> xr.Dataset:
    """Return the answer of a map's measured waves with the numbers of the last cut-off."""
    contact, last = curve.steps[-1].contacts[0], curve.steps[-1]
    totals = {total: last.mean(total.removeprefix("total_")) for total in TOTALS}
    for total, value in totals.items():
        name = total.removeprefix("total_")
        answer[name] = answer[name].copy(data=[value])
    friction = curve.values("friction_from_dissipation")
    beyond = by_wavelength(contact.rubber, load.speed, curve.wavelength, friction)
    exponents = of_curve(
        curve.wavelength, curve.values("contact_fraction"), friction, moving=load.speed > 0.0
    )
    adhesive = contact.adhesive_friction * last.mean("contact_fraction") / contact.contact_fraction
    status, model = answer[STATUS].item(), answer.attrs["model"]
    return with_area_term(
        model_answer(answer, totals, status, model, load, beyond, exponents), adhesive
    )


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
