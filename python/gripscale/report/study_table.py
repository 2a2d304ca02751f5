"""A study as a table a person can read: one row per prediction."""

from __future__ import annotations

from itertools import product

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.model import ADHESIVE_FRICTION, FRICTION_OUTSIDE_BAND
from gripscale.report.outside_band import share_text, study_sentence
from gripscale.report.printed_table import printed_table
from gripscale.report.tables import significant
from gripscale.study.display import dimensions, name_of
from gripscale.study.temperature import BEYOND_SHIFT

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
