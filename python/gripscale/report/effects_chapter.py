"""What each effect of the conditions is worth: the table of a report."""

from __future__ import annotations

import math
from collections.abc import Sequence

import xarray as xr

from gripscale.effects.effects import CHANGES, WITH_AREA_TERM
from gripscale.report.elements import Element, Heading, Table, Text
from gripscale.report.numbers import NONE, number, percent
from gripscale.study.display import EFFECTS, MODELS

WHAT = (
    "The same case with all effects of its conditions, without each in turn, and with none: "
    "a change is what the effects left out do to the number beside it."
)


def effects_elements(results: Sequence[xr.Dataset]) -> list[Element]:
    """Return the answers of each model with and without each effect; nothing without any."""
    if not results:
        return []
    area_term = any(WITH_AREA_TERM in one for one in results)
    shown = [name for name in CHANGES if area_term or name != WITH_AREA_TERM]
    words = {"total_contact_fraction": "A_r/A_0", "total_friction": "μ, hysteresis"}
    headings = [Heading("model", words=True), Heading("effects", words=True)]
    for name in shown:
        headings += [Heading(words.get(name, "μ with area term")), Heading("change")]
    rows = [
        [
            MODELS.get(str(one.attrs["model"]), str(one.attrs["model"])),
            EFFECTS.get(str(effect), str(effect)),
            *(cell for name in shown for cell in _changed(one.sel(effect=effect), name)),
            str(one.prediction_status.sel(effect=effect).item()),
        ]
        for one in results
        for effect in one.effect.values
    ]
    headings.append(Heading("status", words=True))
    status = len(headings) - 1
    bad = frozenset((at, status) for at, row in enumerate(rows) if row[status] != "converged")
    table = Table("effects", "What each effect is worth", headings, rows, [], bad)
    return [Text(WHAT), table]


def _changed(one: xr.Dataset, name: str) -> tuple[str, str]:
    if name not in one:
        return NONE, NONE
    change = float(one[CHANGES[name]])
    return number(float(one[name])), NONE if math.isnan(change) else percent(change)
