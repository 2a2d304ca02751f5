"""The server of the page: on this machine, for this machine only."""

from __future__ import annotations

import os
import socket
import warnings
from pathlib import Path

import panel as pn
from bokeh.util.warnings import BokehUserWarning

from gripscale.app.page import TITLE, visit
from gripscale.app.visit_folder import MOST
from gripscale.case import folder, read_case
from gripscale.errors import InputError

HOST = "127.0.0.1"
GONE_AFTER = 15_000
"""Milliseconds after which a page that was closed counts as left."""


def serve(root: Path, case: Path | None, port: int, browser: bool) -> None:
    """Serve the page until it is interrupted."""
    if case is not None:
        read_case(case)
    folder.require_writable(root)
    folder.make(root)
    port = _free_port(port)
    pn.extension("filedropper")

    def page() -> pn.Column:
        return visit(root.resolve(), case)

    # BokehJS names what the server has just added to the page by sending it back whole; the server
    # keeps its own and says so each time.
    warnings.filterwarnings("ignore", "reference already known", BokehUserWarning)
    server = pn.serve(
        {"/": page},
        title={"/": TITLE},
        address=HOST,
        port=port,
        websocket_origin=[f"{HOST}:{port}", f"localhost:{port}"],
        websocket_max_message_size=2 * MOST,
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
        if os.name == "posix":  # a port that was just left is free, as the server sees it, too
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            raise InputError(
                f"port {port} of {HOST} cannot be used: {error.strerror}; expected a free one, or "
                "0 for any"
            ) from error
        return int(probe.getsockname()[1])
