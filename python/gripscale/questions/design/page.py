"""A design of a compound in words: the answer, cards and tables."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from gripscale.charts.draw import image
from gripscale.core.finding import Finding
from gripscale.io.table import Column, Table, change, fixed, significant
from gripscale.questions.design.charts import SAME, design_pictures
from gripscale.questions.design.compound_design import FRUITLESS
from gripscale.questions.design.compound_search import ROLLING_LEVEL
from gripscale.questions.design.design_text import (
    LEAST_CHANGE,
    at_todays_rolling,
    changed_frequencies,
    rolling_at_todays_friction,
)
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Card, Page, Section

DECIDES = 1e-3  # friction gained by a tenth more room from which a limit decides
_TITLE = "Trade-off: each row is the admissible compound of most friction"


def design_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the answer of a design, what it is for, what decides it, and what it rests on."""
    same, least = at_todays_rolling(data), rolling_at_todays_friction(data)
    chosen = data.isel(point=-1) if same is None else same
    now, then = data.today_answer_friction.values, chosen.answer_friction.values
    goals = [f" at {goal}" for goal in data.goal.values] if now.size > 1 else [""]
    pairs = [
        f"{old:.3f} now → {new:.3f}{at}" for old, new, at in zip(now, then, goals, strict=True)
    ]
    lead = f"friction {', '.join(pairs)} with the design {_at_rolling(chosen)}"
    yield f"Answer: {lead}: {_gain(chosen)}."
    if math.isfinite(least):
        yield f"  Or the same friction with rolling resistance {_percent(least - 1.0)}."
    elif float(data.gain[0]) >= 0.0 and data.sizes["point"] > 1:
        lowest = data.isel(point=0)
        yield f"  Or friction {_gain(lowest)} {_at_rolling(lowest)}."
    named = zip(chosen.widened.values.tolist(), chosen.limit_worth.values.tolist(), strict=True)
    worths = {name: math.expm1(worth) for name, worth in named}
    if any(worth > DECIDES for name, worth in worths.items() if name != ROLLING_LEVEL):
        yield (
            f"  The limits you allow (moduli at most × {data.attrs['largest_factor']:g}) set the "
            "size of the gain, not physics."
        )
    if json.loads(data.attrs.get(FRUITLESS, "[]"))[-1:] > [float(data.rolling_level[-1])]:
        last = _percent(float(data.rolling_ratio[-1]) - 1.0)
        yield f"  More rolling resistance than {last} gives no more friction."
    tangent = float(data.today_rolling_loss_factor)
    yield (
        f"  Rolling resistance is tan δ and loss compliance at {data.attrs['rolling_band']}, the "
        f"worst of them; today tan δ is {significant(tangent)} at "
        f"{data.attrs['rolling_condition']}."
    )
    yield f"  {_what_changes(data, chosen)}"
    count = round(float(chosen.limited_share) * chosen.sizes["term"])
    yield (
        f"  {count} of {chosen.sizes['term']} moduli are at the largest factor "
        f"({data.attrs['largest_factor']:g}) or as far from a neighbour as they may be (a factor "
        f"of {data.attrs['factor_per_decade']:g} a decade)."
    )
    relaxed = [f"{name}, {_percent(worth)}" for name, worth in worths.items()]
    yield f"  A limit relaxed by a tenth gives, to first order: {'; '.join(relaxed)}."
    yield f"  {_interval_sources(chosen)}"
    yield from (f"note: {note}" for note in data.attrs.get("notes", "").splitlines())


def design_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield the gain at today's rolling resistance, and the least of it at today's friction."""
    same, least = at_todays_rolling(data), rolling_at_todays_friction(data)
    if same is not None:
        now, then = float(data.today_answer_friction[0]), float(same.answer_friction[0])
        yield Card("Friction", f"{now:.3f} → {then:.3f}", f"{_gain(same)} {_at_rolling(same)}")
    if math.isfinite(least):
        yield Card("Rolling resistance", _percent(least - 1.0), "at the same friction")


def _gain(point: xr.Dataset) -> str:
    low, high = float(point.gain_low), float(point.gain_high)
    interval = f" ({_percent(low)} to {_percent(high)})" if math.isfinite(low) else ""
    return f"{_percent(float(point.gain))}{interval}"


def _at_rolling(point: xr.Dataset) -> str:
    change = float(point.rolling_ratio) - 1.0
    if abs(change) < SAME:
        return "at the same rolling resistance"
    return f"with rolling resistance {_percent(change)}"


def _percent(value: float) -> str:
    return f"{100.0 * value:+.0f} %" if abs(value) > 0.0995 else f"{100.0 * value:+z.1f} %"


def _what_changes(data: xr.Dataset, point: xr.Dataset) -> str:
    """Return where the largest changes of E' and E'' are."""
    texts = []
    for name, symbol in (("storage", "E'"), ("loss", "E''")):
        ratio = (point[name] / data[f"today_{name}"]).values
        for at in sorted({int(np.argmin(ratio)), int(np.argmax(ratio))}):
            if abs(ratio[at] - 1.0) > LEAST_CHANGE:
                texts.append(
                    f"{symbol} × {ratio[at]:.2f} at {significant(data.frequency.values[at], 2)} Hz"
                )
    ends = [
        dict.fromkeys(significant(hertz, 2) for hertz in band)
        for band in changed_frequencies(data, point)
    ]
    if not ends:
        return "The master curve stays within 20 % of today's."
    bands = ", ".join(" to ".join(band) for band in ends)
    return f"The master curve changes by more than 20 % at {bands} Hz: {', '.join(texts)}."


