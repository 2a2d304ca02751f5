"""Parts of the page that take a while: computed in a thread, shown, or the sentence why not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import panel as pn

from gripscale.app.elements import Cards, error, panes
from gripscale.app.state import CaseState
from gripscale.app.worker import beside
from gripscale.case import CaseFile
from gripscale.errors import GripscaleError
from gripscale.report.elements import Element

Shown = Sequence[Element | Cards]


async def fill(body: pn.Column, make: Callable[[], Shown], state: CaseState) -> None:
    """Fill `body` with what `make` returns; meanwhile the page stays alive."""
    body.loading = True
    try:
        body.objects = panes(await beside(make))
    except GripscaleError as refused:
        body.objects = [error(state.place.short(refused))]
    finally:
        body.loading = False


class LookedAt:
    """A button and what `make` finds in the case as it is at the click."""

    def __init__(
        self, state: CaseState, label: str, make: Callable[[CaseFile], Sequence[Element]]
    ) -> None:
        self._state, self._make = state, make
        self.button = pn.widgets.Button(label=label, color="primary", margin=(8, 8))
        self.body = pn.Column(sizing_mode="stretch_width")
        self.button.on_click(self.look)

    async def look(self, _: Any = None) -> None:
        """Make it from the case as it is now."""
        self.button.disabled = True
        await fill(self.body, lambda: self._make(self._state.file()), self._state)
        self.button.disabled = False
