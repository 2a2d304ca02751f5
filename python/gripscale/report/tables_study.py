"""A study as a table a person can read: one row per prediction."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.core.units import significant
from gripscale.experiment.axis import dimensions, name_of
from gripscale.experiment.speed_and_temperature import BEYOND_SHIFT, COLLAPSED, PER_DECADE
from gripscale.model import ADHESIVE_FRICTION, FRICTION_OUTSIDE_BAND
from gripscale.report.notices import share_text, study_sentence
from gripscale.report.tables_run import printed_table

MOST_ROWS = 200


def study_table(result: xr.Dataset) -> Table:
    """Return area, friction and status of each prediction of a study, over what was varied."""
    names = dimensions(result)
    at_rest = "static_total_contact_fraction" in result
    beyond = study_sentence(result)
    area_term = ADHESIVE_FRICTION in result
    table = printed_table()
    for name in names:
        table.add_column(name.replace("_", " "), no_wrap=True)
    heads = [
        "A_r/A_0",
        "μ",
        "μ\ndiss.",
        *(["μ area\nterm", "μ with\nit"] if area_term else []),
        "largest\nμ of",
        *(["μ beyond\nband"] if beyond else []),
        *(["A_r/A_0\nat rest"] if at_rest else []),
    ]
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("status", overflow="fold")
    for index in list(product(*(range(result.sizes[name]) for name in names)))[:MOST_ROWS]:
        place = dict(zip(names, index, strict=True))
        chain = result.isel(place)
        cells = [
            significant(float(chain.total_contact_fraction)),
            significant(float(chain.total_friction)),
            significant(float(chain.total_friction_from_dissipation)),
        ]
        if area_term:
            added = float(chain[ADHESIVE_FRICTION])
            cells += [significant(added), significant(float(chain.total_friction) + added)]
        cells.append(_largest(chain))
        if beyond:
            cells.append(share_text(float(chain[FRICTION_OUTSIDE_BAND])))
        if at_rest:
            cells.append(significant(float(chain.static_total_contact_fraction)))
        status = str(chain.prediction_status.item())
        style = None if status == "converged" else "bold red"
        words = [name_of(result, name, i) for name, i in place.items()]
        if BEYOND_SHIFT in chain and bool(chain[BEYOND_SHIFT]):
            words[-1] += " *"
        table.add_row(*words, *cells, status, style=style)
    return table


def _largest(chain: xr.Dataset) -> str:
    """Return the wavelength of the wave with the most friction, if there are waves."""
    if "wavelength" not in chain or not float(chain.total_friction) > 1e-9:
        return "-"
    wavelength = float(chain.wavelength[int(np.nanargmax(chain.friction.values))])
    return f"{wavelength * 1e3:.3g} mm"


# What a study over temperatures tells beside its table.

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
