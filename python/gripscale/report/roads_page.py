"""The report of roads side by side."""

from __future__ import annotations

from pathlib import PurePath

import xarray as xr

from gripscale.figures.roads import roads_friction_figure, roads_statistics_figure
from gripscale.report.blocks import picture
from gripscale.report.elements import Heading, Notice, Page, Section, Table, Text
from gripscale.report.roads_table import roads_failures, roads_rows, roads_sentences
from gripscale.report.run_page import rerun_elements
from gripscale.report.side_by_side_table import status, totals_cells

WHAT = (
    "The same rubber under the same load on each road: in the chain of its sine waves, and in the "
    "direct contact of its whole profile. A range is 90 % of what other stretches of the same road "
    "might give; a difference lies beyond it where its own range does not hold zero."
)


def roads_page(data: xr.Dataset) -> Page:
    """Return the report of roads side by side."""
    case = PurePath(str(data.attrs.get("case_file", ""))).name or "case.toml"
    names = data.surface.values.tolist()
    totals = [_totals(data, model) for model in data.model.values.tolist()]
    notes = str(data.attrs.get("notes", "")).splitlines()
    again = f"gripscale compare-surfaces {data.attrs['surfaces']} --case {case}"
    statistics = picture(
        roads_statistics_figure(data),
        "roads-statistics",
        "Height difference correlation and spectrum of each road.",
        "Two panels of curves, one for each road.",
    )
    friction = picture(
        roads_friction_figure(data),
        "roads-friction",
        "Friction of all waves down to each wavelength, of the direct contact by the energy lost; "
        "bars are the ranges of the totals.",
        "A panel for each model with a curve for each road, rising towards short waves.",
    )
    return Page(
        f"Roads side by side: {', '.join(names)}",
        str(data.attrs.get("title", "")),
        [Notice("error", text) for text in roads_failures(data)],
        [],
        [
            Section("roads", "Contact and friction",
                    [Text(WHAT), *totals, *map(Text, [*roads_sentences(data), *notes]), friction]),
            Section("statistics", "The roads", [statistics]),
            Section("again", "Software, and how to run it again",
                    rerun_elements(data.attrs, case, again)),
        ],
    )  # fmt: skip


def _totals(data: xr.Dataset, model: str) -> Table:
    """Return the totals of one model on each road."""
    rows = roads_rows(data, model)
    return Table(
        f"roads-{model}",
        f"Totals, {model}",
        [
            Heading("road", words=True),
            *map(Heading, ("A_r/A_0", "range", "μ", "range", "μ less that of the first", "range")),
        ],
        [[row.name, *totals_cells(row)] for row in rows],
        bad=frozenset((i, 0) for i, row in enumerate(rows) if status(row.one) != "converged"),
    )
