"""Models side by side: the chapter of a report on what each assumption costs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from gripscale.analysis.effects import CHANGES, WITH_AREA_TERM
from gripscale.charts.comparison import axis_charts, ladder_charts
from gripscale.charts.ladder import flawed, varied
from gripscale.charts.page_elements import (
    NONE,
    Element,
    Heading,
    Notice,
    Table,
    Text,
    number,
    percent,
)
from gripscale.experiment.axis import EFFECTS, MODELS
from gripscale.model import CUT_OFF_EXPONENTS, FRICTION_OUTSIDE_BAND
from gripscale.report.notices import comparison_sentences, pointer
from gripscale.report.source import Compared
from gripscale.report.tables_comparison import best_sentence, samples_of, temperature_only

WHAT = (
    "Every model over the same measurements, one assumption given up from rung to rung. A factor "
    "is from the rung before; of the theories from the profile as measured, at once, by which the "
    "others are to be judged. Spread is the standard deviation over the samples, error what the "
    "model itself estimates."
)
STALE = (
    "The comparison in this folder is of another text of the case and is left out; run `gripscale "
    "compare` again."
)


def comparison_elements(compared: Compared) -> list[Element]:
    """Return table, best estimate and figures of what there is; nothing if there is nothing."""
    if not compared.parts:
        return []
    elements: list[Element] = [Text(WHAT), *_failures(compared), *_beyond(compared)]
    ladder = compared.ladder
    if ladder is not None:
        elements.append(_table(ladder))
        elements += [Text(one) for one in temperature_only(ladder)]
        if np.isfinite(ladder.best_friction):
            elements.append(Text(best_sentence(ladder)))
        elements += ladder_charts(ladder)
    for one in compared.over:
        elements += axis_charts(one)
    return elements


def _failures(compared: Compared) -> Iterator[Notice]:
    """Yield a notice for each rung with a sample that did not converge."""
    for data in compared.parts:
        axis = varied(data)
        for at in range(data.sizes[axis]) if axis else [None]:
            one = data if at is None else data.isel({axis: at})
            where = "" if at is None else f"{axis} {float(one[axis]):.3g}, "
            for label, status in zip(one.label.values, one.status.values, strict=True):
                if str(status) != "converged":
                    yield Notice("error", f"{where}{label}: {status}{pointer(status)}.")


def _beyond(compared: Compared) -> Iterator[Notice]:
    """Yield a warning for each rung with friction that rests on extrapolation."""
    for data in compared.parts:
        axis = varied(data)
        where = f" over {axis.replace('_', ' ')}" if axis else ""
        for label, text in comparison_sentences(data):
            yield Notice("warning", f"{label}{where}: {text}")


def _table(ladder: xr.Dataset) -> Table:
    numbers = [Heading(text) for text in ("spread", "error", "factor")]
    headings = [
        Heading("model", words=True),
        Heading("A_r/A_0"),
        *numbers,
        Heading("μ"),
        Heading("from energy lost"),
        *numbers,
        Heading("samples"),
        Heading("A_r/A_0"),
        Heading("μ"),
        Heading("μ beyond band"),
        Heading("below", "decades"),
        Heading("above", "decades"),
    ]
    return Table(
        "ladder",
        "The ladder of models",
        headings,
        [_row(ladder.isel(rung=at)) for at in range(ladder.sizes["rung"])],
        groups=[
            ("", 1),
            ("real contact area", 4),
            ("friction coefficient", 5),
            ("", 1),
            ("exponent of the cut-off", 2),
            ("measured frequencies", 3),
        ],
        bad=frozenset(
            (at, column)
            for at, bad in enumerate(flawed(ladder))
            if bad
            for column in range(len(headings))
        ),
        note="Exponent of the cut-off: d ln/d ln of the smallest wavelength that counts, over its "
        "last octave. Beyond band: share of the friction at frequencies beyond those of the "
        "master curve, and how far they go.",
    )


def _row(one: xr.Dataset) -> list[str]:
    area, friction = (
        [
            number(one[f"{name}_{part}"], digits=digits)
            for part, digits in (("spread", 2), ("error", 2), ("factor", 3))
        ]
        for name in ("contact_fraction", "friction")
    )
    return [
        str(one.label.item()),
        number(one.total_contact_fraction),
        *area,
        number(one.total_friction),
        number(one.total_friction_from_dissipation),
        *friction,
        samples_of(one),
        *(number(one.get(name, np.nan), digits=2) for name in CUT_OFF_EXPONENTS),
        percent(one[FRICTION_OUTSIDE_BAND]),
        *(number(one[f"total_decades_{end}_band"], digits=2) for end in ("below", "above")),
    ]


# What each effect of the conditions is worth: the table of a report.

EFFECTS_TEXT = (
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
    return [Text(EFFECTS_TEXT), table]


def _changed(one: xr.Dataset, name: str) -> tuple[str, str]:
    if name not in one:
        return NONE, NONE
    change = float(one[CHANGES[name]])
    return number(float(one[name])), NONE if math.isnan(change) else percent(change)
