"""The server of the page, on this machine for this machine only, and the page of one visit."""

from __future__ import annotations

import os
import socket
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import panel as pn
from bokeh.models import CustomJS
from bokeh.util.warnings import BokehUserWarning
from tornado.web import HTTPError, StaticFileHandler

from gripscale.app.case import MAX_UPLOAD, CaseState, VisitFolder
from gripscale.app.case_panel import case_panel
from gripscale.app.elements import REPORTS, column, raw
from gripscale.app.input_tabs import load_tab, road_tab, rubber_tab
from gripscale.app.run_tabs import results_tab, run_tab
from gripscale.app.runs import REPORT, Runs
from gripscale.case_file import read_case_file
from gripscale.case_file.examples import EXAMPLES
from gripscale.core.errors import InputError
from gripscale.io.folders import make_folder, require_writable
from gripscale.report.build import template_text

_TITLE = "gripscale"
INTRO = (
    "<h1>gripscale</h1><p>Real contact area and friction of rubber on rough roads. "
    "All settings are in the case file shown on this page; <code>gripscale run</code> computes the "
    "same results from it.</p>"
)
TABS_STYLE = ":host .bk-header { min-width: 0; } :host .bk-headers-wrapper { flex-wrap: wrap; }"
# The page is drawn dark on white; a dark browser inverts it with its figures, hues kept.
PAGE_STYLE = """\
:root { color-scheme: light; background: #fff; }
@media (prefers-color-scheme: dark) { :root { filter: invert(0.9) hue-rotate(180deg); } }
"""
HOST = "127.0.0.1"
PAGES = rf"(?:runs/[^/]+/{REPORT}|preview-\w+\.html)"  # of a visit, given to frames
GONE_AFTER = 15_000  # milliseconds after which a page that was closed counts as left


def visit_page(root: Path, case: Path | None) -> pn.Column:
    """Return the page of a new visit, with a folder of its own in `root`."""
    visit = VisitFolder.new(root)
    state = CaseState(visit)
    state.set_text(state.example(next(iter(EXAMPLES))) if case is None else state.text_of(case))
    runs = Runs(state)

    def leave(_: Any) -> None:
        runs.stop()
        visit.remove_if_unused()

    pn.state.on_session_destroyed(leave)
    if pn.state.curdoc is not None:
        # all files of a drop are named, announced and sent at once
        code = template_text("gripscale.app", "uploads.js")
        pn.state.curdoc.js_on_event("document_ready", CustomJS(code=code))
    of_case = (
        ("1 Road", road_tab(state)),
        ("2 Rubber", rubber_tab(state)),
        ("3 Load and conditions", load_tab(state)),
        ("4 Run", run_tab(state, runs)),
    )
    tabs = pn.Tabs(
        *of_case,
        ("5 Results", results_tab(state, runs)),
        dynamic=True,
        sizing_mode="stretch_width",
        stylesheets=[TABS_STYLE],
        styles={"flex": "3 1 560px", "min-width": "0", "max-width": "100%"},
    )
    side = column(
        case_panel(state), styles={"flex": "1 1 300px", "min-width": "0", "max-width": "100%"}
    )

    # a result has a case of its own
    tabs.param.watch(lambda event: side.param.update(visible=event.new < len(of_case)), "active")
    body = pn.FlexBox(tabs, side, sizing_mode="stretch_width", align_items="start")
    return column(raw(INTRO), body, max_width=1500)


def serve(root: Path, case: Path | None, port: int, browser: bool) -> None:
    """Serve the page until it is interrupted."""
    if case is not None:
        read_case_file(case)
    require_writable(root)
    make_folder(root)
    port = _free_port(port)
    pn.extension("filedropper", raw_css=[PAGE_STYLE])

    def page() -> pn.Column:
        return visit_page(root.resolve(), case)

    # BokehJS returns models that the server has just added to the page; the server keeps its own
    # and warns each time.
    warnings.filterwarnings("ignore", "reference already known", BokehUserWarning)
    origins = [f"{HOST}:{port}", f"localhost:{port}"]
    reports = {"path": str(root.resolve()), "hosts": origins}
    server = pn.serve(
        {"/": page},
        extra_patterns=[(rf"/{REPORTS}/([^/]+/{PAGES})", ReportHandler, reports)],
        title={"/": _TITLE},
        address=HOST,
        port=port,
        websocket_origin=origins,
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


class ReportHandler(StaticFileHandler):
    """Serves reports of visits to this very page, each as a document of an origin of its own."""

    def initialize(self, path: str, hosts: Sequence[str]) -> None:  # type: ignore[override]
        """Take the folder of all visits and the hosts under which the page is served."""
        super().initialize(path)
        self._hosts = hosts

    def prepare(self) -> None:
        """Turn away whoever asks under another name."""
        if self.request.host not in self._hosts:
            raise HTTPError(403)

    def set_extra_headers(self, path: str) -> None:
        """Keep the report from the page around it, and its older versions from the browser."""
        self.set_header("Content-Security-Policy", SANDBOX)
        self.set_header("Cache-Control", "no-cache")


SANDBOX = "sandbox allow-scripts allow-downloads allow-popups; frame-ancestors 'self'"


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
