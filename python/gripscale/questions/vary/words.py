"""What a page calls the numbers of a study."""

from __future__ import annotations

import numpy as np
import xarray as xr

from gripscale.model import ADHESIVE_FRICTION, FRICTION_OUTSIDE_BAND, WHY_NO_EXPONENT
from gripscale.questions.answer.estimate import AREA_TERM
from gripscale.questions.vary.axis import AXIS_LABELS
from gripscale.questions.vary.speed_and_temperature import BEYOND_SHIFT

_AT_REST = "static_"
"""Before the name of what a study says of rubber at rest."""

_WORDS = {
    "answer_total_friction": "friction μ with the area term, answer",
    "answer_total_friction_low": "its 90 %, from",
    "answer_total_friction_high": "to",
    "answer_friction_low": "its 90 %, from",
    "answer_friction_high": "to",
    "answer_contact_fraction_low": "its 90 %, from",
    "answer_contact_fraction_high": "to",
    "friction_ratio": "μ over that of the first",
    "contact_fraction_ratio": "A_r/A_0 over that of the first",
    "answer_friction": "friction μ, answer",
    "answer_contact_fraction": "real contact area A_r/A_0, answer",
    "total_contact_fraction": "real contact area A_r/A_0",
    "total_friction": "friction μ",
    "total_friction_from_dissipation": "μ from the energy lost",
    ADHESIVE_FRICTION: "μ of the area term",
    AREA_TERM: "μ of the area term, answer",
    FRICTION_OUTSIDE_BAND: "share of μ beyond the measured band",
    "total_decades_below_band": "decades below the measured band",
    "total_decades_above_band": "decades above the measured band",
    "total_contact_fraction_cut_off_exponent": "d ln(A_r/A_0) / d ln λ_min",
    "total_friction_cut_off_exponent": "d ln μ / d ln λ_min",
    WHY_NO_EXPONENT: "why there is no exponent",
    BEYOND_SHIFT: "temperature beyond those of the shift",
    "prediction_status": "status",
    "friction_by_decade": "friction μ of relaxation times",
    "contact_fraction": "contact fraction of each wave",
    "friction": "friction μ of each wave",
    "running_contact_fraction": "A_r/A_0 down to the wave",
    "running_friction": "μ down to the wave",
}
"""Words by the name in the result file; of others its `long_name` is taken."""


def words_of(data: xr.Dataset, name: str) -> str:
    """Return what a page calls a variable or an axis."""
    if name.startswith(_AT_REST):
        return f"{words_of(data, name.removeprefix(_AT_REST))}, at rest"
    if name in _WORDS:
        return _WORDS[name]
    plain = name.replace("_", " ")
    if name in AXIS_LABELS or name not in data.variables:
        return plain
    return str(data[name].attrs.get("long_name", plain))


_EVIDENCE = ("_error", "_half_width", "_uncertainty", "_low", "_high", "_freedom", "_share")
"""Ends of the names of numbers that say how well another one is known."""


def is_evidence(name: str) -> bool:
    """Return whether a number of a study says how well another one is known, not what it is."""
    return name.endswith(_EVIDENCE)


def telling(variable: xr.DataArray) -> bool:
    """Return whether some value is neither zero, missing nor an empty text."""
    if variable.dtype.kind in "fiub":
        return bool(np.nan_to_num(variable.values.astype(float)).any())
    return any(str(value) for value in variable.values.ravel())
