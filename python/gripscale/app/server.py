"""The server of the page, on this machine for this machine only, and the page of one visit."""

from __future__ import annotations

import os
import socket
import warnings
from pathlib import Path
from typing import Any

import panel as pn
from bokeh.util.warnings import BokehUserWarning

from gripscale.app.case import MAX_UPLOAD, CaseState, VisitFolder
from gripscale.app.case_panel import case_panel
from gripscale.app.elements import column, raw
from gripscale.app.input_tabs import load_tab, road_tab, rubber_tab
from gripscale.app.run_tabs import compare_tab, results_tab, run_tab
from gripscale.app.runs import Runs
from gripscale.case import folder, read_case
from gripscale.case.examples import EXAMPLES
from gripscale.core.errors import InputError

TITLE = "gripscale"
INTRO = (
    "<h1>gripscale</h1><p>Real contact area and friction of rubber on rough roads. "
    "All settings are in the case file shown on this page; <code>gripscale run</code> computes the "
    "same results from it.</p>"
)
TABS_STYLE = ":host .bk-header { min-width: 0; } :host .bk-headers-wrapper { flex-wrap: wrap; }"
HOST = "127.0.0.1"
GONE_AFTER = 15_000
"""Milliseconds after which a page that was closed counts as left."""


def visit_page(root: Path, case: Path | None) -> pn.Column:
    """Return the page of a new visit, with a folder of its own in `root`."""
    visit = VisitFolder.new(root)
    state = CaseState(visit)
    if case is None:
        state.load_example(next(iter(EXAMPLES)))
    else:
        state.copy_case(case)
    runs = Runs(state)

    def leave(_: Any) -> None:
        runs.stop()
        visit.remove_if_unused()

    pn.state.on_session_destroyed(leave)
    tabs = pn.Tabs(
        ("1 Road", road_tab(state)),
        ("2 Rubber", rubber_tab(state)),
        ("3 Load and conditions", load_tab(state)),
        ("4 Run", run_tab(state, runs)),
        ("5 Results", results_tab(state, runs)),
        ("6 Compare", compare_tab(state, runs)),
        dynamic=True,
        sizing_mode="stretch_width",
        stylesheets=[TABS_STYLE],
        styles={"flex": "3 1 560px", "min-width": "0", "max-width": "100%"},
    )
    side = column(
        case_panel(state), styles={"flex": "1 1 300px", "min-width": "0", "max-width": "100%"}
    )
    body = pn.FlexBox(tabs, side, sizing_mode="stretch_width", align_items="start")
    return column(raw(INTRO), body, max_width=1500)


def serve(root: Path, case: Path | None, port: int, browser: bool) -> None:
    """Serve the page until it is interrupted."""
    if case is not None:
        read_case(case)
    folder.require_writable(root)
    folder.make(root)
    port = _free_port(port)
    pn.extension("filedropper")

    def page() -> pn.Column:
        return visit_page(root.resolve(), case)

    # BokehJS returns models that the server has just added to the page; the server keeps its own
    # and warns each time.
    warnings.filterwarnings("ignore", "reference already known", BokehUserWarning)
    server = pn.serve(
        {"/": page},
        title={"/": TITLE},
        address=HOST,
        port=port,
        websocket_origin=[f"{HOST}:{port}", f"localhost:{port}"],
        websocket_max_message_size=2 * MAX_UPLOAD,
        show=browser,
        start=False,
        verbose=False,
        check_unused_sessions_milliseconds=GONE_AFTER // 3,
        unused_session_lifetime_milliseconds=GONE_AFTER,
    )
    print(
        f"The page is at http://{HOST}:{port}/ for this machine only; Ctrl+C ends it.", flush=True
    )
    print(f"Files and results are kept in {root.resolve()}", flush=True)
    server.run_until_shutdown()


def _free_port(port: int) -> int:
    """Return `port` if it is free, and any free one for 0; raise `InputError` if it is taken."""
    if not 0 <= port <= 65535:
        raise InputError(f"port must be a whole number from 0 to 65535; got {port}")
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        if os.name == "posix":  # the server can reuse a port that was just closed, too
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            raise InputError(
                f"port {port} of {HOST} cannot be used: {error.strerror}; expected a free one, or "
                "0 for any"
            ) from error
        return int(probe.getsockname()[1])
