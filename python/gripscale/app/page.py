"""The page of one visit: the parts in the order of the work, and the case beside them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import panel as pn

from gripscale.app.case_side import case_side
from gripscale.app.compare_tab import compare_tab
from gripscale.app.elements import raw
from gripscale.app.load_tab import load_tab
from gripscale.app.results_tab import results_tab
from gripscale.app.road_tab import road_tab
from gripscale.app.rubber_tab import rubber_tab
from gripscale.app.run_tab import run_tab
from gripscale.app.runs import Runs
from gripscale.app.state import CaseState
from gripscale.app.visit_folder import VisitFolder
from gripscale.init import EXAMPLES

TITLE = "gripscale"
INTRO = (
    "<h1>gripscale</h1><p>Real contact area and friction of rubber on rough roads. "
    "Everything set here is in the case file at the side; <code>gripscale run</code> gives the "
    "same.</p>"
)
TABS = ":host .bk-header { min-width: 0; } :host .bk-headers-wrapper { flex-wrap: wrap; }"


def visit(root: Path, case: Path | None) -> pn.Column:
    """Return the page of a new visit, with a folder of its own in `root`."""
    place = VisitFolder.new(root)
    state = CaseState(place)
    if case is None:
        state.load_example(next(iter(EXAMPLES)))
    else:
        state.adopt(case)
    runs = Runs(state)

    def leave(_: Any) -> None:
        runs.stop()
        place.remove_if_unused()

    pn.state.on_session_destroyed(leave)
    parts = pn.Tabs(
        ("1 Road", road_tab(state)),
        ("2 Rubber", rubber_tab(state)),
        ("3 Load and conditions", load_tab(state)),
        ("4 Run", run_tab(state, runs)),
        ("5 Results", results_tab(state, runs)),
        ("6 Compare", compare_tab(state, runs)),
        dynamic=True,
        sizing_mode="stretch_width",
        stylesheets=[TABS],
        styles={"flex": "3 1 560px", "min-width": "0", "max-width": "100%"},
    )
    side = pn.Column(
        case_side(state),
        sizing_mode="stretch_width",
        styles={"flex": "1 1 300px", "min-width": "0", "max-width": "100%"},
    )
    body = pn.FlexBox(parts, side, sizing_mode="stretch_width", align_items="start")
    return pn.Column(raw(INTRO), body, sizing_mode="stretch_width", max_width=1500)
