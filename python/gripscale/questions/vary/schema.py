"""The variables of a study: what a page calls each of them, what it measures and its role.

Tables, charts and sentences of this room read this declaration; none of them looks into a name. A
variable of another model is a plain number that is called by its `long_name`.
"""

from __future__ import annotations

from collections.abc import Iterator
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
from gripscale.questions.answer.estimate import AREA_TERM, BASIS_SHARES, ESTIMATED, TOTAL
from gripscale.questions.vary.axis import AXIS_LABELS
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


_WORDS = {name: f"{HEADINGS[name]} {SYMBOLS[name]}" for name in ESTIMATED} | {
    "friction": "friction μ"
}


_ENDS = ("low", "its 90 %, from"), ("high", "to")


def _of_answer() -> Iterator[tuple[str, StudyVariable]]:
    """Yield the numbers of the answer with their intervals and errors."""
    total = StudyVariable("friction μ with the area term, answer", Role.ANSWER, "friction")
    yield TOTAL, total._replace(at_rest=False)
    for end, label in _ENDS:
        yield f"{TOTAL}_{end}", StudyVariable(label, Role.END, at_rest=False)
    for end in ("half_width", "uncertainty"):
        label = f"relative {end.replace('_', ' ')} of the friction μ with the area term"
        yield f"{TOTAL}_{end}", StudyVariable(label, Role.EVIDENCE, at_rest=False)
    for name, words in _WORDS.items():
        rest = name != "friction"
        yield f"answer_{name}", StudyVariable(f"{words}, answer", Role.ANSWER, name, at_rest=rest)
        for end, label in _ENDS:
            yield f"answer_{name}_{end}", StudyVariable(label, Role.END, at_rest=rest)
        for end in ("half_width", "uncertainty", "sampling_error", "grid_error"):
            label = f"relative {end.replace('_', ' ')} of the {words}"
            yield f"answer_{name}_{end}", StudyVariable(label, Role.EVIDENCE, at_rest=rest)
        for end in ("factor", "factor_uncertainty"):
            label = f"{end.replace('_', ', ')}, on the {words} of the direct contact"
            yield f"answer_{name}_{end}", StudyVariable(label, Role.EVIDENCE, at_rest=rest)
        yield f"total_{name}", StudyVariable(words, Role.NUMBER, name, at_rest=rest)
        for end in ("error", "sampling_error"):
            label = f"{end.replace('_', ' ')} of the {words}"
            yield f"total_{name}_{end}", StudyVariable(label, Role.EVIDENCE, at_rest=rest)


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

_MOVING = {name: StudyVariable(label, at_rest=False) for name, label in _NUMBERS.items()}
_MOVING |= {
    AREA_TERM: StudyVariable("μ of the area term, answer", Role.ANSWER, at_rest=False),
    ADHESIVE_FRICTION: StudyVariable("μ of the area term", Role.NUMBER, ADHESIVE_FRICTION),
}
_MOVING |= {
    name: StudyVariable(name.replace("_", " "), at_rest=False) for name in _OF_A_SLIDING_WAVE
}
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
_COMMON = {
    "total_contact_fraction_cut_off_exponent": StudyVariable("d ln(A_r/A_0) / d ln λ_min"),
    STATUS: StudyVariable("status", Role.STATUS),
    STATUS_WORD: StudyVariable("word of the status", Role.RECORD),
    "prediction_key": StudyVariable("key of the prediction", Role.RECORD),
    "factor_label": StudyVariable("factors of the answer", Role.RECORD, at_rest=False),
}
_BASIS = {name: StudyVariable(text, Role.EVIDENCE) for name, text in BASIS.items()}
_BASIS |= {
    f"answer_{name}": StudyVariable(name.replace("_", " "), Role.EVIDENCE, at_rest=False)
    for name in BASIS_SHARES
}
# All variables that a study knows, of rubber that slides.
VARIABLES = dict(_of_answer()) | _MOVING | PER_WAVE | _COMMON | _BASIS


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
    declared = VARIABLES.get(name) or _AT_REST.get(name)
    if declared is not None:
        return declared
    plain = name.replace("_", " ")
    if name in AXIS_LABELS or name not in data.variables:
        return StudyVariable(plain)
    return StudyVariable(str(data[name].attrs.get("long_name", plain)))


def label_of(data: xr.Dataset, name: str) -> str:
    """Return what a page calls a variable or an axis."""
    return variable_of(data, name).label


def telling(variable: xr.DataArray) -> bool:
    """Return whether some value is neither zero, missing nor an empty text."""
    if variable.dtype.kind in "fiub":
        return bool(np.nan_to_num(variable.values.astype(float)).any())
    return any(str(value) for value in variable.values.ravel())
