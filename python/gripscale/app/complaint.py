"""What is wrong with the case, said in the part of the page where it can be mended."""

from __future__ import annotations

import panel as pn

from gripscale.app.elements import error
from gripscale.app.state import CaseState


def complaint_of(state: CaseState, *tables: str) -> pn.Column:
    """Return a place that shows the complaint about the case if it is about one of `tables`."""
    place = pn.Column(sizing_mode="stretch_width")

    def follow(*_: object) -> None:
        own = any(f"[{name}{end}" in state.complaint for name in tables for end in "].[")
        own = own or any(state.complaint.startswith(f"{name} file ") for name in tables)
        place.objects = [error(state.complaint)] if own else []

    follow()
    state.param.watch(follow, "complaint")
    return place
