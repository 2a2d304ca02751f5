"""The variables of a study: what a page calls each of them, what it measures and its role.

Tables, charts and sentences of this room read this declaration; none of them looks into a name. A
variable of another model is a plain number that is called by its `long_name`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np
import xarray as xr

from gripscale.model import (
    ADHESIVE_FRICTION,
    BASIS,
    FRICTION_OUTSIDE_BAND,
    STATUS,
    STATUS_WORD,
    WHY_NO_EXPONENT,
)
from gripscale.questions.answer.estimate import AREA_TERM, BASIS_SHARES
from gripscale.questions.vary.axis import VARIED_INPUTS
from gripscale.questions.vary.speed_and_temperature import BEYOND_SHIFT
from gripscale.questions.words import HEADINGS, SYMBOLS


class Role(StrEnum):
    """What a variable is for."""

    ANSWER = "number of the answer"
    END = "end of its interval"
    NUMBER = "number of a model"
    EVIDENCE = "how well another number is known"
    STATUS = "how a prediction ended"
    RECORD = "where it is kept"


class StudyVariable(NamedTuple):
    """One variable of a study."""

    label: str  # what a page calls it
    role: Role = Role.NUMBER
    # `friction` or `contact_fraction`, of what is one of the two numbers of an answer.
    measures: str = ""
    running: bool = False  # whether it counts a wave and all longer ones
    at_rest: bool = True  # whether rubber at rest has it


# Numbers of an answer by the number they are of: what each is called, and its role.
_INTERVAL = {
    "answer_{}": ("{}, answer", Role.ANSWER),
    "answer_{}_low": ("its 90 %, from", Role.END),
    "answer_{}_high": ("to", Role.END),
    "answer_{}_half_width": ("relative half width of the {}", Role.EVIDENCE),
    "answer_{}_uncertainty": ("relative uncertainty of the {}", Role.EVIDENCE),
}
_PARTS = {
    "answer_{}_sampling_error": ("relative sampling error of the {}", Role.EVIDENCE),
    "answer_{}_grid_error": ("relative grid error of the {}", Role.EVIDENCE),
    "answer_{}_factor": ("factor, on the {} of the direct contact", Role.EVIDENCE),
    "answer_{}_factor_uncertainty": (
        "factor, uncertainty, on the {} of the direct contact",
        Role.EVIDENCE,
    ),
    "total_{}": ("{}", Role.NUMBER),
    "total_{}_error": ("error of the {}", Role.EVIDENCE),
    "total_{}_sampling_error": ("sampling error of the {}", Role.EVIDENCE),
}
_AREA = f"{HEADINGS['contact_fraction']} {SYMBOLS['contact_fraction']}"
_ANSWERED = {
    pattern.format(name): StudyVariable(
        label.format(words),
        role,
        measures if role in (Role.ANSWER, Role.NUMBER) else "",
        at_rest=measures != "friction",
    )
    for name, measures, words, patterns in (
        ("contact_fraction", "contact_fraction", _AREA, _INTERVAL | _PARTS),
        ("friction", "friction", "friction μ", _INTERVAL | _PARTS),
        ("total_friction", "friction", "friction μ with the area term", _INTERVAL),
    )
    for pattern, (label, role) in patterns.items()
}


# Further numbers of rubber that slides.
_NUMBERS = {
    "total_friction_from_dissipation": "μ from the energy lost",
    FRICTION_OUTSIDE_BAND: "share of μ beyond the measured band",
    "total_decades_below_band": "decades below the measured band",
    "total_decades_above_band": "decades above the measured band",
    "total_friction_cut_off_exponent": "d ln μ / d ln λ_min",
    WHY_NO_EXPONENT: "why there is no exponent",
    BEYOND_SHIFT: "temperature beyond those of the shift",
    "friction_by_decade": "friction μ of relaxation times",
    "octave_friction": "friction μ of octaves of wavelength",
}
_OF_A_SLIDING_WAVE = (
    *("sliding_speed", "load_time"),
    *("friction_from_dissipation", "friction_error", "friction_bound", "friction_mismatch"),
    *("angular_frequency", "loss_factor", "loss_modulus_ratio"),
    *("outside_band", "decades_below_band", "decades_above_band"),
)

# Numbers of each wave that are drawn.
PER_WAVE = {
    "running_contact_fraction": StudyVariable(
        "A_r/A_0 down to the wave", measures="contact_fraction", running=True
    ),
    "running_friction": StudyVariable(
        "μ down to the wave", measures="friction", running=True, at_rest=False
    ),
    "contact_fraction": StudyVariable("contact fraction of each wave", measures="contact_fraction"),
    "friction": StudyVariable("friction μ of each wave", measures="friction", at_rest=False),
}
# All variables that a study knows, of rubber that slides.
VARIABLES = {
    **_ANSWERED,
    **PER_WAVE,
    **{name: StudyVariable(label, at_rest=False) for name, label in _NUMBERS.items()},
    **{name: StudyVariable(name.replace("_", " "), at_rest=False) for name in _OF_A_SLIDING_WAVE},
    **{name: StudyVariable(text, Role.EVIDENCE) for name, text in BASIS.items()},
    **{
        f"answer_{name}": StudyVariable(name.replace("_", " "), Role.EVIDENCE, at_rest=False)
        for name in BASIS_SHARES
    },
    AREA_TERM: StudyVariable("μ of the area term, answer", Role.ANSWER, at_rest=False),
    ADHESIVE_FRICTION: StudyVariable("μ of the area term", Role.NUMBER, ADHESIVE_FRICTION),
    "total_contact_fraction_cut_off_exponent": StudyVariable("d ln(A_r/A_0) / d ln λ_min"),
    STATUS: StudyVariable("status", Role.STATUS),
    STATUS_WORD: StudyVariable("word of the status", Role.RECORD),
    "prediction_key": StudyVariable("key of the prediction", Role.RECORD),
    "factor_label": StudyVariable("factors of the answer", Role.RECORD, at_rest=False),
}


def rest_name(name: str) -> str:
    """Return the name of a number for rubber at rest."""
    return f"static_{name}"


_AT_REST = {
    rest_name(name): variable._replace(label=f"{variable.label}, at rest")
    for name, variable in VARIABLES.items()
    if variable.at_rest
}


def at_rest(data: xr.Dataset) -> xr.Dataset:
    """Return what a prediction says of rubber at rest, named and called so."""
    names = [str(name) for name in data.data_vars if VARIABLES.get(str(name), _PLAIN).at_rest]
    rest = data[names].rename({name: rest_name(name) for name in names})
    for variable in rest.data_vars.values():
        variable.attrs["long_name"] = f"{variable.attrs.get('long_name', '')}, at rest".lstrip(", ")
    return rest


_PLAIN = StudyVariable("")


def variable_of(data: xr.Dataset, name: str) -> StudyVariable:
    """Return what a study holds under a name."""
    label, numeric = name.replace("_", " "), name in VARIED_INPUTS and VARIED_INPUTS[name].numeric
    if name in data.variables and not numeric:
        label = str(data[name].attrs.get("long_name", label))
    return VARIABLES.get(name) or _AT_REST.get(name) or StudyVariable(label)


def label_of(data: xr.Dataset, name: str) -> str:
    """Return what a page calls a variable or an axis."""
    return variable_of(data, name).label


def per_prediction(data: xr.Dataset, axes: Sequence[str]) -> Iterator[tuple[str, StudyVariable]]:
    """Yield names and meanings of what has a number or a text at each point of the axes."""
    for name, variable in data.data_vars.items():
        if variable.dims and set(variable.dims) <= {*axes}:
            yield str(name), variable_of(data, str(name))


def telling(variable: xr.DataArray) -> bool:
    """Return whether some value is neither zero, missing nor an empty text."""
    if variable.dtype.kind in "fiub":
        return bool(np.nan_to_num(variable.values.astype(float)).any())
    return any(str(value) for value in variable.values.ravel())