def _interval_sources(point: xr.Dataset) -> str:
    """Return what the interval of a gain is made of."""
    parts = {
        "pieces of the surface": float(point.gain_sampling_error),
        "grids": float(point.gain_grid_error) / math.sqrt(3.0),
        "measurement of the rubber": float(point.gain_rubber_error),
    }
    each = ", ".join(
        f"{name} {significant(100.0 * value, 2)} %" if math.isfinite(value) else f"{name} not known"
        for name, value in parts.items()
    )
    doubled = float(point.gain_twice_cut_off)
    return (
        f"The 90 % interval is made of (1 sd): {each}; with twice the cut-off of the surface "
        f"{_percent(doubled)}. Finite strain and the step from lines to a surface are taken to be "
        "the same for both compounds."
    )


def design_table(data: xr.Dataset) -> Table:
    """Return the points of a design as a table."""
    columns = [
        Column("rolling_loss_factor", data.rolling_loss_factor.values, "tan δ rolling"),
        *_gain_columns(data, "", "rolling resistance"),
    ]
    notes = []
    for at, goal in enumerate(data.goal.values.tolist()):
        friction = data.answer_friction.values[:, at]
        columns.append(Column(f"friction_{at + 1}", friction, f"μ {at + 1}"))
        notes.append(f"μ {at + 1}: {goal}")
    for at, limit in enumerate(data.limit.values.tolist()):
        name = limit.split(" at ")[0]
        values = data.limited_ratio.values[:, at]
        columns.append(Column(f"limit_{at + 1}", values, f"{name} / today", format=fixed(2)))
    if bool(np.isfinite(data.wet_loss_factor.values).all()):
        columns.append(Column("wet_loss_factor", data.wet_loss_factor.values, "tan δ wet"))
        wet = data.attrs.get("wet_condition", "10 Hz and 0 °C")
        notes.append(f"tan δ wet: at {wet}, the rule of thumb for wet grip")
    share = data.limited_share.values
    columns.append(
        Column("limited_share", share, "at a limit", format=lambda part: f"{100.0 * part:.0f} %")
    )
    columns.append(Column("gap", data.gap.values, "left to gain", format=change))
    return Table("design", columns, _TITLE, notes)


def designed_compounds_table(data: xr.Dataset) -> Table | None:
    """Return the other compounds of a design as a table, None without any."""
    if "compound" not in data.dims:
        return None
    columns = [
        Column("compound", data.compound.values),
        *_gain_columns(data, "compound_", "rolling resistance, change"),
    ]
    return Table("compounds", columns, "Other compounds beside today's")


def _gain_columns(data: xr.Dataset, of: str, heading: str) -> list[Column]:
    def unsigned_zero(value: float) -> str:
        return change(round(value, 4) + 0.0)

    rolling = data[f"{of}rolling_ratio"].values - 1.0
    ends = np.column_stack([data[f"{of}gain_{end}"].values for end in ("low", "high")])
    return [
        Column("rolling_change", rolling, heading, format=unsigned_zero),
        Column("gain", data[f"{of}gain"].values, "friction gained", format=change),
        Column("gain_interval", ends, "90 % interval", format=change),
    ]


def design_tables(data: xr.Dataset) -> list[Table]:
    """Return the points of a design, then the other compounds, if there are any."""
    compounds = designed_compounds_table(data)
    return [design_table(data), *([] if compounds is None else [compounds])]


def design_page(data: xr.Dataset, findings: Sequence[Finding]) -> Page:
    """Return the page of a design: the curve, then its points."""
    answer, *basis = design_lines(data)
    return Page.of(
        f"Compound for {case_title(data.attrs)}",
        answer,
        findings,
        design_cards(data),
        [
            Section(
                "curve", "Friction over rolling resistance", [*map(image, design_pictures(data))]
            ),
            Section("points", "Points of the curve", design_tables(data)),
            rerun_section(data.attrs),
        ],
        (line.strip() for line in basis),
    )
