"""What tables, figures and texts call the two numbers that every model answers with."""

from __future__ import annotations

import xarray as xr

HEADINGS = {"contact_fraction": "real contact area", "friction": "friction coefficient"}
SYMBOLS = {"contact_fraction": "A_r/A_0", "friction": "μ"}
# Headings and symbols at an axis, without the unit.
AXIS_TITLES = {
    "contact_fraction": f"{HEADINGS['contact_fraction']} $A_r/A_0$",
    "friction": f"{HEADINGS['friction']} $\\mu$",
}
JUDGE = "direct contact of the profiles"  # what a figure of a chain calls the model that judges it
# What texts call the chain where the answer is that of a measured surface.
OF_THE_PAPER = "the paper's chain of waves"
ANSWER = "answer (90 %)"  # what figures call the answer with its interval


def believed(data: xr.Dataset, name: str) -> str:
    """Return the name of the best there is in a study of a number such as `friction`."""
    if name == "friction" and is_estimated(data, "total_friction"):  # there is an area term
        return "answer_total_friction"
    return f"answer_{name}" if is_estimated(data, name) else f"total_{name}"


def is_estimated(data: xr.Dataset, name: str) -> bool:
    """Return whether a study has the answer of a number such as `friction`."""
    answer = f"answer_{name}"
    return answer in data and bool(data[answer].notnull().any())
