"""Road: measured profiles or a map, their cleaning, their correlation and its sine waves."""

from __future__ import annotations

from collections.abc import Mapping

import panel as pn

from gripscale.app.complaint import complaint_of
from gripscale.app.dropped import dropper
from gripscale.app.form import table_form
from gripscale.app.inputs import surface_elements
from gripscale.app.looked_at import LookedAt
from gripscale.app.state import CaseState

FIRST = ("scales", "smallest_wavelength", "cut_off", "upper_share", "crop", "x_unit", "z_unit")
SCALES = 8
"""Waves of a surface just dropped, as `gripscale fit-surface` has them."""


def road_tab(state: CaseState) -> pn.Column:
    """Return the part of the page about the surface."""
    kind = pn.widgets.RadioButtonGroup(
        options={"Profiles along a line": "files", "A map": "map"}, margin=(4, 8)
    )
    shown = LookedAt(state, "Read, clean and fit", surface_elements)

    def taken(dropped: Mapping[str, bytes]) -> None:
        names = [state.place.store(name, content) for name, content in dropped.items()]
        source = names if kind.value == "files" else names[-1]
        state.set(("surface",), {kind.value: source, "scales": SCALES})
        pn.state.execute(shown.look)

    return pn.Column(
        complaint_of(state, "surface"),
        kind,
        dropper(
            "Drop profiles or a map; they replace the surface of the case.", taken, several=True
        ),
        table_form(state, "surface", FIRST),
        shown.button,
        shown.body,
        sizing_mode="stretch_width",
    )
