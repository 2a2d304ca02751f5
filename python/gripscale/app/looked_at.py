"""A part of the page that computes at a click and shows what came, or the sentence why not."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

import panel as pn

from gripscale.app.elements import error, panes
from gripscale.app.state import CaseState
from gripscale.case import CaseFile
from gripscale.errors import GripscaleError
from gripscale.report.elements import Element

Make = Callable[[CaseFile], Sequence[Element]]


class LookedAt:
    """A button and what `make` finds in the case; it computes in a thread, the page stays alive."""

    def __init__(self, state: CaseState, label: str, make: Make) -> None:
        self._state, self._make = state, make
        self.button = pn.widgets.Button(name=label, button_type="primary", margin=(8, 8))
        self.body = pn.Column(sizing_mode="stretch_width")
        self.button.on_click(self.look)

    async def look(self, _: Any = None) -> None:
        """Make it from the case as it is now."""
        self.button.update(disabled=True, loading=True)
        try:
            found = await asyncio.to_thread(lambda: self._make(self._state.file()))
            self.body.objects = panes(found)
        except GripscaleError as refused:
            self.body.objects = [error(self._state.place.short(refused))]
        finally:
            self.button.update(disabled=False, loading=False)
