"""Conditions and load: how the rubber is pressed and slid, what else acts, what solves a wave."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import panel as pn

from gripscale.app.complaint import complaint_of
from gripscale.app.dropped import dropper
from gripscale.app.form import table_form
from gripscale.app.state import CaseState

TABLES = {
    "load": ("Load", ("pressure", "speed", "footprint", "static", "load_time")),
    "conditions": ("Conditions", ("temperature", "strain_norm")),
    "solver": ("Solver of one wave", ("model", "points", "columns", "tolerance")),
    "chain": ("Chain of waves", ("pressure_classes",)),
}
"""Tables of the case by name: their title and what stands first."""


def load_tab(state: CaseState) -> pn.Column:
    """Return the part of the page about load, conditions and solver."""

    def softening_taken(dropped: Mapping[str, bytes]) -> None:
        path = ("conditions", "softening")
        names = [state.place.store(name, content) for name, content in dropped.items()]
        before = state.get(path)
        kept = before if isinstance(before, dict) and before.get("kind") == "table" else {}
        state.set(path, {**kept, "kind": "table", "files": names})

    def friction_taken(dropped: Mapping[str, bytes]) -> None:
        state.set(("measured", "friction"), state.place.store(*list(dropped.items())[-1]))

    parts: list[Any] = []
    for name, (title, first) in TABLES.items():
        parts += [pn.pane.Markdown(f"### {title}", margin=(4, 8)), table_form(state, name, first)]
        if name == "conditions":
            words = "Strain sweeps of the softening; they replace that of the case."
            parts.append(dropper(words, softening_taken, several=True))
    return pn.Column(
        complaint_of(state, *TABLES, "measured"),
        *parts,
        pn.pane.Markdown("### Measured friction", margin=(4, 8)),
        dropper("A table of speed and friction, drawn over what is predicted.", friction_taken),
        sizing_mode="stretch_width",
    )
