"""Sweeps as measured and shifted, and their shift factors to be changed by hand.

What is changed becomes a table of shift factors, a file of the case.
"""

from __future__ import annotations

import tempfile
from collections.abc import Awaitable, Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import panel as pn

from gripscale.app.case import CaseState
from gripscale.app.elements import AppElement, column, html, work_button
from gripscale.charts.draw import image
from gripscale.charts.page_elements import Picture
from gripscale.core.units import ZERO_CELSIUS
from gripscale.questions.inputs.charts_of_rubber import superposition_figure
from gripscale.report.elements import Text
from gripscale.rubber import ShiftTable, write_shift_table
from gripscale.rubber.measured_rubber import MeasuredRubber
from gripscale.rubber.superposition import temperatures_in

_FILE = "shift_by_hand.csv"
_STEP = 0.05
"""Step of log10 a_T at an arrow of its field."""
Redraw = Callable[[], Awaitable[None]]


def superposition_elements(
    state: CaseState, rubber: MeasuredRubber, redraw: Redraw
) -> Iterator[AppElement]:
    """Yield sweeps as measured and shifted, and the fields of their shift; nothing without sweeps.

    `redraw` shows the rubber of the case anew, once its shift has changed.
    """
    sweeps, master = rubber.sweeps, rubber.master
    if sweeps is None or master is None or master.shift is None or len(sweeps) < 2:
        return
    reference = master.reference_temperature or float(sweeps.temperatures[0])
    kelvin = temperatures_in(master.shift, sweeps.temperatures, sweeps.tolerance)
    along, up = (of(kelvin, reference) for of in (master.shift.log_a, master.shift.log_b))
    words = "Sweeps as measured and shifted to one temperature."
    yield image(
        Picture("superposition", superposition_figure(sweeps, master), words,
                "Moduli and loss factor of all sweeps by frequency, as measured and shifted.")
    )  # fmt: skip
    table = ShiftTable(kelvin, along, vertical=up)
    yield partial(shift_form, state, table, redraw)


def shift_form(state: CaseState, table: ShiftTable, redraw: Redraw) -> pn.Column:
    """Return a field of log10 a_T for each sweep; a click makes them the shift of the case."""
    fields = [
        pn.widgets.FloatInput(
            label=f"{kelvin - ZERO_CELSIUS:.1f} °C", value=round(float(value), 3), step=_STEP,
            width=100,
        )
        for kelvin, value in zip(table.temperature, table.horizontal, strict=True)
    ]  # fmt: skip

    async def apply() -> None:
        values = np.array([field.value for field in fields], dtype=float)
        with state.refusals("rubber"), tempfile.TemporaryDirectory() as folder:
            changed = ShiftTable(table.temperature, values, vertical=table.vertical)
            written = write_shift_table(Path(folder) / _FILE, changed)
            name = state.visit.store(_FILE, written.read_bytes())
            state.set(("rubber", "vertical"), None)  # it would be found anew
            state.set(("rubber", "shift"), name)
        await redraw()

    async def find() -> None:
        state.set(("rubber", "shift"), None)
        await redraw()

    buttons = [work_button("Shift by these", apply, color="primary")]
    if state.get(("rubber", "shift")) is not None:
        buttons.append(work_button("Find the shift from the sweeps", find))
    words = Text("log10 a_T of each sweep; what counts is the difference of two.")
    return column(html(words), pn.FlexBox(*fields, align_items="end"), pn.Row(*buttons))
