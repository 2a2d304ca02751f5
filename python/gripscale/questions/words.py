"""What tables, figures and texts call the two numbers that every model answers with."""

from __future__ import annotations

import xarray as xr

HEADINGS = {"contact_fraction": "real contact area", "friction": "friction coefficient"}
SYMBOLS = {"contact_fraction": "A_r/A_0", "friction": "μ"}
AXIS_TITLES = {
    "contact_fraction": f"{HEADINGS['contact_fraction']} $A_r/A_0$",
    "friction": f"{HEADINGS['friction']} $\\mu$",
}
"""Headings and symbols at an axis, without the unit."""
JUDGE = "direct contact of the profiles"
"""What a figure of a chain calls the model that judges it."""
OF_THE_PAPER = "the paper's chain of waves"
"""What texts call the chain where the answer is that of a measured surface."""
ANSWER = "answer (90 %)"
"""What figures call the answer with its interval."""


def believed(data: xr.Dataset, name: str) -> str:
    """Return the name of the best there is in a study of a number such as `friction`."""
    return f"best_{name}" if is_estimated(data, name) else f"total_{name}"


def is_estimated(data: xr.Dataset, name: str) -> bool:
    """Return whether a study has a best estimate of a number such as `friction`."""
    best = f"best_{name}"
    return best in data and bool(data[best].notnull().any())
