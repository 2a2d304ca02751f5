"""Places to drop files: what is dropped is kept in the folder of the visit under a safe name."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import panel as pn

from gripscale.app.elements import error
from gripscale.app.visit_folder import MOST
from gripscale.errors import GripscaleError

Taken = Callable[[Mapping[str, bytes]], None]


def dropper(label: str, taken: Taken, *, several: bool = False) -> pn.Column:
    """Return a place to drop files, which `taken` gets by name; what it raises is shown there."""
    place = pn.widgets.FileDropper(
        multiple=several,
        max_file_size=f"{MOST // 1_000_000}MB",
        sizing_mode="stretch_width",
        margin=(0, 8),
        previews=[],
    )
    complaint = pn.Column(sizing_mode="stretch_width")

    def dropped(_: object) -> None:
        given = {name: _bytes(content) for name, content in place.value.items()}
        complaint.objects = []
        if not given:
            return
        try:
            taken(given)
        except GripscaleError as refused:
            complaint.objects = [error(str(refused))]

    place.param.watch(dropped, "value")
    title = pn.pane.Markdown(label, margin=(4, 8, 0, 8), sizing_mode="stretch_width")
    return pn.Column(title, place, complaint, sizing_mode="stretch_width")


def _bytes(content: bytes | str) -> bytes:
    return content.encode("utf-8") if isinstance(content, str) else content
