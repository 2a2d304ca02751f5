"""Rubber: a master curve or sweeps, the fit of its Prony series and the ends of the data."""

from __future__ import annotations

from collections.abc import Mapping

import panel as pn

from gripscale.app.complaint import complaint_of
from gripscale.app.dropped import dropper
from gripscale.app.form import table_form
from gripscale.app.inputs import rubber_elements
from gripscale.app.looked_at import LookedAt
from gripscale.app.state import CaseState

FIRST = ("name", "reference_temperature", "bulk_modulus", "terms", "extrapolate", "source")


def rubber_tab(state: CaseState) -> pn.Column:
    """Return the part of the page about the rubber."""
    shown = LookedAt(state, "Read and fit", rubber_elements)

    def taken(dropped: Mapping[str, bytes]) -> None:
        state.set(("rubber",), {"file": _stored(state, dropped)})
        pn.state.execute(shown.look)

    def shift_taken(dropped: Mapping[str, bytes]) -> None:
        state.set(("rubber", "shift"), _stored(state, dropped))

    return pn.Column(
        complaint_of(state, "rubber"),
        dropper(
            "Drop a master curve, or sweeps at several temperatures; it replaces the rubber "
            "of the case.",
            taken,
        ),
        table_form(state, "rubber", FIRST),
        dropper("A table of shift factors, in place of a law of the shift.", shift_taken),
        shown.button,
        shown.body,
        sizing_mode="stretch_width",
    )


def _stored(state: CaseState, dropped: Mapping[str, bytes]) -> str:
    """Keep the file dropped last; return its name in the case."""
    return state.place.store(*list(dropped.items())[-1])
