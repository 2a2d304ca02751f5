"""What a study over temperatures tells beside its table."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale.report.tables import significant
from gripscale.study.collapse import PER_DECADE
from gripscale.study.display import name_of
from gripscale.study.temperature import BEYOND_SHIFT, COLLAPSED

ONE_CURVE = 1e-3
"""Relative distance up to which temperatures over a_T v are one curve."""
WORDS = {"total_friction": "friction", "total_contact_fraction": "A_r/A_0"}


def shift_sentence(result: xr.Dataset) -> str:
    """Return which temperatures lie beyond the shift; empty if none does."""
    if BEYOND_SHIFT not in result or not bool(result[BEYOND_SHIFT].any()):
        return ""
    return f"{_beyond(result)} beyond the temperatures that the shift of the rubber rests on."


def collapse_sentences(result: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield quantities of a study over speed and temperature, and how far over a_T v they differ.

    Nothing of other studies.
    """
    for name, words in WORDS.items():
        if COLLAPSED[name] in result:
            yield words, _collapse(result[COLLAPSED[name]])


def _beyond(result: xr.Dataset) -> str:
    flags = result[BEYOND_SHIFT]
    if "temperature" not in flags.dims:
        return f"{int(flags.sum())} of {flags.size} predictions lie"
    others = [dim for dim in flags.dims if dim != "temperature"]
    which = np.flatnonzero(flags.any(dim=others).values)
    names = ", ".join(name_of(result, "temperature", int(i)) for i in which)
    return f"{names} {'lie' if which.size > 1 else 'lies'}"


def _collapse(found: xr.DataArray) -> str:
    distance = float(found)
    if np.isnan(distance):
        return (
            "cannot be compared: the temperatures do not overlap, or the speeds are less than "
            f"{PER_DECADE} in a power of ten"
        )
    reached = (
        f"temperatures up to {significant(100.0 * distance, 2)} % apart at the "
        f"{found.attrs['points']} of {found.attrs['overlapping_points']} points that interpolation "
        f"reaches to {significant(100.0 * float(found.attrs['interpolation_error']), 2)} %"
    )
    if distance <= ONE_CURVE:
        return f"one curve, {reached}"
    return f"{reached}; one curve would be below {100.0 * ONE_CURVE:g} % but for errors of the mesh"
