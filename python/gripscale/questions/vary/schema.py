"""What tables and charts of a study call its variables, and what each measures."""

from __future__ import annotations

from typing import NamedTuple

import xarray as xr

from gripscale.model import ADHESIVE_FRICTION
from gripscale.questions.answer.estimate import AREA_TERM
from gripscale.questions.vary.axis import VARIED_INPUTS
from gripscale.questions.words import HEADINGS, SYMBOLS


class StudyVariable(NamedTuple):
    """One variable of a study."""

    label: str  # what a page calls it
    # `friction` or `contact_fraction`, of what is one of the two numbers of an answer.
    measures: str = ""
    running: bool = False  # whether it counts a wave and all longer ones


# Numbers of each wave that are drawn.
PER_WAVE = {
    "running_contact_fraction": StudyVariable("A_r/A_0 down to the wave", "contact_fraction", True),
    "running_friction": StudyVariable("μ down to the wave", "friction", True),
    "contact_fraction": StudyVariable("contact fraction of each wave", "contact_fraction"),
    "friction": StudyVariable("friction μ of each wave", "friction"),
}
_AREA = f"{HEADINGS['contact_fraction']} {SYMBOLS['contact_fraction']}"
# Variables that are called otherwise than by their `long_name`.
VARIABLES = {
    **PER_WAVE,
    "answer_contact_fraction": StudyVariable(f"{_AREA}, answer", "contact_fraction"),
    "total_contact_fraction": StudyVariable(_AREA, "contact_fraction"),
    "answer_friction": StudyVariable("friction μ, answer", "friction"),
    "total_friction": StudyVariable("friction μ", "friction"),
    "answer_total_friction": StudyVariable("friction μ with the area term, answer", "friction"),
    AREA_TERM: StudyVariable("μ of the area term, answer"),
    ADHESIVE_FRICTION: StudyVariable("μ of the area term", ADHESIVE_FRICTION),
    "friction_by_decade": StudyVariable("friction μ of relaxation times"),
    "octave_friction": StudyVariable("friction μ of octaves of wavelength"),
}


def variable_of(data: xr.Dataset, name: str) -> StudyVariable:
    """Return what a study holds under a name."""
    label, numeric = name.replace("_", " "), name in VARIED_INPUTS and VARIED_INPUTS[name].numeric
    if name in data.variables and not numeric:
        label = str(data[name].attrs.get("long_name", label))
    return VARIABLES.get(name) or StudyVariable(label)


def label_of(data: xr.Dataset, name: str) -> str:
    """Return what a page calls a variable or an axis."""
    return variable_of(data, name).label
